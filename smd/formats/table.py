"""Rows of numbers in a text: read at once by NumPy, or line by line to name what is wrong."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from itertools import islice

import numpy as np

from laban.faults import Fault
from smd.formats.tracks import shown
from smd.geometry.arrays import FloatArray

Encoder = Callable[[str], float]
"""Turns a cell that is no number into one; raises ValueError saying what was expected."""

Encoders = Mapping[int | str, Encoder]
"""By the index of their column."""


def is_row(line: str) -> bool:
    """Return whether a line holds data: it is neither blank nor a comment."""
    stripped = line.strip()
    return bool(stripped) and not stripped.startswith("#")


def cells(line: str, delimiter: str | None) -> list[str]:
    """Return the cells of a line; no delimiter means white space."""
    if delimiter is None:
        return line.split()
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]
    except csv.Error:  # a cell longer than the csv module takes
        return line.split(delimiter)


def number(text: str) -> float:
    """Return the number that a cell holds, NaN where it is empty.

    Raises
    ------
    ValueError
        If it holds anything else (Python's ``1_000`` included).
    """
    if not text:
        return float("nan")
    if "_" in text:
        raise ValueError(text)
    return float(text)


def read_table(
    lines: Sequence[str],
    first: int,
    delimiter: str | None,
    columns: Sequence[str],
    encoders: Encoders,
) -> FloatArray:
    """Return the rows of ``lines[first:]`` as numbers, one column for each of ``columns``.

    Parameters
    ----------
    lines
        All lines of the file; blank ones and comments do not count as rows.
    first
        Where the rows begin.
    delimiter
        Between cells; None for white space.
    columns
        Names, for messages.
    encoders
        For the columns that do not hold numbers.

    Raises
    ------
    Fault
        If there are no rows, a row has too few or too many cells, or a cell is not a number.
    """
    if not any(is_row(line) for line in islice(lines, first, None)):
        found = "none" if any(is_row(line) for line in lines) else "an empty file"
        raise Fault("", "rows of poses", found)
    try:
        values = np.loadtxt(
            islice(lines, first, None),
            delimiter=delimiter,
            comments=None,
            converters=dict(encoders),
            quotechar='"' if delimiter else None,
            ndmin=2,
            encoding="utf-8",  # NumPy 1 hands its converters bytes otherwise
        )
        if values.shape[1] == len(columns):
            return values
    except ValueError:
        pass  # also what a converter raises
    return _read_line_by_line(lines, first, delimiter, columns, encoders)


def _read_line_by_line(
    lines: Sequence[str],
    first: int,
    delimiter: str | None,
    columns: Sequence[str],
    encoders: Encoders,
) -> FloatArray:
    """Do the same slowly: empty cells are NaN, and the first fault is named."""
    rows = []
    for index, line in enumerate(islice(lines, first, None), first):
        if not is_row(line):
            continue
        row = cells(line, delimiter)
        if len(row) != len(columns):
            raise Fault(
                f"line {index + 1}",
                f"{len(columns)} columns ({', '.join(columns)})",
                str(len(row)),
            )
        rows.append(
            [_value(index, columns[i], cell, encoders.get(i)) for i, cell in enumerate(row)]
        )
    return np.array(rows, dtype=np.float64)


def _value(index: int, column: str, cell: str, encoder: Encoder | None) -> float:
    """Return one cell's value, or raise the error that names it."""
    place = f"line {index + 1}"
    if encoder is None:
        try:
            return number(cell)
        except ValueError:
            raise Fault(place, f"a number in column {column}", shown(cell)) from None
    try:
        return encoder(cell)
    except ValueError as error:
        raise Fault(place, f"{error} in column {column}", shown(cell)) from None


def line_of_row(lines: Sequence[str], first: int, row: int) -> str:
    """Return where row ``row`` stands, as "line 12"; only messages need it."""
    rows = (i for i, line in enumerate(lines) if i >= first and is_row(line))
    return f"line {next(islice(rows, row, None)) + 1}"
