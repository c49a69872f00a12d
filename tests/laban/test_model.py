from __future__ import annotations

import json
from dataclasses import fields, replace

import numpy as np
import pytest

from laban import AXES, Effort, LabanError, effort_features, load_effort_model, read_effort
from laban.model import effort_model_from_json, effort_model_to_json, save_effort_model


@pytest.fixture(scope="module")
def shipped():
    return load_effort_model()


def test_the_shipped_model_reads_time_and_weight(shipped):
    assert tuple(shipped.axes) == ("time", "weight")
    assert shipped.seed is not None


def test_a_model_is_the_same_after_saving_and_loading(shipped, tmp_path):
    save_effort_model(shipped, tmp_path / "model.json")
    again = load_effort_model(tmp_path / "model.json")
    assert effort_model_to_json(again) == effort_model_to_json(shipped)
    for axis, part in shipped.axes.items():
        np.testing.assert_array_equal(again.axes[axis].bayes.mean, part.bayes.mean)
        np.testing.assert_array_equal(again.axes[axis].columns, part.columns)


def test_axes_that_were_not_trained_are_not_read(shipped, random_motion):
    effort = read_effort(random_motion(np.random.default_rng(0)), shipped)
    assert effort.time is not None
    assert effort.weight is not None
    assert effort.space is None
    assert effort.flow is None


@pytest.mark.parametrize("seed", range(5))
def test_the_same_path_played_faster_never_reads_less_sudden(seed, shipped, random_motion):
    readings = [
        read_effort(
            random_motion(np.random.default_rng(seed), size_m=0.02, pace=pace), shipped
        ).time
        for pace in (0.2, 0.4, 0.7, 1.0, 1.5, 2.5, 5.0)
    ]
    assert (np.diff(readings) >= -0.02).all()
    assert readings[-1] - readings[0] > 0.5


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
FEATURE = (*TIME, "features", 0)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("schema",), "other", r"schema: expected 'laban.effort_model', got 'other'"),
        (("version",), 2, "version: expected 1, got 2"),
        (("version",), True, "version: got true or false"),
        (("seed",), "x", "seed: got a string"),
        (("trained_on",), None, "trained_on: got null"),
        (("axes",), {}, "axes: expected at least one"),
        (("axes",), [], "axes: got a list"),
        (("axes", "mood"), {}, "axes: expected some of time, weight, space, flow, got 'mood'"),
        (TIME, 3, r"axes.time: got the number 3"),
        ((*TIME, "features"), [], "axes.time.features: expected at least one"),
        ((*FEATURE, "name"), "beauty", r"features\[0\].name: expected a feature of this version"),
        ((*FEATURE, "mean"), [1.0], r"features\[0\].mean: expected two numbers"),
        ((*FEATURE, "mean"), [1.0, float("nan")], r"features\[0\].mean: expected two numbers"),
        ((*FEATURE, "variance"), [1.0, 0.0], r"features\[0\].variance: expected two positive"),
        ((*FEATURE, "range"), [2.0, 1.0], r"features\[0\].range: expected lowest and highest"),
        ((*TIME, "prior_high"), 1.0, "axes.time.prior_high: expected a number from 0 to 1"),
        ((*TIME, "held_out_accuracy"), 1.5, "axes.time.held_out_accuracy: expected a number"),
        ((*TIME, "calibration"), [], "axes.time.calibration: expected a list of pairs"),
        ((*TIME, "calibration"), [[0, 0], [1, -1]], "axes.time.calibration: expected pairs"),
        ((*TIME, "calibration"), [[0, 2]], "axes.time.calibration: expected pairs"),
        ((*TIME, "examples", "sudden"), -1, "axes.time.examples.sudden: expected a count"),
        ((*TIME, "performers"), 2.5, "axes.time.performers: got the number 2.5"),
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
    "path", [("schema",), ("axes",), (*TIME, "calibration"), (*FEATURE, "mean")]
)
def test_a_missing_key_is_named(shipped, path):
    with pytest.raises(LabanError, match=f"{path[-1]}: it is missing"):
        effort_model_from_json(edited(shipped, *path, drop=True), source="m.json")


def test_a_feature_that_is_there_twice_is_refused(shipped):
    name = json.loads(effort_model_to_json(shipped))["axes"]["time"]["features"][1]["name"]
    with pytest.raises(LabanError, match="is there twice"):
        effort_model_from_json(edited(shipped, *FEATURE, "name", value=name), source="m.json")


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"", "expected JSON"), (b"[]", "expected an object, got a list"), (b"\xff\xfe", "UTF-8")],
)
def test_what_is_no_model_is_refused(content, said, tmp_path):
    (tmp_path / "m.json").write_bytes(content)
    with pytest.raises(LabanError, match=said):
        load_effort_model(tmp_path / "m.json")


def test_a_model_that_is_not_there_is_said_so(tmp_path):
    with pytest.raises(LabanError, match="No such file"):
        load_effort_model(tmp_path / "absent.json")


def test_every_axis_has_its_words():
    from laban.model import POLES

    assert tuple(POLES) == AXES
