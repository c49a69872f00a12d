"""Every way a file can be wrong gives one line: file, place, expected, found."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smd.errors import RecordingError
from smd.formats import read_recording
from smd.formats.reading import READABLE

HEADER = "t,x,y,z,qx,qy,qz,qw\n"
GOOD = "0.0,1,2,3,0,0,0,1\n0.01,1.1,2,3,0,0,0,1\n"
POSE = {
    "position": {"x": 1, "y": 2, "z": 3},
    "rotation": {"x": 0, "y": 0, "z": 0},
    "timestamp": 10,
}
COLUMNS = "time_s, x, y, z, qx, qy, qz, qw"


def refused(path: Path, **options) -> str:
    """The message, without the file's name in front."""
    with pytest.raises(RecordingError) as caught:
        read_recording(path, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(str(path))
    return message.removeprefix(str(path)).lstrip(",: ")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "expected rows of poses, found an empty file"),
        (" \n\n", "expected rows of poses, found an empty file"),
        (HEADER, "expected rows of poses, found none"),
        ("# story: none\n" + HEADER + "\n\n", "expected rows of poses, found none"),
        (
            HEADER + GOOD + "0.02,1,2,3,0,0,1\n",
            f"line 4: expected 8 columns ({COLUMNS}), found 7",
        ),
        (
            HEADER + "0.0,1,2,3,0,0,0,1,9\n0.01,1,2,3,0,0,0,1,9\n",
            f"line 2: expected 8 columns ({COLUMNS}), found 9",
        ),
        (
            "0.0,1,2,3,0,0,1\n",
            "line 1: expected a header, or 8 columns (time, position, quaternion), "
            "found 7 columns without a header",
        ),
        (
            "t,x,y,z,qx,qy,qz\n" + GOOD,
            f"line 1: expected a header with {COLUMNS}, found no qw in 't,x,y,z,qx,qy,qz'",
        ),
        (
            "t,time,x,y,z,qx,qy,qz,qw\n0,0,1,2,3,0,0,0,1\n",
            "line 1: expected one column time_s, found 2",
        ),
        (
            HEADER + GOOD + "0.02,1,two,3,0,0,0,1\n",
            "line 4: expected a number in column y, found 'two'",
        ),
        (
            HEADER + GOOD + "0.02,1,1_0,3,0,0,0,1\n",
            "line 4: expected a number in column y, found '1_0'",
        ),
        (HEADER + GOOD + "0.02,1,inf,3,0,0,0,1\n", "line 4: expected finite numbers, found inf"),
        (HEADER + GOOD + "0.02,1,2,3,0,0,-inf,1\n", "line 4: expected finite numbers, found inf"),
        (
            HEADER + "0,nan,2,3,0,0,0,1\n0.01,1,2,3,nan,0,0,1\n0.02,,,,,,,\n",
            "device 'prop': expected at least two poses that are numbers, found 0 among 3 rows",
        ),
        (HEADER + GOOD + "0.02,1,2,3,0,0,0,0\n", "line 4: expected a unit quaternion, found zero"),
        (
            HEADER + GOOD + "0.02,1,2,3,0,0,0,2\n",
            "line 4: expected a unit quaternion, found length 2",
        ),
        (
            HEADER + GOOD + "0.02,1,2,3,0,0,0,1e300\n",
            "line 4: expected a unit quaternion, found length inf",
        ),
        (
            HEADER + GOOD + "0.005,1,2,3,0,0,0,1\n",
            "line 4: expected a time at least 1 ns after 0.01 s, found 0.005 s",
        ),
        (
            HEADER + GOOD + "0.01,1,2,3,0,0,0,1\n",
            "line 4: expected a time at least 1 ns after 0.01 s, found 0.01 s",
        ),
        (
            HEADER + GOOD + "nan,1,2,3,0,0,0,1\n",
            "line 4: expected a time in seconds, at most 1e+10, found nan",
        ),
        (
            HEADER + GOOD + "1.7e18,1,2,3,0,0,0,1\n",
            "line 4: expected a time in seconds, at most 1e+10, found 1.7e+18",
        ),
        (
            HEADER + "0,1,2,3,0,0,0,1\n11,1,2,3,0,0,0,1\n22,1,2,3,0,0,0,1\n",
            "device 'prop': expected times in seconds, rows at most 0.25 s apart, "
            "found most rows 11 s apart",
        ),
        (
            HEADER + GOOD + "0.02,1e7,2,3,0,0,0,1\n",
            "line 4: expected positions within 1e+06 m, found 1e+07 m",
        ),
        (HEADER + "0,1,2,3,0,0,0,1\n", "device 'prop': expected at least two poses, found 1"),
        (
            "t,device,x,y,z,qx,qy,qz,qw\n0,a,1,2,3,0,0,0,1\n0.1,a,1,2,3,0,0,0,1\n0,b,1,2,3,0,0,0,1\n",
            "device 'b': expected at least two poses, found 1",
        ),
        (
            "t,device,x,y,z,qx,qy,qz,qw\n0,a,1,2,3,0,0,0,1\n0.1,,1,2,3,0,0,0,1\n",
            "line 3: expected a name in column device, found ''",
        ),
        (
            "t,x,y,z,qx,qy,qz,qw,drawing\n0,1,2,3,0,0,0,1,maybe\n",
            "line 2: expected 0 or 1 in column drawing, found 'maybe'",
        ),
        (
            "t,x,y,z,qx,qy,qz,qw,drawing\n0,1,2,3,0,0,0,1,1\n0.1,1,2,4,0,0,0,1,\n",
            "line 3: expected 0 or 1 in column drawing, as in other rows of the doodle, found an "
            "empty cell",
        ),
        (
            "# schema: smd.recording\n# version: 2\n" + HEADER + GOOD,
            "expected version 1 of smd.recording, found version 2",
        ),
        (
            "hello there\n",
            "expected a CSV or TUM table of poses, or A-Frame JSON, "
            "found text that begins 'hello there'",
        ),
        (
            "0 1 2 3 0 0 1\n",
            "line 1: expected 8 columns (timestamp, tx, ty, tz, qx, qy, qz, qw), found 7",
        ),
        ("0 1 2 3 0 0 0 1\n1 a 2 3 0 0 0 1\n", "line 2: expected a number in column tx, found 'a'"),
        (
            "{",
            "line 1, column 2: expected JSON, "
            "found the end (expecting property name enclosed in double quotes)",
        ),
        ('{"a":' * 100_000, "expected JSON, found JSON nested too deeply"),
        ('{"schema": 1, "x": 2}', "expected JSON with devices that have poses, found 'schema, x'"),
        ("[1, 2]", "expected JSON with devices that have poses, found 'list'"),
        ('{"a": {"poses": []}}', "expected JSON with devices that have poses, found 'a'"),
        (
            '{"recording": 5}',
            "expected JSON with devices that have poses, found 'recording'",
        ),
        ('{"a": {"poses": 3}}', "device 'a': expected a list of poses, found 3"),
        (
            '{"a": {"poses": [1]}}',
            "device 'a', pose 0: expected numbers in timestamp, position x y z and rotation x y z, "
            "found 1",
        ),
        (
            json.dumps({"a": {"poses": [POSE, POSE]}}),
            "device 'a', pose 1: expected a time at least 1 ns after 0.01 s, found 0.01 s",
        ),
        (
            json.dumps({"a": {"poses": [POSE]}}),
            "device 'a': expected at least two poses, found 1",
        ),
        (
            json.dumps({"a": {"poses": [POSE, POSE | {"timestamp": 20}]}}).replace(
                '"z": 0}', '"z": 1e999}', 1
            ),
            "device 'a', pose 0: expected finite numbers, found inf",
        ),
    ],
)
def test_a_wrong_content_is_named_with_its_place(tmp_path, content, message):
    path = tmp_path / "take.csv"
    path.write_text(content, encoding="utf-8")
    assert refused(path) == message


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (
            (HEADER + GOOD).encode("utf-16"),
            "expected text in UTF-8, found UTF-16; save it again as UTF-8",
        ),
        (
            (HEADER + GOOD).encode("utf-16-le"),
            "expected text in UTF-8, found UTF-16; save it again as UTF-8",
        ),
        (
            (HEADER + GOOD).encode("utf-16-be"),
            "expected text in UTF-8, found UTF-16; save it again as UTF-8",
        ),
        (bytes(range(256)) * 20, "expected text, found binary data"),
        (
            b"# made by: Zo\xeb\n",
            "line 1: expected text in UTF-8, found byte 0xeb; save it again as UTF-8",
        ),
    ],
    ids=["UTF-16 with mark", "UTF-16-LE", "UTF-16-BE", "binary", "Latin-1"],
)
def test_bytes_that_are_not_utf8_are_named(tmp_path, data, message):
    path = tmp_path / "take.csv"
    path.write_bytes(data)
    assert refused(path) == message


def test_what_is_no_file_is_named(tmp_path):
    assert refused(tmp_path / "none.csv") == "expected a recording, found no such file"
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    assert refused(folder) == "expected a recording, found a folder"
    assert refused(tmp_path) == "expected a recording, found a folder"
    assert refused(tmp_path / "a\0.csv") == "expected a recording, found no such file"
    assert refused(tmp_path / ("a" * 5000 + ".csv")).startswith("expected a ")


def test_an_unknown_suffix_is_named(tmp_path):
    path = tmp_path / "take.mp4"
    path.write_text(HEADER + GOOD)
    suffixes = " ".join(READABLE)
    assert refused(path) == f"expected a file with suffix {suffixes}, found '.mp4'"
    (tmp_path / "take").write_text(HEADER + GOOD)
    assert refused(tmp_path / "take") == f"expected a file with suffix {suffixes}, found no suffix"


def test_a_recording_that_is_lost_all_along_is_refused(tmp_path):
    path = tmp_path / "take.csv"
    t = np.arange(0.0, 3.0, 0.3)
    rows = [f"{s:.3f},{s},0,0,0,0,0,1" for a in t for s in (a, a + 0.02)]
    path.write_text(HEADER + "\n".join(rows))
    assert refused(path) == (
        "device 'prop': expected a stretch of at least 0.1 s without loss of tracking, found none"
    )


def test_an_error_far_down_a_long_file_is_found(tmp_path):
    path = tmp_path / "take.csv"
    rows = [f"{i / 90:.6f},{i * 1e-4:.6f},1,2,0,0,0,1" for i in range(20_000)]
    rows[15_000] = rows[15_000].replace(",1,2,", ",1,?,")
    path.write_text("# a: b\n" + HEADER + "\n".join(rows))
    assert refused(path) == "line 15003: expected a number in column z, found '?'"


SEEDS = [
    "# a: b\n" + HEADER + GOOD,
    "t,device,x,y,z,qx,qy,qz,qw,drawing\n0,a,1,2,3,0,0,0,1,1\n0.1,a,1,2,3,0,0,0,1,0\n",
    "t,x,y,z,qx,qy,qz,qw,drawing\n0,1,2,3,0,0,0,1,\n0.1,1,2,3,0,0,0,1,\n",
    "0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 0 1\n",
    json.dumps({"recording": {"a": {"poses": [POSE, POSE | {"timestamp": 20}]}}}),
]
PIECES = ["\n", ",", '"', "#", ":", " ", "nan", "inf", "1e999", "-", "{", "]", "null", "é", "\0"]


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_no_damage_to_a_file_is_a_traceback(tmp_path_factory, data):
    text = data.draw(st.sampled_from(SEEDS))
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(start, min(start + 12, len(text))))
        text = text[:start] + data.draw(st.sampled_from(["", *PIECES])) + text[end:]
    path = tmp_path_factory.getbasetemp() / "damaged.csv"
    path.write_text(text, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            read_recording(path)
        except RecordingError as error:
            assert "\n" not in str(error)
            assert "expected" in str(error)
