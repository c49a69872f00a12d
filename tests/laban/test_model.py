from __future__ import annotations

import json
from dataclasses import fields, replace

import numpy as np
import pytest

from laban import AXES, Effort, LabanError, effort_features, load_effort_model, read_effort
from laban.description import describe
from laban.effort import EFFORT_STEPS, NEUTRAL, POLES
from laban.model import read_state
from laban.model_file import effort_model_from_json, effort_model_to_json, save_effort_model
from laban.own import own_measure
from laban.reader import Entries


@pytest.fixture(scope="module")
def shipped():
    return load_effort_model()


@pytest.fixture(scope="module")
def unmuted(shipped):
    """The shipped model, as sure of movements unlike any that it has learned from as of others."""
    alone, own = (replace(reader, reach=1e6) for reader in (shipped.alone, shipped.own))
    return replace(shipped, alone=alone, own=own)


def test_the_shipped_model_reads_all_axes_and_joint_states(shipped):
    assert tuple(shipped.axes) == AXES
    assert shipped.seed is not None
    for reader in (shipped.alone, shipped.own):
        assert reader.states is not None
        assert set(reader.axes) == set(AXES)


def test_somebodys_own_takes_are_read_about_their_middle(unmuted, random_motion):
    """Who moves quickly anyway is not sudden by it, nor who moves slowly sustained."""
    alone, against = [], []
    for pace in (0.4, 3.0):
        motions = [random_motion(np.random.default_rng(s), pace=pace) for s in range(20)]
        own = own_measure(motions)
        alone.append(np.mean([read_effort(motion, unmuted).time for motion in motions]))
        against.append(np.mean([read_effort(motion, unmuted, own).time for motion in motions]))
    assert alone[1] - alone[0] > 0.5
    assert against[1] - against[0] < 0.5 * (alone[1] - alone[0])


def test_too_few_takes_are_no_measure(random_motion):
    motion = random_motion(np.random.default_rng(0))
    assert own_measure([motion, motion]) is None
    assert own_measure([]) is None


def test_a_joint_state_has_the_words_of_both_axes_and_a_chance(shipped, random_motion):
    time, weight, chance = read_state(random_motion(np.random.default_rng(0)), shipped)
    assert time in ("sustained", "sudden")
    assert weight in ("light", "strong")
    assert 0.25 <= chance <= 1.0


def test_a_model_is_the_same_after_saving_and_loading(shipped, tmp_path):
    save_effort_model(shipped, tmp_path / "model.json")
    again = load_effort_model(tmp_path / "model.json")
    assert effort_model_to_json(again) == effort_model_to_json(shipped)
    for field in fields(Entries):
        if field.name != "sizes":
            np.testing.assert_array_equal(
                getattr(again.own.entries, field.name), getattr(shipped.own.entries, field.name)
            )
    ours, theirs = again.own.entries.sizes, shipped.own.entries.sizes
    np.testing.assert_array_equal(ours.weight, theirs.weight)
    np.testing.assert_array_equal(ours.centre, theirs.centre)
    assert (ours.spread, again.own.reach) == (theirs.spread, shipped.own.reach)
    for axis, part in shipped.own.axes.items():
        np.testing.assert_array_equal(
            again.own.axes[axis].classifier.weight, part.classifier.weight
        )


def test_axes_that_were_not_trained_are_not_read(shipped, random_motion):
    alone = {"time": shipped.alone.axes["time"]}
    model = replace(
        shipped,
        axes={"time": shipped.axes["time"]},
        alone=replace(shipped.alone, axes=alone, states=None),
    )
    motion = random_motion(np.random.default_rng(0))
    effort = read_effort(motion, model)
    assert effort == Effort(time=read_effort(motion, shipped).time)
    assert read_state(motion, model) is None


def test_products_are_of_the_entries_as_they_are_seen(shipped, random_motion):
    description = describe(random_motion(np.random.default_rng(0)))
    entries = shipped.alone.entries
    values = entries.values(description)
    found = entries.seen(values)
    z = [
        (min(max(value, low), high) - centre) / scale
        for value, low, high, centre, scale in zip(
            values,
            entries.lowest,
            entries.highest,
            entries.centre,
            entries.scale,
            strict=True,
        )
    ]
    np.testing.assert_allclose(found, [*z, *(z[i] * z[j] for i, j in entries.pairs)])
    many = np.stack([description, 2.0 * description])
    np.testing.assert_allclose(entries.seen(entries.values(many))[0], found)


def test_the_same_path_played_faster_never_reads_less_sudden(unmuted, random_motion):
    rises = []
    for seed in range(10):
        readings = [
            read_effort(
                random_motion(np.random.default_rng(seed), size_m=0.02, pace=pace), unmuted
            ).time
            for pace in (0.2, 0.4, 0.7, 1.0, 1.5, 2.5, 5.0)
        ]
        assert (np.diff(readings) >= -0.05).all()  # at the poles hardly anything is left to tell
        rises.append(readings[-1] - readings[0])
    assert min(rises) > 0.4
    assert np.median(rises) > 1.5  # most go from one pole to the other


@pytest.mark.parametrize("n", [0, 1, 3])
def test_a_span_too_short_to_read_has_no_effort(n, shipped, random_motion):
    motion = random_motion(np.random.default_rng(0))
    few = type(motion)(*(getattr(motion, field.name)[:n] for field in fields(motion)))
    assert read_effort(few, shipped) == Effort()


def test_a_body_at_rest_has_no_effort(shipped, motion_of, columns):
    rng = np.random.default_rng(0)
    trembling = motion_of(
        lambda t: [0.005 * rng.normal(size=(len(t), 3)) for _ in range(4)],
        lambda t: (
            [np.tile([0.0, 0, 0, 1], (len(t), 1))]
            + [0.02 * rng.normal(size=(len(t), 3)) for _ in range(3)]
        ),
    )
    assert read_effort(trembling, shipped) == Effort()


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1.0, 1e3, 1e9])
def test_any_movement_has_a_reading_between_the_poles(scale, shipped, random_motion):
    motion = random_motion(np.random.default_rng(1))
    changed = {field.name: scale * getattr(motion, field.name) for field in fields(motion)[3:]}
    extreme = replace(motion, **changed)
    assert np.isfinite(effort_features(extreme)).all()
    effort = read_effort(extreme, shipped)  # Effort itself refuses NaN
    assert scale < 0.1 or effort.time is not None


def edited(shipped, *path, value=None, drop=False):
    document = json.loads(effort_model_to_json(shipped))
    at = document
    for key in path[:-1]:
        at = at[key]
    if drop:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return json.dumps(document)


TIME = ("axes", "time")
ALONE = ("alone", "axes", "time")
ENTRY = ("alone", "entries", 0)
OWN = ("own", "entries", 0)
STATES = ("alone", "states")


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("schema",), "other", r"schema: expected .laban.effort_model., found .other."),
        (("version",), 6, "version: expected 5, found 6, a newer version's$"),
        (("version",), 4, "version: expected 5, found 4, an older version's; train it again$"),
        (("version",), True, "version: expected a whole number, found true"),
        (("seed",), "x", "seed: expected a whole number"),
        (("trained_on",), None, "trained_on: expected text in quotes, found null"),
        (("axes",), {}, "axes: expected at least one"),
        (("axes",), [], "axes: expected an object, found a list"),
        (("axes", "mood"), {}, f"axes: expected some of {', '.join(AXES)}, found 'mood'"),
        (TIME, 3, r"axes.time: expected an object, found 3"),
        (("alone",), [], "alone: expected an object, found a list"),
        (("alone", "entries"), [], "alone.entries: expected at least one"),
        ((*ENTRY, "name"), "beauty", r"entries\[0\].name: expected a feature of this version"),
        ((*ENTRY, "time"), "heavy", r"entries\[0\].time: expected a number, found .heavy."),
        ((*ENTRY, "time"), float("nan"), r"entries\[0\].time: expected a finite number"),
        ((*ENTRY, "range"), [2.0, 1.0], r"entries\[0\].range: expected low, high"),
        ((*ENTRY, "range"), [2.0], r"entries\[0\].range: expected 2 numbers"),
        ((*ENTRY, "scale"), 0.0, r"entries\[0\].scale: expected a positive number"),
        ((*ENTRY, "unlike"), [1.0, 2.0], r"entries\[0\].unlike: expected 1 numbers"),
        ((*ENTRY, "size"), "x", r"entries\[0\].size: expected a number, found \"x\""),
        (("alone", "reach"), 0.0, "alone.reach: expected a positive number"),
        (("own", "size_spread"), -1.0, "own.size_spread: expected a positive number"),
        ((*ENTRY, "states"), [1, 2, 3, "x"], r"states\[3\]: expected a number"),
        ((*OWN, "typical"), None, r"own.entries\[0\].typical: expected a number, found null"),
        (("alone", "products", 0, "of"), ["log_path"], r"products\[0\].of: expected the names"),
        ((*ALONE, "bias"), float("inf"), "alone.axes.time.bias: expected a finite number"),
        ((*ALONE, "held_out_accuracy"), 1.5, "time.held_out_accuracy: expected a number"),
        ((*ALONE, "members", "vigour"), 1.5, "time.members.vigour: expected a number"),
        ((*STATES, "bias"), [0.0], "alone.states.bias: expected 4 numbers"),
        ((*STATES, "names"), ["quick"], "alone.states.names: expected sustained light"),
        ((*TIME, "examples", "sudden"), -1, "axes.time.examples.sudden: expected a count"),
        ((*TIME, "performers"), 2.5, "axes.time.performers: expected a whole number, found 2.5"),
    ],
)
def test_a_damaged_model_is_refused_by_file_and_key(shipped, tmp_path, path, value, said):
    file = tmp_path / "mine.json"
    file.write_text(edited(shipped, *path, value=value), encoding="utf-8")
    with pytest.raises(LabanError, match=said) as caught:
        load_effort_model(file)
    assert str(file) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "path", [("schema",), ("axes",), ALONE, (*ALONE, "bias"), (*ENTRY, "weight"), ("own",)]
)
def test_a_missing_key_is_named(shipped, path):
    with pytest.raises(LabanError, match=f'expected the key "{path[-1]}", found none'):
        effort_model_from_json(edited(shipped, *path, drop=True), source="m.json")


def test_a_feature_that_is_there_twice_is_refused(shipped):
    name = json.loads(effort_model_to_json(shipped))["alone"]["entries"][1]["name"]
    with pytest.raises(LabanError, match="expected each feature once"):
        effort_model_from_json(edited(shipped, *ENTRY, "name", value=name), source="m.json")


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"", "expected JSON"), (b"[]", "expected an object, found a list"), (b"\xff\xfe", "UTF-8")],
)
def test_what_is_no_model_is_refused(content, said, tmp_path):
    (tmp_path / "m.json").write_bytes(content)
    with pytest.raises(LabanError, match=said):
        load_effort_model(tmp_path / "m.json")


def test_a_model_that_is_not_there_is_said_so(tmp_path):
    with pytest.raises(LabanError, match="expected a model file, found none"):
        load_effort_model(tmp_path / "absent.json")


def test_every_axis_has_its_row():
    words = [word for poles in POLES.values() for word in (*poles, NEUTRAL)]
    assert len(set(words)) == 2 * len(AXES) + 1
    assert tuple(POLES) == tuple(EFFORT_STEPS) == AXES
    assert min(EFFORT_STEPS.values()) >= 1
    for axis, (low, high) in POLES.items():
        assert f"{axis} : {low} -1 … +1 {high}." in Effort.__doc__
