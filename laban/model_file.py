"""The file of an `EffortModel`: JSON that a person can read, one entry a line.

It has two readers. Each is a list of entries of a description and of products of them, with their
weights on each axis. A file names the entries it uses; one that this version does not know is
refused.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from laban.description import DESCRIPTION_NAMES
from laban.effort import AXES, NEUTRAL, POLES, LabanError
from laban.faults import naming
from laban.json_node import Node, parse_json, read_json, shown
from laban.linear import Linear, Softmax
from laban.model import STATES, EffortModel, Taught, state_words
from laban.motion import FloatArray
from laban.reader import AxisReader, Entries, Reader, StateReader
from laban.size import Sizes

SCHEMA = "laban.effort_model"
VERSION = 5


def load_effort_model(path: Path | str | None = None) -> EffortModel:
    """Load a model; None is the shipped one, which is read once.

    Raises
    ------
    LabanError
        If the file is missing or is not such a model; the message names file and key.
    """
    if path is None:
        return _shipped()
    with naming(path, LabanError):
        return _model(read_json(Path(path), "a model file"))


@cache
def _shipped() -> EffortModel:
    """Read the shipped model; it is immutable, so all may share it."""
    from importlib.resources import files

    text = (files("laban") / "models" / "default.json").read_text(encoding="utf-8")
    return effort_model_from_json(text, source="default.json")


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
    with naming(source, LabanError):
        return _model(parse_json(text))


def _model(node: Node) -> EffortModel:
    schema, version = node.member("schema"), node.member("version")
    if schema.text() != SCHEMA:
        raise schema.fault(f'"{SCHEMA}"')
    if version.whole() != VERSION:
        newer = version.whole() > VERSION
        whose = "a newer version's" if newer else "an older version's; train it again"
        raise version.fault(f"{VERSION}", f"{version.value}, {whose}")
    axes = node.member("axes").options()
    for axis in axes:
        if axis not in AXES:
            raise node.member("axes").fault(f"some of {', '.join(AXES)}", repr(axis))
    if not axes:
        raise node.member("axes").fault("at least one", "none")
    names = [axis for axis in AXES if axis in axes]
    seed = node.member("seed")
    return EffortModel(
        axes={axis: _taught_from(axes[axis], axis) for axis in names},
        alone=_reader_from(node.member("alone"), names, own=False),
        own=_reader_from(node.member("own"), names, own=True),
        trained_on=node.member("trained_on").text(),
        seed=None if seed.value is None else seed.whole(),
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


def _taught_from(node: Node, axis: str) -> Taught:
    examples = node.member("examples")
    low, high = (examples.member(pole).count() for pole in POLES[axis])
    return Taught(
        examples=(low, examples.member(NEUTRAL).count(), high),
        performers=node.member("performers").count(),
    )


def _reader_from(node: Node, axes: list[str], *, own: bool) -> Reader:
    """Return a reader of some axes, checked."""
    listed, products = node.member("entries").items(), node.member("products").items()
    if not listed:
        raise node.member("entries").fault("at least one", "none")
    spread = node.member("size_spread").positive()
    entries = _entries_from(listed, products, spread, own=own)
    reach = node.member("reach").positive()
    weighed = [*listed, *products]
    readers = {}
    for axis in axes:
        part = node.member("axes").member(axis)
        readers[axis] = AxisReader(
            Linear(
                np.array([one.member(axis).number() for one in weighed]),
                part.member("bias").number(),
            ),
            _members_from(part.member("members")),
            part.member("held_out_accuracy").number(0.0, 1.0),
        )
    states = node.member("states")
    if states.value is None:
        return Reader(entries, readers, reach)
    expected = [" ".join(state_words(state)) for state in STATES]
    if [name.text() for name in states.member("names").items()] != expected:
        raise states.member("names").fault(", ".join(expected))
    weight = np.array([one.member("states").numbers(len(STATES)) for one in weighed]).T
    return Reader(
        entries,
        readers,
        reach,
        StateReader(
            Softmax(weight, np.array(states.member("bias").numbers(len(STATES)))),
            states.member("held_out_accuracy").number(0.0, 1.0),
        ),
    )


def _members_from(node: Node) -> Mapping[str, float]:
    return {name: share.number(0.0, 1.0) for name, share in node.options().items()}


def _entries_from(
    listed: list[Node], products: list[Node], size_spread: float, *, own: bool
) -> Entries:
    """Return the entries of a description that a reader uses, and their products."""
    named = [one.member("name") for one in listed]
    names = [node.text() for node in named]
    for i, (node, name) in enumerate(zip(named, names, strict=True)):
        if name not in DESCRIPTION_NAMES:
            raise node.fault("a feature of this version")
        if name in names[:i]:
            raise node.fault("each feature once", f"{shown(name)} twice")
    ranges = np.array([one.member("range").numbers(2) for one in listed])
    for one, (low, high) in zip(listed, ranges, strict=True):
        if low > high:
            raise one.member("range").fault("low, high", f"{low:g}, {high:g}")
    pairs = [[name.text() for name in product.member("of").items()] for product in products]
    for product, pair in zip(products, pairs, strict=True):
        if len(pair) != 2 or any(name not in names for name in pair):
            raise product.member("of").fault("the names of two entries", repr(pair)[:60])
    columns = np.array([DESCRIPTION_NAMES.index(name) for name in names], dtype=np.int64)
    return Entries(
        columns=columns,
        lowest=ranges[:, 0],
        highest=ranges[:, 1],
        centre=_column(listed, "centre"),
        scale=np.array([one.member("scale").positive() for one in listed]),
        pairs=np.array(
            [[names.index(name) for name in pair] for pair in pairs], dtype=np.int64
        ).reshape(-1, 2),
        unlike=_lower_triangle(
            [one.member("unlike").numbers(i + 1) for i, one in enumerate(listed)]
        ),
        sizes=Sizes(columns, _column(listed, "usual"), _column(listed, "size"), size_spread),
        typical=_column(listed, "typical") if own else None,
    )


def _column(listed: list[Node], key: str) -> FloatArray:
    """Return a number of each entry."""
    return np.array([one.member(key).number() for one in listed])


def _lower_triangle(rows: list[list[float]]) -> FloatArray:
    """Return the square matrix of rows of 1, 2, 3 … numbers."""
    matrix = np.zeros((len(rows), len(rows)))
    for i, row in enumerate(rows):
        matrix[i, : i + 1] = row
    return matrix
