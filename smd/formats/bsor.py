"""Beat Saber Open Replay: head and both sabers of a player, frame by frame [1]_.

Binary, little-endian: a magic number, a version, a structure of what was played, and an array of
frames, each the song's time and three poses. What follows (notes, walls, pauses) is left alone.
Unity's axes: left-handed, Y up, metres; a saber points along +Z. The song's time stands still
before it begins; of frames at one time the first is taken.

References
----------
.. [1] https://github.com/BeatLeader/BS-Open-Replay
"""

from __future__ import annotations

import struct
from functools import partial

import numpy as np

from laban.faults import Fault
from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import Mount, SourceFrame
from smd.formats.tracks import Content, Track

FRAME = SourceFrame("y", "z", "left", "m", "xyzw", Mount())

MAGIC, VERSION = 0x442D3D69, 1
DEVICES = ("head", "left", "right")

_POSE = [("position", "<f4", 3), ("quaternion", "<f4", 4)]
_FRAME = np.dtype([("time", "<f4"), ("fps", "<i4"), ("poses", _POSE, len(DEVICES))])

_KEPT = {8: "controller", 7: "hmd", 10: "song"}
"""Which of the first thirteen texts are kept as metadata."""


def read(file: RecordingFile) -> Content:
    """Return the tracks of head, left and right.

    Raises
    ------
    Fault
        If the file is none of this kind and version, or ends too early.
    """
    cursor = _Cursor(file.read_bytes())
    magic, version = cursor.numbers("<iB")
    if magic != MAGIC:
        raise Fault("", f"the magic number {MAGIC:#x}", f"{magic & 0xFFFFFFFF:#x}")
    if version != VERSION:
        raise Fault("", f"version {VERSION} of Beat Saber Open Replay", f"version {version}")
    cursor.section(0)
    texts = [cursor.text() for _ in range(13)]
    cursor.numbers("<i")  # score
    for _ in range(3):  # mode, environment, modifiers
        cursor.text()
    cursor.numbers("<f?ffff")  # jump distance, left-handed, height, start, fail, speed
    cursor.section(1)
    (count,) = cursor.numbers("<i")
    frames = np.frombuffer(cursor.take(_FRAME.itemsize * max(count, 0)), _FRAME)
    time_s = frames["time"].astype(np.float64)
    latest_s = np.maximum.accumulate(np.concatenate([[-np.inf], time_s]))
    rows = np.flatnonzero(~(time_s <= latest_s[:-1]))
    tracks = tuple(
        Track(
            device=device,
            time_s=time_s[rows],
            position=frames["poses"]["position"][rows, i].astype(np.float64),
            quaternion=frames["poses"]["quaternion"][rows, i].astype(np.float64),
            place=partial(_place, rows.tolist()),
        )
        for i, device in enumerate(DEVICES)
    )
    metadata = {key: texts[i] for i, key in _KEPT.items() if texts[i]}
    return Content(tracks, FRAME, order_is_given=True, metadata=metadata)


def _place(rows: list[int], i: int) -> str:
    """Return where row ``i`` stands in the file."""
    return f"frame {rows[i]}"


class _Cursor:
    """Reads one thing after another; every lack is an error that names its place."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def take(self, count: int) -> bytes:
        """Return the next bytes."""
        if count < 0 or self._at + count > len(self._data):
            left = len(self._data) - self._at
            raise Fault(f"byte {self._at}", f"{count} bytes more", f"{left}")
        self._at += count
        return self._data[self._at - count : self._at]

    def numbers(self, layout: str) -> tuple[int, ...]:
        """Return the next numbers, laid out as `struct` says."""
        return struct.unpack(layout, self.take(struct.calcsize(layout)))

    def text(self) -> str:
        """Return the next text: its length in bytes, then UTF-8."""
        (length,) = self.numbers("<i")
        return self.take(length).decode("utf-8", errors="replace")

    def section(self, number: int) -> None:
        """Pass the byte that begins a section."""
        (found,) = self.numbers("<B")
        if found != number:
            place = f"byte {self._at - 1}"
            raise Fault(place, f"the start of section {number}", f"{found}")


FORMAT = RecordingFormat("Beat Saber Open Replay", (".bsor",), read)
