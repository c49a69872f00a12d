"""The file of an `EffortModel`: JSON that a person can read, one entry a line.

It has two readers, each a list of entries of a description and of products of them, with what
they weigh on each axis. A file says which entries it uses by name, and one that this version does
not know is refused.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from laban.description import DESCRIPTION_NAMES
from laban.effort import AXES, NEUTRAL, POLES, LabanError
from laban.linear import Linear, Softmax
from laban.model import STATES, EffortModel, Taught, state_words
from laban.motion import FloatArray
from laban.reader import AxisReader, Entries, Reader, StateReader
from laban.record import Record
from laban.size import Sizes

SCHEMA = "laban.effort_model"
VERSION = 5


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
        "axes": {axis: _taught_record(axis, taught) for axis, taught in model.axes.items()},
        "alone": _reader_record(model.alone),
        "own": _reader_record(model.own),
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
    if version != VERSION:
        whose = "a newer version's" if version > VERSION else "an older version's; train it again"
        raise LabanError(f"{source}: version: expected {VERSION}, got {version}, {whose}")
    axes = Record(record.get("axes", dict), source, "axes")
    for name in axes.content:
        if name not in AXES:
            raise LabanError(f"{source}: axes: expected some of {', '.join(AXES)}, got {name!r}")
    if not axes.content:
        raise LabanError(f"{source}: axes: expected at least one, got none")
    names = [axis for axis in AXES if axis in axes.content]
    return EffortModel(
        axes={axis: _taught_from(axes.get(axis, dict), source, axis) for axis in names},
        alone=_reader_from(Record(record.get("alone", dict), source, "alone"), names, own=False),
        own=_reader_from(Record(record.get("own", dict), source, "own"), names, own=True),
        trained_on=record.get("trained_on", str),
        seed=record.get("seed", int | None),
    )


def _taught_record(axis: str, taught: Taught) -> dict[str, Any]:
    low, high = POLES[axis]
    return {
        "examples": dict(zip((low, NEUTRAL, high), taught.examples, strict=True)),
        "performers": taught.performers,
    }


def _reader_record(reader: Reader) -> dict[str, Any]:
    entries, states = reader.entries, reader.states
    weights: dict[str, list[Any]] = {
        axis: part.classifier.weight.tolist() for axis, part in reader.axes.items()
    }
    if states is not None:
        weights["states"] = states.classifier.weight.T.tolist()
    weighed = [dict(zip(weights, row, strict=True)) for row in zip(*weights.values(), strict=True)]
    names = [DESCRIPTION_NAMES[column] for column in entries.columns.tolist()]
    listed = []
    for i, name in enumerate(names):
        entry: dict[str, Any] = {
            "name": name,
            "range": [entries.lowest[i], entries.highest[i]],
            "centre": entries.centre[i],
            "scale": entries.scale[i],
            "usual": entries.sizes.centre[i],
            "size": entries.sizes.weight[i],
            "unlike": entries.unlike[i, : i + 1].tolist(),
        }
        if entries.typical is not None:
            entry["typical"] = entries.typical[i]
        listed.append({**entry, **weighed[i]})
    products = [
        {"of": [names[i] for i in pair], **weights}
        for pair, weights in zip(entries.pairs.tolist(), weighed[len(names) :], strict=True)
    ]
    return {
        "axes": {
            axis: {
                "held_out_accuracy": part.held_out_accuracy,
                "members": dict(part.members),
                "bias": part.classifier.bias,
            }
            for axis, part in reader.axes.items()
        },
        "states": states
        and {
            "names": [" ".join(state_words(state)) for state in STATES],
            "held_out_accuracy": states.held_out_accuracy,
            "bias": states.classifier.bias.tolist(),
        },
        "size_spread": entries.sizes.spread,
        "reach": reader.reach,
        "entries": listed,
        "products": products,
    }


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


def _taught_from(content: dict[str, Any], source: str, axis: str) -> Taught:
    record = Record(content, source, f"axes.{axis}")
    examples = Record(record.get("examples", dict), source, f"axes.{axis}.examples")
    low, high = POLES[axis]
    return Taught(
        examples=(examples.count(low), examples.count(NEUTRAL), examples.count(high)),
        performers=record.count("performers"),
    )


def _reader_from(record: Record, axes: list[str], *, own: bool) -> Reader:
    """Return a reader of some axes, checked."""
    listed, products = record.records("entries"), record.records("products")
    if not listed:
        raise record.fault("entries", "expected at least one, got none")
    spread = record.number("size_spread", 0.0, open_ends=True)
    entries = _entries_from(listed, products, spread, own=own)
    reach = record.number("reach", 0.0, open_ends=True)
    weighed = [*listed, *products]
    parts = record.record("axes")
    readers = {}
    for axis in axes:
        part = parts.record(axis)
        readers[axis] = AxisReader(
            Linear(np.array([one.number(axis) for one in weighed]), part.number("bias")),
            _members_from(part.record("members")),
            part.number("held_out_accuracy", 0.0, 1.0),
        )
    if record.get("states", dict | None) is None:
        return Reader(entries, readers, reach)
    states = record.record("states")
    expected = [" ".join(state_words(state)) for state in STATES]
    if states.get("names", list) != expected:
        raise states.fault("names", f"expected {', '.join(expected)}")
    weight = np.array([one.numbers("states", len(STATES)) for one in weighed]).T
    return Reader(
        entries,
        readers,
        reach,
        StateReader(
            Softmax(weight, np.array(states.numbers("bias", len(STATES)))),
            states.number("held_out_accuracy", 0.0, 1.0),
        ),
    )


def _members_from(record: Record) -> Mapping[str, float]:
    return {name: record.number(name, 0.0, 1.0) for name in record.content}


def _entries_from(
    listed: list[Record], products: list[Record], size_spread: float, *, own: bool
) -> Entries:
    """Return which entries of a description a reader looks at, and which products of them."""
    names = [one.get("name", str) for one in listed]
    for i, (one, name) in enumerate(zip(listed, names, strict=True)):
        if name not in DESCRIPTION_NAMES:
            raise one.fault("name", f"expected a feature of this version, got {name!r}")
        if name in names[:i]:
            raise one.fault("name", f"{name!r} is there twice")
    ranges = np.array([one.pair("range") for one in listed])
    for one, (low, high) in zip(listed, ranges, strict=True):
        if low > high:
            raise one.fault("range", "expected low, high")
    pairs = [product.get("of", list) for product in products]
    for product, pair in zip(products, pairs, strict=True):
        if len(pair) != 2 or any(name not in names for name in pair):
            raise product.fault("of", f"expected the names of two entries, got {pair!r}")
    columns = np.array([DESCRIPTION_NAMES.index(name) for name in names], dtype=np.int64)
    return Entries(
        columns=columns,
        lowest=ranges[:, 0],
        highest=ranges[:, 1],
        centre=np.array([one.number("centre") for one in listed]),
        scale=np.array([one.number("scale", 0.0, open_ends=True) for one in listed]),
        pairs=np.array(
            [[names.index(name) for name in pair] for pair in pairs], dtype=np.int64
        ).reshape(-1, 2),
        unlike=_lower_triangle([one.numbers("unlike", i + 1) for i, one in enumerate(listed)]),
        sizes=Sizes(
            columns,
            np.array([one.number("usual") for one in listed]),
            np.array([one.number("size") for one in listed]),
            size_spread,
        ),
        typical=np.array([one.number("typical") for one in listed]) if own else None,
    )


def _lower_triangle(rows: list[list[float]]) -> FloatArray:
    """Return the square matrix of rows of 1, 2, 3 … numbers."""
    matrix = np.zeros((len(rows), len(rows)))
    for i, row in enumerate(rows):
        matrix[i, : i + 1] = row
    return matrix
