"""Read-only, checked copies of arrays: what the frozen types are made of."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


def frozen_array(
    name: str,
    value: Any,
    shape: tuple[int | None, ...],
    error: type[Exception],
    dtype: DTypeLike = np.float64,
) -> NDArray[Any]:
    """Return a read-only copy of ``value`` of the given shape (None: any length) and dtype.

    Raises
    ------
    error
        If the shape differs or a number is not finite; the message names ``name``.
    """
    array = np.array(value, dtype=dtype)
    fits = array.ndim == len(shape) and all(
        want is None or have == want for have, want in zip(array.shape, shape, strict=True)
    )
    if not fits:
        wanted = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
        raise error(f"{name}: expected shape {wanted}, got {array.shape}")
    if array.dtype.kind == "f":
        finite = np.isfinite(array)
        if not finite.all():
            where = tuple(int(i) for i in np.argwhere(~finite)[0])
            raise error(f"{name}: expected finite numbers, got {array[where]} at index {where}")
    array.flags.writeable = False
    return array
