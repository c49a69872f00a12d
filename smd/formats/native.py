"""CSV: our own recordings, and plain tables of poses from elsewhere.

Optional ``# key: value`` lines, a header, rows::

    # schema: smd.recording
    # version: 1
    time_s,device,x,y,z,qx,qy,qz,qw,drawing
    0.000,left,0.10,0.95,0.20,0,0,0,1,1

The header names the columns, in any order; ``t``, ``time`` and ``timestamp`` mean ``time_s``;
without ``device`` the file is one doodle; columns with other names are left alone. ``drawing``
is empty in all rows of a doodle of which nothing says when the user meant to draw. Without a
header the columns are time, position and quaternion.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from laban.faults import Fault
from smd.doodle import Doodle, Recording
from smd.errors import RecordingError
from smd.files import replacing
from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import SourceFrame
from smd.formats.table import Encoder, cells, is_row, line_of_row, number, read_table
from smd.formats.tracks import Content, Track, shown
from smd.geometry.arrays import FloatArray, IntArray

SCHEMA = "smd.recording"
VERSION = 1
ONLY_DEVICE = "prop"
"""Name of the device where a file does not name any."""

GROWS = "grows"
"""Metadata of a file that is written row by row: its last row may have been cut off."""

_POSITION = ("x", "y", "z")
_QUATERNION = ("qx", "qy", "qz", "qw")
COLUMNS = ("time_s", "device", *_POSITION, *_QUATERNION, "drawing")
_TIMES = ("time_s", "t", "time", "timestamp")
_TRUTH = {"1": 1.0, "true": 1.0, "1.0": 1.0, "0": 0.0, "false": 0.0, "0.0": 0.0, "": np.nan}


def matches(head: str) -> bool:
    """Return whether a text begins like a CSV: its first row has commas, and is not JSON."""
    row = next((line for line in head.split("\n") if is_row(line)), "")
    return "," in row and not row.lstrip().startswith(("{", "["))


def read(file: RecordingFile) -> Content:
    """Return the tracks of a CSV.

    Raises
    ------
    Fault
        If columns are missing, or a row or cell is not what its column says.
    """
    lines = file.text.split("\n")
    head = next(i for i, line in enumerate(lines) if is_row(line))
    metadata = _metadata(lines[:head])
    if metadata.pop(GROWS, None):
        del lines[-1]  # after the last line end: nothing, or a row that was cut off
        if head == len(lines):
            raise Fault("", "rows of poses", "a header that was cut off")
    header = [cell.lower() for cell in cells(lines[head], ",")]
    headerless = _is_number(header[0])
    columns = _positional(head, header) if headerless else _named(head, header)
    first = head if headerless else head + 1
    devices: dict[str, float] = {}
    values = read_table(lines, first, ",", columns, _encoders(columns, devices))
    where = {column: i for i, column in enumerate(columns)}
    drawing = values[:, where["drawing"]] if "drawing" in where else None
    code = values[:, where["device"]] if "device" in where else np.zeros(len(values))
    position = values[:, [where[column] for column in _POSITION]]
    quaternion = values[:, [where[column] for column in _QUATERNION]]
    tracks = [
        Track(
            device=device,
            time_s=values[rows, where["time_s"]],
            position=position[rows],
            quaternion=quaternion[rows],
            place=partial(_place, lines, first, rows),
            drawing=None if drawing is None else drawing[rows],
        )
        for device, rows in zip(devices or [ONLY_DEVICE], _groups(code), strict=True)
    ]
    return Content(
        tracks=tuple(tracks),
        frame=SourceFrame.ours(),
        order_is_given=not headerless,
        metadata=metadata,
    )


def _groups(code: FloatArray) -> list[IntArray]:
    """Return the rows of each code 0, 1, 2 …, in order."""
    order = np.argsort(code, kind="stable")
    return np.split(order, np.cumsum(np.bincount(code.astype(np.int64)))[:-1])


def _encoders(columns: Sequence[str], devices: dict[str, float]) -> dict[int | str, Encoder]:
    """Return how to read the columns that do not hold numbers; ``devices`` collects names."""
    known: dict[str, Encoder] = {"device": _device_encoder(devices), "drawing": _drawing}
    return {
        i: known.get(column, _anything)
        for i, column in enumerate(columns)
        if column not in ("time_s", *_POSITION, *_QUATERNION)
    }


def _place(lines: Sequence[str], first: int, rows: IntArray, i: int) -> str:
    """Return where row ``i`` of a device stands in the file."""
    return line_of_row(lines, first, int(rows[i]))


def write_recording(recording: Recording, path: str | Path) -> None:
    """Write a recording as native CSV, every number so that it reads back the same.

    Where a doodle was split, its rows leave the gap; metadata keys and values lose line breaks
    and spaces at their ends. What was lost (``recording.dropouts``) is not written. There is a
    column ``drawing`` where a doodle says when the user meant to draw; in the rows of doodles that
    do not, it is empty.

    Raises
    ------
    RecordingError
        If a metadata key or a device's name cannot stand in a CSV.
    ExportError
        If the file cannot be written.
    """
    silent = all(doodle.drawing is None for doodle in recording.doodles)
    header = COLUMNS[:-1] if silent else COLUMNS
    with replacing(Path(path)) as temporary, temporary.open("w", encoding="utf-8", newline="") as f:
        f.write(f"# schema: {SCHEMA}\n# version: {VERSION}\n")
        for key, value in recording.metadata.items():
            f.write(f"# {_writable_key(key)}: {' '.join(value.split())}\n")
        rows = csv.writer(f, lineterminator="\n")
        rows.writerow(header)
        for doodle in recording.doodles:
            device = _writable_device(doodle.device)
            pose = np.column_stack([doodle.position_m, doodle.orientation_xyzw])
            times_s = doodle.time_s.tolist()
            for time_s, numbers, mark in zip(times_s, pose.tolist(), _marks(doodle), strict=True):
                rows.writerow([time_s, device, *numbers, *([] if silent else [mark])])


def _marks(doodle: Doodle) -> list[str]:
    """Return the cells of a doodle's column ``drawing``."""
    if doodle.drawing is None:
        return [""] * len(doodle)
    return ["1" if mark else "0" for mark in doodle.drawing.tolist()]


def _metadata(lines: Sequence[str]) -> dict[str, str]:
    """Return the ``# key: value`` lines; schema and version are checked and left out."""
    metadata: dict[str, str] = {}
    for line in lines:
        key, colon, value = line.strip().removeprefix("#").partition(":")
        if colon and key.strip():
            metadata[key.strip()] = value.strip()
    if metadata.get("schema") == SCHEMA:
        del metadata["schema"]
        version = metadata.pop("version", "none")
        if version != str(VERSION):
            raise Fault("", f"version {VERSION} of {SCHEMA}", f"version {version}")
    return metadata


def _positional(index: int, cells_found: Sequence[str]) -> Sequence[str]:
    """Return the columns of a file without a header, or raise if it has more or fewer.

    The last four are a quaternion in an order that the file does not say.
    """
    columns = ("time_s", *_POSITION, *_QUATERNION)
    if len(cells_found) != len(columns):
        raise Fault(
            f"line {index + 1}",
            f"a header, or {len(columns)} columns (time, position, quaternion)",
            f"{len(cells_found)} columns without a header",
        )
    return columns


def _named(index: int, header: Sequence[str]) -> Sequence[str]:
    """Return the header with one name for time, or raise what it lacks or repeats."""
    columns = ["time_s" if cell in _TIMES else cell for cell in header]
    wanted = ("time_s", *_POSITION, *_QUATERNION)
    missing = [column for column in wanted if column not in columns]
    place = f"line {index + 1}"
    if missing:
        raise Fault(
            place,
            f"a header with {', '.join(wanted)}",
            f"no {', '.join(missing)} in {shown(','.join(header))}",
        )
    for column in (*wanted, "device", "drawing"):
        if columns.count(column) > 1:
            raise Fault(place, f"one column {column}", str(columns.count(column)))
    return columns


def _is_number(cell: str) -> bool:
    """Return whether a cell holds a number."""
    try:
        number(cell)
    except ValueError:
        return False
    return bool(cell)


def _device_encoder(devices: dict[str, float]) -> Encoder:
    """Return an encoder that numbers devices as they appear, and keeps their names."""

    def encode(cell: str) -> float:
        device = cell.strip()
        if not device:
            raise ValueError("a name")
        return devices.setdefault(device, float(len(devices)))

    return encode


def _drawing(cell: str) -> float:
    """Return 1 for true, 0 for false, and NaN for a cell that does not say."""
    try:
        return _TRUTH[cell.strip().lower()]
    except KeyError:
        raise ValueError("0 or 1") from None


def _anything(cell: str) -> float:
    """Accept a cell of a column that is not ours."""
    del cell
    return 0.0


def device_cell(device: str) -> str:
    """Return the cell of a device's name, or raise RecordingError where it cannot be one."""
    name = _writable_device(device)
    return '"' + name.replace('"', '""') + '"' if set(name) & set(',"#') else name


def _writable_key(key: str) -> str:
    """Return a metadata key that reads back."""
    if key != " ".join(key.split()) or not key or ":" in key or key in ("schema", "version"):
        raise RecordingError(
            f"metadata: expected a key on one line, without ':', not schema or version, "
            f"found {key!r}"
        )
    return key


def _writable_device(device: str) -> str:
    """Return a device's name that reads back."""
    if device != " ".join(device.split()) or not device:
        raise RecordingError(f"device: expected a name on one line, found {device!r}")
    return device


FORMAT = RecordingFormat("native CSV", (".csv",), read, matches)
