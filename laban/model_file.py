"""The file of an `EffortModel`: JSON that a person can read, one entry a line.

Version 2 has two readers an axis and joint states; version 1, whose only reader is the paper's,
is upgraded when it is read. A file says which entries of a description it uses by name, and one
that this version does not know is refused.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from laban.calibration import Calibration
from laban.classifier import NaiveBayes
from laban.description import DESCRIPTION_NAMES
from laban.effort import AXES, LabanError
from laban.linear import Linear, Softmax
from laban.model import NEUTRAL, POLES, STATES, AxisModel, EffortModel, JointModel
from laban.reader import Entries, Reader, StateReader
from laban.record import Record

SCHEMA = "laban.effort_model"
VERSION = 2


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
    """Return the model as JSON text, one entry a line."""
    document = {
        "schema": SCHEMA,
        "version": VERSION,
        "trained_on": model.trained_on,
        "seed": model.seed,
        "axes": {axis: _axis_record(axis, part) for axis, part in model.axes.items()},
        "joint": model.joint and _joint_record(model.joint),
    }
    return _text(document) + "\n"


def effort_model_from_json(text: str, *, source: str) -> EffortModel:
    """Return the model that ``text`` describes; ``source`` is its name in error messages."""
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise LabanError(f"{source}: expected JSON, but {error}") from error
    record = Record(document, source, "model")
    schema, version = record.get("schema", str), record.get("version", int)
    if schema != SCHEMA:
        raise LabanError(f"{source}: schema: expected {SCHEMA!r}, got {schema!r}")
    if version not in (1, VERSION):
        newer = ", a newer version's" if version > VERSION else ""
        raise LabanError(f"{source}: version: expected 1 to {VERSION}, got {version}{newer}")
    axes = Record(record.get("axes", dict), source, "axes")
    for name in axes.content:
        if name not in AXES:
            raise LabanError(f"{source}: axes: expected some of {', '.join(AXES)}, got {name!r}")
    if not axes.content:
        raise LabanError(f"{source}: axes: expected at least one, got none")
    entries = {name: axes.get(name, dict) for name in axes.content}
    if version == 1:
        entries = {name: _upgraded(entry) for name, entry in entries.items()}
    joint = record.content.get("joint")
    return EffortModel(
        axes={name: _axis_from(entry, source, name) for name, entry in entries.items()},
        trained_on=record.get("trained_on", str),
        seed=record.get("seed", int | None),
        joint=_joint_from(joint, source) if joint is not None else None,
    )


def _upgraded(axis: dict[str, Any]) -> dict[str, Any]:
    """Return an axis of version 1 as version 2 has it."""
    kept: dict[str, Any] = {key: axis[key] for key in ("examples", "performers") if key in axis}
    reader = {key: value for key, value in axis.items() if key not in kept}
    return {**kept, "alone": {"family": "naive Bayes", **reader}, "own": None}


def _axis_record(axis: str, part: AxisModel) -> dict[str, Any]:
    low, high = POLES[axis]
    return {
        "examples": dict(zip((low, NEUTRAL, high), part.examples, strict=True)),
        "performers": part.performers,
        "alone": _reader_record(part.alone),
        "own": part.own and _reader_record(part.own),
    }


def _reader_record(reader: Reader) -> dict[str, Any]:
    classifier = reader.classifier
    features = _entry_records(reader.entries)
    head: dict[str, Any] = {
        "family": reader.family,
        "held_out_accuracy": reader.held_out_accuracy,
        "calibration": np.stack(
            [reader.calibration.log_odds, reader.calibration.reading], 1
        ).tolist(),
    }
    if isinstance(classifier, NaiveBayes):
        head["prior_high"] = classifier.prior_high
        for i, feature in enumerate(features):
            feature["mean"] = classifier.mean[:, i].tolist()
            feature["variance"] = classifier.variance[:, i].tolist()
    else:
        head["bias"] = classifier.bias
        for feature, weight in zip(features, classifier.weight.tolist(), strict=True):
            feature["weight"] = weight
    return {**head, "features": features}


def _joint_record(joint: JointModel) -> dict[str, Any]:
    record: dict[str, Any] = {"states": [_state_name(state) for state in STATES]}
    for name, reader in (("alone", joint.alone), ("own", joint.own)):
        features = _entry_records(reader.entries)
        for feature, weights in zip(features, reader.classifier.weight.T.tolist(), strict=True):
            feature["weights"] = weights
        record[name] = {
            "held_out_accuracy": reader.held_out_accuracy,
            "bias": reader.classifier.bias.tolist(),
            "features": features,
        }
    return record


def _entry_records(entries: Entries) -> list[dict[str, Any]]:
    records = []
    for i, column in enumerate(entries.columns.tolist()):
        record: dict[str, Any] = {
            "name": DESCRIPTION_NAMES[column],
            "range": [entries.lowest[i], entries.highest[i]],
        }
        if entries.typical is not None:
            record["typical"] = entries.typical[i]
        records.append(record)
    return records


def _state_name(state: tuple[float, float]) -> str:
    time, weight = state
    return f"{POLES['time'][int(time > 0)]} {POLES['weight'][int(weight > 0)]}"


def _text(value: Any, depth: int = 0) -> str:
    """Return JSON with objects of objects and lists of objects over several lines."""
    pad = " " * (depth + 1)
    if isinstance(value, dict) and (depth == 0 or any(_is_deep(v) for v in value.values())):
        lines = [f"{pad}{json.dumps(k)}: {_text(v, depth + 1)}" for k, v in value.items()]
        return "{\n" + ",\n".join(lines) + "\n" + " " * depth + "}"
    if isinstance(value, list) and any(isinstance(v, dict) for v in value):
        return "[\n" + ",\n".join(pad + json.dumps(v) for v in value) + "\n" + " " * depth + "]"
    return json.dumps(value)


def _is_deep(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and any(isinstance(v, dict) for v in value)
    )


def _axis_from(content: dict[str, Any], source: str, axis: str) -> AxisModel:
    """Return one axis of a model file, checked."""
    record = Record(content, source, f"axes.{axis}")
    examples = Record(record.get("examples", dict), source, f"axes.{axis}.examples")
    low, high = POLES[axis]
    own = record.get("own", dict | None)
    return AxisModel(
        alone=_reader_from(record.get("alone", dict), source, f"axes.{axis}.alone", False),
        own=None if own is None else _reader_from(own, source, f"axes.{axis}.own", True),
        examples=(examples.count(low), examples.count(NEUTRAL), examples.count(high)),
        performers=record.count("performers"),
    )


def _reader_from(content: dict[str, Any], source: str, where: str, own: bool) -> Reader:
    record = Record(content, source, where)
    features, entries = _entries_from(record, source, where, own)
    knots = record.pairs("calibration")
    if (np.diff(knots, axis=0) < 0).any() or (np.abs(knots[:, 1]) > 1).any():
        raise record.fault("calibration", "expected rising pairs of log odds and a reading")
    classifier: NaiveBayes | Linear
    if "bias" in content:
        weight = np.array([feature.number("weight") for feature in features])
        classifier = Linear(weight, record.number("bias"))
    else:
        classifier = NaiveBayes(
            np.array([feature.pair("mean") for feature in features]).T,
            np.array([feature.pair("variance", positive=True) for feature in features]).T,
            record.number("prior_high", 0.0, 1.0, open_ends=True),
        )
    return Reader(
        family=record.get("family", str),
        entries=entries,
        classifier=classifier,
        calibration=Calibration(knots[:, 0], knots[:, 1]),
        held_out_accuracy=record.number("held_out_accuracy", 0.0, 1.0),
    )


def _joint_from(content: object, source: str) -> JointModel:
    record = Record(content, source, "joint")
    expected = [_state_name(state) for state in STATES]
    if record.get("states", list) != expected:
        raise record.fault("states", f"expected {', '.join(expected)}")
    readers = []
    for name in ("alone", "own"):
        where = f"joint.{name}"
        part = Record(record.get(name, dict), source, where)
        features, entries = _entries_from(part, source, where, name == "own")
        weights = [feature.numbers("weights", len(STATES)) for feature in features]
        readers.append(
            StateReader(
                entries,
                Softmax(np.array(weights).T, np.array(part.numbers("bias", len(STATES)))),
                part.number("held_out_accuracy", 0.0, 1.0),
            )
        )
    return JointModel(*readers)


def _entries_from(
    record: Record, source: str, where: str, own: bool
) -> tuple[list[Record], Entries]:
    """Return a reader's list of features, and which entries of a description they are."""
    listed = record.get("features", list)
    if not listed:
        raise record.fault("features", "expected at least one, got none")
    features = [Record(entry, source, f"{where}.features[{i}]") for i, entry in enumerate(listed)]
    names = [feature.get("name", str) for feature in features]
    for i, (feature, name) in enumerate(zip(features, names, strict=True)):
        if name not in DESCRIPTION_NAMES:
            raise feature.fault("name", f"expected a feature of this version, got {name!r}")
        if name in names[:i]:
            raise feature.fault("name", f"{name!r} is there twice")
    ranges = np.array([feature.pair("range") for feature in features]).T
    if (ranges[0] > ranges[1]).any():
        raise features[int(np.argmax(ranges[0] > ranges[1]))].fault("range", "expected low, high")
    typical = np.array([feature.number("typical") for feature in features]) if own else None
    columns = np.array([DESCRIPTION_NAMES.index(name) for name in names], dtype=np.int64)
    return features, Entries(columns, ranges[0], ranges[1], typical)
