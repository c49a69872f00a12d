"""Values of USD attributes: whatever a file may hold, arrays of a known shape or a refusal."""

from __future__ import annotations

from typing import Any

import numpy as np
from pxr import Usd

from laban.faults import Fault
from smd.geometry.arrays import FloatArray, IntArray


def numbers(attribute: Any, *shape: int, time: float | None = None) -> FloatArray | None:
    """Return an attribute's values ``(n, *shape)``; None where it has none.

    Quaternions are xyzw, as they lie in memory.

    Raises
    ------
    Fault
        If they are no numbers, or of another shape.
    """
    value = attribute.Get(Usd.TimeCode.Default() if time is None else time)
    if value is None:
        return None
    where = str(attribute.GetPath())
    expected = f"rows of {' times '.join(map(str, shape))} numbers" if shape else "numbers"
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise Fault(where, expected, type(value).__name__) from None
    if not array.size:
        return np.empty((0, *shape))
    if array.ndim != 1 + len(shape) or array.shape[1:] != shape:
        raise Fault(where, expected, f"an array of shape {array.shape}")
    return array


def whole_numbers(attribute: Any) -> IntArray:
    """Return an attribute's whole numbers; none where it has none."""
    found = numbers(attribute)
    return np.empty(0, np.int64) if found is None else found.astype(np.int64)


def extremes(values: IntArray) -> str:
    """Return the least and the greatest of some numbers, as text."""
    return f"{int(values.min())} to {int(values.max())}"


def texts(attribute: Any) -> list[str]:
    """Return an attribute's texts; none where it has none.

    Raises
    ------
    Fault
        If it holds something else.
    """
    value = attribute.Get()
    try:
        return [str(text) for text in (() if value is None else value)]
    except TypeError:
        raise Fault(str(attribute.GetPath()), "texts", type(value).__name__) from None
