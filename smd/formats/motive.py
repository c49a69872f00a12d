"""OptiTrack Motive: rigid bodies exported as CSV [1]_.

The first line says how the numbers are to be read; above the columns stand, line by line, what each
one belongs to: its type, name, ID and, last, Rotation or Position::

    Format Version,1.23,Take Name,walk,…,Rotation Type,Quaternion,Length Units,Meters,…

    ,Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body
    ,Name,doll,doll,doll,doll,doll,doll,doll
    ,ID,1,1,1,1,1,1,1
    ,,Rotation,Rotation,Rotation,Rotation,Position,Position,Position
    Frame,Time (Seconds),X,Y,Z,W,X,Y,Z
    0,0.000000,0.0,0.0,0.0,1.0,0.1,0.9,0.2

Cells are empty where a body was not seen. Markers, bones and quality are left alone. The world is
right-handed, Y up; a body's axes are along the world's when it is made, so that it faces +Z unless
the user says otherwise.

References
----------
.. [1] https://docs.optitrack.com/motive/data-export/data-export-csv
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from laban.faults import Fault
from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import Mount, SourceFrame
from smd.formats.table import Encoder, cells, line_of_row, read_table
from smd.formats.tracks import Content, Track, shown

_UNITS = {"meters": "m", "centimeters": "cm", "millimeters": "mm", "inches": "in", "feet": "ft"}

_PARTS = {
    ("rotation", "x"): "qx",
    ("rotation", "y"): "qy",
    ("rotation", "z"): "qz",
    ("rotation", "w"): "qw",
    ("position", "x"): "x",
    ("position", "y"): "y",
    ("position", "z"): "z",
}

_FEWEST_HEADER_LINES = 4  # type, name, ID, and what


def matches(head: str) -> bool:
    """Return whether a text begins like a Motive export."""
    return head.startswith("Format Version,")


def read(file: RecordingFile) -> Content:
    """Return a track for every rigid body.

    Raises
    ------
    Fault
        If rotations are no quaternions, the unit is unknown, the columns are not as described, or
        there is no rigid body.
    """
    lines = file.text.split("\n")
    said = cells(lines[0], ",")
    settings = dict(zip(said[0::2], said[1::2], strict=False))
    frame = _frame(settings)
    columns = next((i for i, line in enumerate(lines) if line.startswith("Frame,")), None)
    if columns is None:
        raise Fault("", "a line that begins Frame,Time (Seconds)", "none")
    above = [cells(line, ",") for line in lines[1:columns] if line.strip(", ")]
    bodies = _bodies(above, cells(lines[columns], ","))
    width = len(cells(lines[columns], ","))
    known = {1, *(column for parts in bodies.values() for column in parts.values())}
    encoders: dict[int | str, Encoder] = {i: _nothing for i in range(width) if i not in known}
    titles = [f"{i + 1}" for i in range(width)]
    values = read_table(lines, columns + 1, ",", titles, encoders)
    tracks = tuple(
        Track(
            device=body,
            time_s=values[:, 1],
            position=values[:, [parts[part] for part in ("x", "y", "z")]],
            quaternion=values[:, [parts[part] for part in ("qx", "qy", "qz", "qw")]],
            place=partial(line_of_row, lines, columns + 1),
        )
        for body, parts in bodies.items()
    )
    take = settings.get("Take Name")
    return Content(tracks, frame, order_is_given=True, metadata={"take": take} if take else {})


def _frame(settings: dict[str, str]) -> SourceFrame:
    """Return what the first line says of the numbers."""
    rotation = settings.get("Rotation Type", "Quaternion")
    if rotation != "Quaternion":
        expected = "rotations as Quaternion (export again with that type)"
        raise Fault("line 1", expected, shown(rotation))
    unit = settings.get("Length Units", "Meters")
    if unit.lower() not in _UNITS:
        raise Fault("line 1", f"length units of {', '.join(_UNITS)}", shown(unit))
    return SourceFrame("y", "z", "right", _UNITS[unit.lower()], "xyzw", Mount())


def _bodies(above: Sequence[Sequence[str]], axes: Sequence[str]) -> dict[str, dict[str, int]]:
    """Return the columns of each rigid body: where its x, y, z, qx, qy, qz and qw are."""
    widths = {len(row) for row in above} | {len(axes)}
    if len(above) < _FEWEST_HEADER_LINES or len(widths) > 1:
        expected = "lines of type, name, ID and Rotation or Position above the columns"
        raise Fault("", expected, f"{len(above)} lines of {sorted(widths)} cells")
    kinds, names, whats = above[0], above[1], above[-1]
    bodies: dict[str, dict[str, int]] = {}
    for i in range(2, len(axes)):
        part = _PARTS.get((whats[i].lower(), axes[i].lower()))
        if kinds[i].lower() == "rigid body" and part:
            bodies.setdefault(names[i], {})[part] = i
    for body, parts in bodies.items():
        if len(parts) < len(_PARTS):
            lacking = ", ".join(sorted(set(_PARTS.values()) - set(parts)))
            raise Fault(f"rigid body {body!r}", "rotation and position", f"no {lacking}")
    if not bodies:
        raise Fault("", "rigid bodies", f"only {', '.join(sorted(set(kinds[2:]))) or 'none'}")
    return bodies


def _nothing(cell: str) -> float:
    """Pass over a cell that is not ours."""
    del cell
    return 0.0


FORMAT = RecordingFormat("OptiTrack Motive", (".csv",), read, matches)
