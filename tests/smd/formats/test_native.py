from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from smd.doodle import Doodle, Recording
from smd.errors import ExportError, RecordingError
from smd.formats import read_recording, write_recording

GOLDEN = Path(__file__).parents[2] / "golden" / "recordings"

ROWS = "0.00,0.1,0.2,0.3,0,0,0,1\n0.01,0.2,0.2,0.3,0,0,0.6,0.8\n0.02,0.3,0.2,0.3,0,0,0.8,0.6\n"
HEADER = "t,x,y,z,qx,qy,qz,qw\n"


def read_text(tmp_path: Path, text: str, **options: str) -> Recording:
    path = tmp_path / "take.csv"
    path.write_bytes(text.encode("utf-8"))
    return read_recording(path, **options)


def test_the_first_version_still_reads():
    recording = read_recording(GOLDEN / "native_v1.csv")
    assert recording.devices == ("left", "right, the red one")
    assert dict(recording.metadata) == {"story": "two props meet"}
    left, right = recording.doodles
    assert_array_equal(left.time_s, [0.0, 0.0111, 0.0222])
    assert_array_equal(right.position_m[:, 0], [-0.1, -0.11, -0.12])
    assert_array_equal(right.drawing, [False, True, True])
    assert left.drawing is not None and left.drawing.all()


@pytest.mark.parametrize("time", ["t", "time", "timestamp", "time_s", "Time"])
def test_time_goes_by_four_names_in_any_case(tmp_path, time):
    recording = read_text(tmp_path, HEADER.replace("t,", f"{time},") + ROWS)
    assert_array_equal(recording.doodles[0].time_s, [0.0, 0.01, 0.02])
    assert recording.devices == ("prop",)


@pytest.mark.parametrize(
    "text",
    [
        ROWS,
        "# from: a tracker\n\n" + ROWS,
        "\ufeff" + HEADER + ROWS,
        (HEADER + ROWS).replace("\n", "\r\n"),
        (HEADER + ROWS).replace("\n", "\r"),
        (HEADER + ROWS).replace(",", " , "),
        HEADER + ROWS.replace("\n0.02", "\n\n# a note\n0.02") + "\n\n",
        "note,t,x,y,z,qx,qy,qz,qw\n" + "".join(f'"a, b",{r}\n' for r in ROWS.split()),
        "qw,qz,qy,qx,z,y,x,t\n"
        + "".join(",".join(r.split(",")[::-1]) + "\n" for r in ROWS.split()),
        HEADER + ROWS.replace("0.3,0,0", '0.3,0,"0"'),
    ],
    ids=[
        "no header",
        "metadata",
        "byte order mark",
        "CRLF",
        "CR",
        "spaces",
        "comments",
        "other columns",
        "other order",
        "quoted",
    ],
)
def test_every_way_to_write_the_same_table_reads_the_same(tmp_path, text):
    doodle = read_text(tmp_path, text).doodles[0]
    assert_allclose(doodle.time_s, [0.0, 0.01, 0.02])
    assert_allclose(doodle.position_m, [[0.1, 0.2, 0.3], [0.2, 0.2, 0.3], [0.3, 0.2, 0.3]])
    assert_allclose(doodle.orientation_xyzw, [[0, 0, 0, 1], [0, 0, 0.6, 0.8], [0, 0, 0.8, 0.6]])


def test_devices_may_take_turns_and_one_alone_can_be_read(tmp_path):
    lines = ROWS.split()
    rows = [line.replace(",", f",{device},", 1) for line in lines for device in ("b", "a")]
    text = HEADER.replace("t,", "t,device,") + "\n".join(rows)
    assert read_text(tmp_path, text).devices == ("b", "a")
    assert read_text(tmp_path, text, device="a").devices == ("a",)
    with pytest.raises(RecordingError, match=r"expected device 'c', found only 'b', 'a'$"):
        read_text(tmp_path, text, device="c")


@pytest.mark.parametrize("marks", [("1", "0", "1"), ("true", "FALSE", "True"), ("1.0", "0.0", "1")])
def test_drawing_is_read_as_ones_and_zeros_or_words(tmp_path, marks):
    rows = "".join(f"{row},{mark}\n" for row, mark in zip(ROWS.split(), marks, strict=True))
    doodle = read_text(tmp_path, HEADER.replace("qw\n", "qw,drawing\n") + rows).doodles[0]
    assert_array_equal(doodle.drawing, [True, False, True])


@pytest.mark.parametrize(
    "text", [HEADER + ROWS, HEADER.replace("qw\n", "qw,drawing\n") + ROWS.replace("\n", ",\n")]
)
def test_a_file_that_does_not_say_when_the_user_drew_says_nothing(tmp_path, text):
    assert read_text(tmp_path, text).doodles[0].drawing is None


def test_the_column_is_there_where_a_doodle_says_when_the_user_drew(tmp_path):
    path, q = tmp_path / "take.csv", np.tile([0.0, 0.0, 0.0, 1.0], (12, 1))
    t = 0.01 * np.arange(12)
    silent = Doodle(t, np.outer(t, [1.0, 2.0, 3.0]), q, "a")
    drawn = Doodle(t, np.outer(t, [1.0, 2.0, 3.0]), q, "b", np.ones(12, bool))
    for doodles, has_column in (((silent,), False), ((silent, drawn), True), ((drawn,), True)):
        write_recording(Recording(doodles), path)
        assert (",drawing\n" in path.read_text("utf-8")) == has_column
        for ours, theirs in zip(read_recording(path).doodles, doodles, strict=True):
            assert (ours.drawing is None) == (theirs.drawing is None)
            assert_array_equal(ours.drawing, theirs.drawing)


names = st.text(st.characters(blacklist_categories=["Cs", "Cc"]), min_size=1, max_size=12).filter(
    lambda text: text == " ".join(text.split())
)


@st.composite
def recordings(draw) -> Recording:
    """Recordings as a reader makes them: rows close together, and no pose repeated."""
    seed = draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    doodles = []
    for device in draw(st.lists(names, min_size=1, max_size=3, unique=True)):
        start_s = draw(st.floats(-10.0, 1.7e9))
        for _ in range(draw(st.integers(1, 2))):
            n = draw(st.integers(12, 30))
            q = rng.normal(size=(n, 4))
            time_s = start_s + np.cumsum(rng.uniform(0.01, 0.02, n))
            start_s = time_s[-1] + draw(st.floats(0.3, 5.0))
            position = np.cumsum(rng.normal(scale=0.01, size=(n, 3)), axis=0)
            q /= np.linalg.norm(q, axis=1, keepdims=True)
            drawing = draw(st.sampled_from([None, rng.random(n) < 0.5, np.ones(n, bool)]))
            doodles.append(Doodle(time_s, position, q, device, drawing))
    keys = names.filter(lambda key: ":" not in key and key not in ("schema", "version"))
    values = st.text(st.characters(blacklist_categories=["Cs", "Cc"]), max_size=20)
    metadata = draw(
        st.dictionaries(keys, values.map(lambda text: " ".join(text.split())), max_size=3)
    )
    return Recording(tuple(doodles), metadata=metadata)


@settings(max_examples=60, deadline=None)
@given(recordings())
def test_what_is_written_reads_back_the_same(tmp_path_factory, recording):
    path = tmp_path_factory.mktemp("trip") / "take.csv"
    write_recording(recording, path)
    back = read_recording(path)
    assert back.devices == recording.devices
    assert dict(back.metadata) == dict(recording.metadata)
    assert len(back.doodles) == len(recording.doodles)
    for ours, theirs in zip(back.doodles, recording.doodles, strict=True):
        assert_array_equal(ours.time_s, theirs.time_s)
        assert_array_equal(ours.position_m, theirs.position_m)
        assert_allclose(ours.orientation_xyzw, theirs.orientation_xyzw, atol=1e-15)
        assert (ours.drawing is None) == (theirs.drawing is None)
        assert_array_equal(ours.drawing, theirs.drawing)


def test_names_that_a_csv_cannot_hold_are_refused_and_nothing_is_written(tmp_path):
    q = np.eye(4)[2:]
    path = tmp_path / "take.csv"
    with pytest.raises(RecordingError, match="device: expected a name on one line"):
        write_recording(Recording((Doodle([0, 1], np.eye(3)[:2], q, "a\nb"),)), path)
    with pytest.raises(RecordingError, match="metadata: expected a key on one line"):
        write_recording(Recording((Doodle([0, 1], np.eye(3)[:2], q),), metadata={"a:b": "c"}), path)
    with pytest.raises(ExportError, match="expected an existing folder"):
        write_recording(Recording((Doodle([0, 1], np.eye(3)[:2], q),)), tmp_path / "no" / "a.csv")
    assert list(tmp_path.iterdir()) == []
