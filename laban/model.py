"""EffortModel: what was learned, as a file that a person can read; and reading with it.

A model is small and frozen. Learning is in `laban.training`; this module needs NumPy alone and
is what live code loads.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from laban.calibration import Calibration
from laban.classifier import NaiveBayes
from laban.effort import AXES, Effort, LabanError
from laban.features import FEATURE_NAMES, MIN_SAMPLES, SLOW_M_S, effort_features
from laban.motion import FloatArray, RigidMotion

SCHEMA = "laban.effort_model"
VERSION = 1

POLES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "time": ("sustained", "sudden"),
        "weight": ("light", "strong"),
        "space": ("indirect", "direct"),
        "flow": ("free", "bound"),
    }
)
"""The words for -1 and 1 on each axis."""

NEUTRAL = "neutral"
"""The word for neither pole."""

STILL_RAD_S = 0.1
"""A body that turns no faster and moves no faster than `SLOW_M_S` (RMS) is at rest."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisModel:
    """How one axis is read.

    Attributes
    ----------
    columns : (m,) of the feature vector, most relevant first, at least one, none twice.
    lowest, highest : (m,) range of these features; values beyond are taken as its ends
        (`laban.classifier.telling_range`).
    bayes : the classifier of these m features.
    calibration : from its log odds to the reading.
    examples : takes of the low pole, neither and the high pole.
    performers : how many people they come from.
    held_out_accuracy : share of takes whose pole was told by a model that had not seen the
        performer.
    """

    columns: NDArray[np.int64]
    lowest: FloatArray
    highest: FloatArray
    bayes: NaiveBayes
    calibration: Calibration
    examples: tuple[int, int, int]
    performers: int
    held_out_accuracy: float

    def value(self, features: FloatArray) -> float:
        """Return the reading of a feature vector ``(50,)``, in [-1, 1]."""
        seen = np.clip(features[self.columns], self.lowest, self.highest)
        return self.calibration.value(float(self.bayes.log_odds(seen)))


@dataclass(frozen=True, slots=True, eq=False)
class EffortModel:
    """A trained reader of Effort.

    Attributes
    ----------
    axes : by name, those of `laban.AXES` that were trained; at least one.
    trained_on : what the examples were, for people.
    seed : of the examples, where they were simulated.
    """

    axes: Mapping[str, AxisModel]
    trained_on: str
    seed: int | None = None

    def __post_init__(self) -> None:
        if not self.axes or any(axis not in AXES for axis in self.axes):
            raise LabanError(f"axes: expected some of {', '.join(AXES)}, got {list(self.axes)}")
        in_order = {axis: self.axes[axis] for axis in AXES if axis in self.axes}
        object.__setattr__(self, "axes", MappingProxyType(in_order))


def read_effort(motion: RigidMotion, model: EffortModel) -> Effort:
    """Return the Effort of one span of movement.

    Axes that the model was not trained for are None. All are where there is nothing to read: in
    fewer than `laban.features.MIN_SAMPLES` samples, and in a body at rest.
    """
    if len(motion) < MIN_SAMPLES or is_still(motion):
        return Effort()
    features = effort_features(motion)
    return Effort(**{axis: part.value(features) for axis, part in model.axes.items()})


def is_still(motion: RigidMotion) -> bool:
    """Return whether the body is at rest: RMS speed and angular speed at most a tremor's."""
    speed = math.sqrt(float(np.sum(motion.velocity_m_s**2)) / len(motion))
    turning = math.sqrt(float(np.sum(motion.angular_velocity_rad_s**2)) / len(motion))
    return speed <= SLOW_M_S and turning <= STILL_RAD_S


def load_effort_model(path: Path | str | None = None) -> EffortModel:
    """Load a model; None loads the shipped one.

    Raises
    ------
    LabanError
        If the file is missing or is not such a model; the message names file and key.
    """
    if path is None:
        from importlib.resources import files

        shipped = files("laban") / "models" / "default.json"
        return effort_model_from_json(shipped.read_text(encoding="utf-8"), source="default.json")
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise LabanError(f"{path}: expected a model file, but {reason}") from error
    return effort_model_from_json(text, source=str(path))


def save_effort_model(model: EffortModel, path: Path | str) -> None:
    """Write a model as JSON; loading it gives equal numbers."""
    Path(path).write_text(effort_model_to_json(model), encoding="utf-8", newline="\n")


def effort_model_to_json(model: EffortModel) -> str:
    """Return the model as JSON text, one feature a line."""
    head = {
        "schema": SCHEMA,
        "version": VERSION,
        "trained_on": model.trained_on,
        "seed": model.seed,
    }
    lines = ["{"]
    lines += [f" {json.dumps(key)}: {json.dumps(value)}," for key, value in head.items()]
    lines.append(' "axes": {')
    axes = [_axis_lines(axis, part) for axis, part in model.axes.items()]
    lines += ",\n".join(axes).split("\n")
    lines += [" }", "}"]
    return "\n".join(lines) + "\n"


def _axis_lines(axis: str, part: AxisModel) -> str:
    """Return one axis as lines of JSON."""
    low, high = POLES[axis]
    head = {
        "examples": dict(zip((low, NEUTRAL, high), part.examples, strict=True)),
        "performers": part.performers,
        "held_out_accuracy": part.held_out_accuracy,
        "prior_high": part.bayes.prior_high,
        "calibration": np.stack([part.calibration.log_odds, part.calibration.reading], 1).tolist(),
    }
    features = [
        {
            "name": FEATURE_NAMES[column],
            "range": [part.lowest[i], part.highest[i]],
            "mean": part.bayes.mean[:, i].tolist(),
            "variance": part.bayes.variance[:, i].tolist(),
        }
        for i, column in enumerate(part.columns)
    ]
    lines = [f"  {json.dumps(axis)}: {{"]
    lines += [f"   {json.dumps(key)}: {json.dumps(value)}," for key, value in head.items()]
    lines.append('   "features": [')
    lines.append(",\n".join(f"    {json.dumps(feature)}" for feature in features))
    lines += ["   ]", "  }"]
    return "\n".join(lines)


def effort_model_from_json(text: str, *, source: str) -> EffortModel:
    """Return the model that ``text`` describes; ``source`` is its name in error messages."""
    try:
        document = json.loads(text)
    except ValueError as error:
        raise LabanError(f"{source}: expected JSON, but {error}") from error
    record = _Record(document, source, "model")
    schema, version = record.get("schema", str), record.get("version", int)
    if schema != SCHEMA:
        raise LabanError(f"{source}: schema: expected {SCHEMA!r}, got {schema!r}")
    if version != VERSION:
        raise LabanError(f"{source}: version: expected {VERSION}, got {version}")
    axes = _Record(record.get("axes", dict), source, "axes")
    for name in axes.content:
        if name not in AXES:
            raise LabanError(f"{source}: axes: expected some of {', '.join(AXES)}, got {name!r}")
    if not axes.content:
        raise LabanError(f"{source}: axes: expected at least one, got none")
    seed = record.get("seed", int | None)
    return EffortModel(
        axes={name: _axis_from(axes.get(name, dict), source, name) for name in axes.content},
        trained_on=record.get("trained_on", str),
        seed=seed,
    )


def _axis_from(content: dict[str, Any], source: str, axis: str) -> AxisModel:
    """Return one axis of a model file, checked."""
    record = _Record(content, source, f"axes.{axis}")
    examples = _Record(record.get("examples", dict), source, f"axes.{axis}.examples")
    low, high = POLES[axis]
    listed = record.get("features", list)
    if not listed:
        raise LabanError(f"{source}: axes.{axis}.features: expected at least one, got none")
    features = [
        _Record(entry, source, f"axes.{axis}.features[{i}]") for i, entry in enumerate(listed)
    ]
    names = [feature.get("name", str) for feature in features]
    for i, name in enumerate(names):
        if name not in FEATURE_NAMES:
            raise LabanError(
                f"{source}: axes.{axis}.features[{i}].name: expected a feature of this version, "
                f"got {name!r}"
            )
        if name in names[:i]:
            raise LabanError(f"{source}: axes.{axis}.features[{i}].name: {name!r} is there twice")
    ranges = np.array([feature.pair("range") for feature in features]).T
    mean = np.array([feature.pair("mean") for feature in features]).T
    variance = np.array([feature.pair("variance", positive=True) for feature in features]).T
    for i, (lowest, highest) in enumerate(ranges.T):
        if lowest > highest:
            raise LabanError(
                f"{source}: axes.{axis}.features[{i}].range: expected lowest and highest, "
                f"got {lowest:g} and {highest:g}"
            )
    return AxisModel(
        columns=np.array([FEATURE_NAMES.index(name) for name in names]),
        lowest=ranges[0],
        highest=ranges[1],
        bayes=NaiveBayes(mean, variance, record.number("prior_high", 0.0, 1.0, open_ends=True)),
        calibration=_calibration_from(record),
        examples=(examples.count(low), examples.count(NEUTRAL), examples.count(high)),
        performers=record.count("performers"),
        held_out_accuracy=record.number("held_out_accuracy", 0.0, 1.0),
    )


def _calibration_from(record: _Record) -> Calibration:
    """Return the calibration of an axis, checked."""
    knots = record.pairs("calibration")
    if np.diff(knots, axis=0).min(initial=0.0) < 0 or np.abs(knots[:, 1]).max() > 1.0:
        raise record.fault(
            "calibration", "expected pairs of log odds and reading in [-1, 1] that never fall"
        )
    return Calibration(knots[:, 0], knots[:, 1])


class _Record:
    """A JSON object with a name for messages, whose entries are checked as they are taken."""

    def __init__(self, content: object, source: str, name: str) -> None:
        if not isinstance(content, dict):
            raise LabanError(f"{source}: {name}: expected an object, got {_kind(content)}")
        self.content: dict[str, Any] = content
        self._source = source
        self._name = name

    def get(self, key: str, kind: Any) -> Any:
        """Return an entry of the given type."""
        if key not in self.content:
            raise self.fault(key, "it is missing")
        value = self.content[key]
        if not isinstance(value, kind) or isinstance(value, bool):
            raise self.fault(key, f"got {_kind(value)}")
        return value

    def number(
        self,
        key: str,
        low: float = -math.inf,
        high: float = math.inf,
        *,
        open_ends: bool = False,
    ) -> float:
        """Return a finite number from ``low`` to ``high``, strictly between with open ends."""
        value = self.get(key, int | float)
        inside = low < value < high if open_ends else low <= value <= high
        if not (math.isfinite(value) and inside):
            raise self.fault(key, f"expected a number from {low:g} to {high:g}, got {value!r}")
        return float(value)

    def count(self, key: str) -> int:
        """Return a whole number, not negative."""
        value = int(self.get(key, int))
        if value < 0:
            raise self.fault(key, f"expected a count, got {value}")
        return value

    def pair(self, key: str, *, positive: bool = False) -> tuple[float, float]:
        """Return two finite numbers."""
        values = self.get(key, list)
        if not _is_pair(values) or (positive and min(values) <= 0):
            wanted = "two positive numbers" if positive else "two numbers"
            raise self.fault(key, f"expected {wanted}, got {values!r}")
        return float(values[0]), float(values[1])

    def pairs(self, key: str) -> FloatArray:
        """Return a list of pairs of finite numbers, at least one, as ``(k, 2)``."""
        values = self.get(key, list)
        if not values or not all(_is_pair(value) for value in values):
            raise self.fault(key, "expected a list of pairs of numbers")
        return np.array(values, dtype=np.float64)

    def fault(self, key: str, what: str) -> LabanError:
        """Return the error for an entry."""
        return LabanError(f"{self._source}: {self._name}.{key}: {what}")


def _is_pair(value: object) -> bool:
    """Return whether a JSON value is a list of two finite numbers."""
    return (
        isinstance(value, list)
        and len(value) == 2
        and all(type(v) in (int, float) and math.isfinite(v) for v in value)
    )


def _kind(value: object) -> str:
    """Return the JSON name of a value's type."""
    names = {dict: "an object", list: "a list", str: "a string", bool: "true or false"}
    if value is None:
        return "null"
    return names.get(type(value), f"the number {value!r}")
