from __future__ import annotations

import numpy as np
import pytest

from laban import AXES, Effort, LabanError, load_effort_model, read_effort
from laban.body import body_rate
from laban.committee import MEMBERS, PAIRS
from laban.description import FLOORS, describe
from laban.model import effort_of
from laban.qualities import REST_M_S2
from laban.training import entries_of, seen_in, train
from smd.doodle import Doodle, Recording
from smd.effort import (
    SIMULATED_PEOPLE,
    SIMULATED_REPEATS,
    SIMULATED_SEED,
    ManifestRow,
    read_manifest,
    recording_efforts,
    report_lines,
    simulated_examples,
    train_manifest,
    windowed_examples,
)
from smd.errors import DoodleError, RecordingError
from smd.smoothing import smooth
from smd.synthetic.efforts import fourfold_takes, labelled_takes, with_noise

HEADER = "file,time,weight,space,flow,performer\n"


@pytest.fixture
def manifest(tmp_path):
    """Write a manifest beside two empty recordings, a.csv and b.csv."""
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).touch()

    def write(text: str):
        path = tmp_path / "manifest.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def line(*, seconds=1.0, device="prop", start_s=0.0):
    time_s = start_s + np.arange(0.0, seconds, 1 / 90)
    position = np.stack([0 * time_s, 0 * time_s, 0.1 * np.sin(3 * time_s)], axis=1)
    return Doodle(time_s, position, np.tile([0.0, 0, 0, 1], (len(time_s), 1)), device=device)


def test_words_become_numbers_and_nothing_becomes_unlabelled(manifest, tmp_path):
    rows = read_manifest(
        manifest(HEADER + "a.csv,sudden,light,,neutral,Ann\nb.csv, Sustained ,,direct,,Bob\n")
    )
    assert [row.performer for row in rows] == ["Ann", "Bob"]
    assert rows[0].path == tmp_path / "a.csv"
    np.testing.assert_array_equal(rows[0].meant, [1.0, -1.0, np.nan, 0.0])
    np.testing.assert_array_equal(rows[1].meant, [-1.0, np.nan, 1.0, np.nan])


def test_columns_come_in_any_order_and_axes_may_be_absent(manifest):
    rows = read_manifest(manifest("performer,file,flow\nAnn,a.csv,bound\n"))
    np.testing.assert_array_equal(rows[0].meant, [np.nan, np.nan, np.nan, 1.0])


def test_a_byte_order_mark_is_not_part_of_the_first_column(manifest):
    assert len(read_manifest(manifest("\ufeff" + HEADER + "a.csv,sudden,,,,Ann\n"))) == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "expected the columns file"),
        ("file,time\n", "expected the columns file.*found file, time"),
        (HEADER, "at least one take"),
        (HEADER + "a.csv,quick,,,,Ann\n", "line 2: time: expected sustained, sudden, neutral"),
        (HEADER + "a.csv,sudden,,,,Ann\nb.csv,,sudden,,,Ann\n", "line 3: weight: .*found 'sudden'"),
        (HEADER + "a.csv,sudden,,,,\n", "line 2: performer: expected a name"),
        (HEADER + "c.csv,sudden,,,,Ann\n", "line 2: file: expected a recording, found none: .*c"),
        (HEADER + ",sudden,,,,Ann\n", "line 2: file: expected a recording, found nothing"),
        (HEADER + "a.csv\n", "line 2: performer: expected a name"),
    ],
)
def test_a_faulty_manifest_is_refused_by_line(manifest, text, said):
    with pytest.raises(LabanError, match=said):
        read_manifest(manifest(text))


def test_a_manifest_that_is_not_there_is_said_so(tmp_path):
    with pytest.raises(LabanError, match=r"absent\.csv: expected a manifest"):
        read_manifest(tmp_path / "absent.csv")


def test_labels_that_cannot_do_are_refused_before_a_recording_is_read(manifest):
    def read(path):
        raise AssertionError("read a recording")

    with pytest.raises(LabanError, match=r"manifest\.csv: time: expected 'sustained' takes of at"):
        train_manifest(manifest(HEADER + "a.csv,sudden,,,,Ann\n"), read)


@pytest.fixture
def played(tmp_path):
    """A manifest of simulated takes, and a reader that knows their recordings."""
    takes = [t for t in labelled_takes(people=4, repeats=2, seed=5) if t.effort.weight == 0]
    lines, doodles = [], {}
    words = {-1.0: "sustained", 0.0: "neutral", 1.0: "sudden"}
    for i, take in enumerate(takes):
        (tmp_path / f"{i}.csv").touch()
        doodles[tmp_path / f"{i}.csv"] = Recording((take.doodle,))
        lines.append(f"{i}.csv,{words[take.effort.time]},,,,{take.player}\n")
    path = tmp_path / "manifest.csv"
    path.write_text(HEADER + "".join(lines), encoding="utf-8")
    return path, doodles


def test_a_manifest_trains_the_axes_that_it_labels(played):
    path, doodles = played
    seen: list[ManifestRow] = []

    def progress(rows):
        for row in rows:
            seen.append(row)
            yield row

    training = train_manifest(path, doodles.__getitem__, progress=progress)
    assert tuple(training.model.axes) == ("time",)
    assert training.model.axes["time"].examples == (8, 8, 8)
    assert "24 takes of 4 performers" in training.model.trained_on
    assert len(seen) == 24
    assert report_lines(training)[0].startswith("time: ")


def test_a_take_that_is_split_is_refused(played):
    path, doodles = played
    first = next(iter(doodles))
    doodles[first] = Recording((line(), line(start_s=9.0)))
    with pytest.raises(RecordingError, match=r"0\.csv: expected a take of one doodle, got 2"):
        train_manifest(path, doodles.__getitem__)


def test_a_take_that_is_too_short_is_refused_by_file(played):
    path, doodles = played
    doodles[next(iter(doodles))] = Recording((line(seconds=0.02),))
    with pytest.raises(DoodleError, match=r"0\.csv: device"):
        train_manifest(path, doodles.__getitem__)


def test_every_doodle_of_a_recording_is_read_and_a_short_one_has_no_effort():
    recording = Recording((line(device="left"), line(device="right", seconds=0.02)))
    moving, short = recording_efforts(recording, load_effort_model())
    assert (moving.device, short.device) == ("left", "right")
    assert moving.effort.time is not None
    assert (short.effort, short.state) == (Effort(), None)


def test_a_doodle_is_read_movement_by_movement():
    """Two waves with a second of rest between are read as each of them is alone."""
    time_s = np.arange(0.0, 4.0, 1 / 90)
    wave = np.where(time_s < 1.5, 1.0, np.where(time_s > 2.5, -0.5, 0.0))
    place = 0.1 * wave * np.sin(np.pi * np.where(time_s < 1.5, time_s, time_s - 2.5) / 1.5) ** 2
    position = np.stack([place, 0 * place, 0 * place], axis=1)
    doodle = Doodle(time_s, position, np.tile([0.0, 0, 0, 1], (len(time_s), 1)))
    model = load_effort_model()
    first, second = recording_efforts(Recording((doodle,)), model)
    assert (first.start_s, second.end_s) == pytest.approx((0.0, 4.0), abs=0.1)
    assert (first.end_s, second.start_s) == pytest.approx((1.5, 2.5), abs=0.1)
    assert first.effort.weight > second.effort.weight
    motion = smooth(doodle)
    for read in (first, second):
        alone = read_effort(motion.between(read.start_s, read.end_s), model)
        assert read.effort == alone


def test_simulated_examples_label_all_axes_but_space_on_the_spot():
    takes = list(fourfold_takes(people=2, repeats=1, seed=0))
    examples = simulated_examples(people=2, repeats=1, seed=0)
    assert examples.meant.shape == (18, len(AXES))
    assert examples.descriptions.shape == (18, 132)
    space = AXES.index("space")
    on_the_spot = np.isin([take.action for take in takes], ["turn_left", "turn_right", "bow"])
    assert 0 < on_the_spot.sum() < 18
    np.testing.assert_array_equal(np.isnan(examples.meant[:, space]), on_the_spot)
    told = np.nan_to_num(examples.meant)
    assert np.isin(told, [-1.0, 0.0, 1.0]).all()
    assert not np.isnan(np.delete(examples.meant, space, axis=1)).any()


def test_the_shipped_model_was_made_by_its_command_from_these_people():
    model = load_effort_model()
    takes = 2 * SIMULATED_PEOPLE * SIMULATED_REPEATS * 3  # each by two trackers
    assert model.seed == SIMULATED_SEED
    for axis, taught in model.axes.items():
        assert axis == "space" or taught.examples == (takes, takes, takes)
        assert taught.performers == SIMULATED_PEOPLE


@pytest.mark.rebuild
def test_learning_from_these_people_gives_the_shipped_weights_again():
    """``smd laban train --simulated`` makes the whole model again, byte for byte."""
    examples = windowed_examples()
    shipped = load_effort_model().own
    described = examples.descriptions
    whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
    # another machine's sums may differ in the last digits, of which the model keeps six
    entries = entries_of(described, whose, against=True)
    for name in ("lowest", "highest", "centre", "scale", "unlike", "typical"):
        again, ours = getattr(entries, name), getattr(shipped.entries, name)
        np.testing.assert_allclose(again, ours, rtol=1e-4, atol=1e-4, err_msg=name)
    for name in ("centre", "weight", "spread"):
        again, ours = getattr(entries.sizes, name), getattr(shipped.entries.sizes, name)
        np.testing.assert_allclose(again, ours, rtol=1e-4, atol=1e-4, err_msg=f"sizes.{name}")
    # the axis that is one member's alone: what it has learned, but for how sure it is
    axis, member = "weight", MEMBERS["products"]
    assert shipped.axes[axis].members == {"products": 1.0}
    np.testing.assert_array_equal(shipped.entries.pairs, PAIRS)
    meant = examples.meant[:, AXES.index(axis)]
    again = member.learned(seen_in(shipped.entries, described, whose), meant).weight
    ours = shipped.axes[axis].classifier.weight
    np.testing.assert_allclose(again * (ours @ ours) / (again @ ours), ours, atol=1e-4)


def test_the_shipped_model_tells_people_it_has_not_met():
    examples = simulated_examples(people=12, repeats=2, seed=SIMULATED_SEED + 1)
    model = load_effort_model()
    read = [effort_of(row, model) for row in examples.descriptions]
    for column, axis in enumerate(AXES):
        meant = examples.meant[:, column]
        reading = np.array([getattr(effort, axis) for effort in read])
        poles = np.abs(meant) == 1.0
        assert np.mean((reading[poles] > 0) == (meant[poles] > 0)) > 0.85
        neither = reading[meant == 0]
        assert abs(neither.mean()) < 0.3
        assert reading[meant < 0].mean() < neither.mean() < reading[meant > 0].mean()


@pytest.mark.long
def test_real_people_are_told_apart_by_a_model_of_other_real_people(shared_data):
    from smd.formats import SourceFrame, read_recording

    def read(path):
        return read_recording(path, SourceFrame.from_options(up="z"))

    rows = read_manifest(shared_data / "laban" / "manifest.csv")
    described = np.array([describe(smooth(read(row.path).doodles[0])) for row in rows])
    meant = dict(zip(AXES, np.array([row.meant for row in rows]).T, strict=True))
    some = {axis: meant[axis] for axis in ("space", "flow")}  # what the paper's features lack
    training = train(described, some, [row.performer for row in rows], trained_on="")
    assert training.model.alone.states is None  # each take carries one pole
    for axis, least in (("space", 0.75), ("flow", 0.65)):
        assert training.own[axis].accuracy >= least


@pytest.mark.parametrize("rate_hz", [60.0, 100.0])
def test_the_floors_are_about_what_a_noisy_tracker_reports_of_a_body_at_rest(rate_hz):
    n = 6000
    still = Doodle(np.arange(n) / rate_hz, np.zeros((n, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)))
    motion = smooth(with_noise(still, 1e-3, np.radians(0.5), np.random.default_rng(0)))
    signals = {
        "m/s": motion.velocity_m_s,
        "m/s^2": motion.acceleration_m_s2,
        "m/s^3": motion.jerk_m_s3,
        "rad/s": motion.angular_velocity_rad_s,
        "rad/s^2": motion.angular_acceleration_rad_s2,
        "rad/s^3": motion.angular_jerk_rad_s3,
    }
    for unit, signal in signals.items():
        assert 1 / 1.6 < FLOORS[unit] / np.sqrt(np.mean(signal**2)) < 1.6, unit
    window = np.ones(7) / 7.0  # 0.1 s of 60 samples a second
    linear, angular = (
        np.stack([np.convolve(column, window, "valid") for column in signal.T], axis=1)
        for signal in (motion.acceleration_m_s2, motion.angular_acceleration_rad_s2)
    )
    assert 1.5 < REST_M_S2 / np.sqrt(np.mean(body_rate(linear, angular) ** 2)) < 2.0
