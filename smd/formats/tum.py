"""TUM trajectories: ``timestamp tx ty tz qx qy qz qw`` on each line, ``#`` for comments [1]_.

The format says neither which axis is up nor where the device faces, so both are taken as ours
unless the user says otherwise. Timestamps are often seconds since 1970.

References
----------
.. [1] J. Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS 2012.
"""

from __future__ import annotations

from functools import partial

from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import SourceFrame
from smd.formats.native import ONLY_DEVICE
from smd.formats.table import cells, is_row, line_of_row, number, read_table
from smd.formats.tracks import Content, Track

COLUMNS = ("timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw")


def matches(head: str) -> bool:
    """Return whether a text's first row is numbers between white space."""
    row = cells(next((line for line in head.split("\n") if is_row(line)), ""), None)
    try:
        return len(row) > 1 and all(number(cell) is not None for cell in row)
    except ValueError:
        return False


def read(file: RecordingFile) -> Content:
    """Return the one track of a TUM trajectory.

    Raises
    ------
    Fault
        If a row does not hold eight numbers.
    """
    lines = file.text.split("\n")
    values = read_table(lines, 0, None, COLUMNS, {})
    track = Track(
        device=ONLY_DEVICE,
        time_s=values[:, 0],
        position=values[:, 1:4],
        quaternion=values[:, 4:8],
        place=partial(line_of_row, lines, 0),
    )
    return Content((track,), SourceFrame.ours(), clock_means_something=False)


FORMAT = RecordingFormat("TUM", (".tum",), read, matches, only_named=(".txt",))
