"""Reading a recording: which format, whose frame, what was lost."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np

from laban.faults import Fault, naming
from smd.doodle import Doodle, Dropout, Recording
from smd.errors import RecordingError
from smd.formats import aframe, bsor, motive, native, tum, usd_xform
from smd.formats.checks import LATEST_S, checked
from smd.formats.dropouts import SHORTEST_LOSS_S, find_dropouts
from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import Conversion, SourceFrame
from smd.formats.tracks import Content, Track, shown
from smd.geometry.arrays import BoolArray, IntArray
from smd.geometry.rotations import normalized

FORMATS: tuple[RecordingFormat, ...] = (
    motive.FORMAT,
    native.FORMAT,
    aframe.FORMAT,
    tum.FORMAT,
    bsor.FORMAT,
    usd_xform.FORMAT,
)
"""Asked in this order whether a text is theirs: a Motive export would pass for a plain CSV."""

SUFFIXES = tuple(dict.fromkeys(suffix for each in FORMATS for suffix in each.suffixes))
"""Suffixes of recordings: what a folder is searched for."""

READABLE = tuple(dict.fromkeys([*SUFFIXES, *(s for each in FORMATS for s in each.only_named)]))
"""Suffixes that are read when a file is named."""

_HEAD = 65_536  # characters by which formats know their files


def read_recording(
    path: str | Path, frame: SourceFrame | None = None, *, device: str | None = None
) -> Recording:
    """Read a recording of any format into our convention.

    The content decides which format it is. Rows where tracking was lost (`Dropout`) are left
    out; a loss of more than 0.25 s ends one doodle and begins the next, a shorter one is left
    for smoothing to bridge. A device that was never tracked beside others that were is left out,
    and is one dropout.

    Parameters
    ----------
    path
        A native or plain CSV, a TUM trajectory, A-Frame motion capture (JSON), an OptiTrack Motive
        CSV, a Beat Saber Open Replay, or USD with animated transforms.
    frame
        What the numbers mean, where the format's own answer is not right.
    device
        Read this device alone.

    Returns
    -------
    Recording
        Doodles in the file's order of devices; times on the file's clock, but counted from the
        first pose where that clock means nothing to a reader (TUM, A-Frame).

    Raises
    ------
    RecordingError
        If the file cannot be read or understood; one line that names the place, what was
        expected and what was found.
    """
    with _named(path):
        return _recording(_opened(Path(path)), str(path), frame or SourceFrame(), device)


def format_frame(path: str | Path) -> SourceFrame:
    """Return what a recording file's format says of its numbers, every question answered.

    Raises
    ------
    RecordingError
        As `read_recording`.
    """
    with _named(path):
        return _opened(Path(path)).frame


def _named(path: str | Path) -> AbstractContextManager[None]:
    """Name a recording's file in what is found wrong with it."""
    return naming(path, RecordingError, joint=", ")


def _recording(content: Content, source: str, asked: SourceFrame, device: str | None) -> Recording:
    """Return what a file holds in our convention, of one device or all, without what was lost."""
    if content.order_is_given and asked.quaternion not in (None, content.frame.quaternion):
        raise Fault("", "no quaternion order, as the file names components", str(asked.quaternion))
    conversion = asked.completed(content.frame).conversion()
    chosen = _chosen(content.tracks, device)
    valid = [checked(track, conversion.metres_per_unit) for track in chosen]
    metadata, zero_s = dict(content.metadata), 0.0
    if not content.clock_means_something:
        starts_s = [track.time_s[0].item() for track in content.tracks]
        zero_s = min(start_s for start_s in starts_s if abs(start_s) <= LATEST_S)
        metadata["clock_zero_s"] = repr(zero_s)
    doodles: list[Doodle] = []
    dropouts: list[Dropout] = []
    for track, of_numbers in zip(chosen, valid, strict=True):
        drawn, lost = _doodles(track, of_numbers, conversion, zero_s)
        doodles += drawn
        dropouts += lost
    if not doodles:
        raise _never_tracked(chosen[0], valid[0])
    return Recording(tuple(doodles), source, tuple(dropouts), metadata)


def _opened(path: Path) -> Content:
    """Return what is in a file, in its own numbers."""
    file = RecordingFile(path)
    if file.suffix not in READABLE:
        suffix = repr(path.suffix) if path.suffix else "no suffix"
        raise Fault("", f"a file with suffix {' '.join(READABLE)}", suffix)
    return _format_of(file).read(file)


def _format_of(file: RecordingFile) -> RecordingFormat:
    """Return the format that is the suffix's own, or that knows the text."""
    for each in FORMATS:
        if each.matches is None and file.suffix in (*each.suffixes, *each.only_named):
            return each
    head = file.text[:_HEAD]
    for each in FORMATS:
        if each.matches is not None and each.matches(head):
            return each
    start = next((line for line in file.text.split("\n") if line.strip()), None)
    if start is None:
        raise Fault("", "rows of poses", "an empty file")
    expected = "a CSV or TUM table of poses, or A-Frame JSON"
    raise Fault("", expected, f"text that begins {shown(start)}")


def _never_tracked(track: Track, valid: BoolArray) -> Fault:
    """Return the fault for a device of which nothing is left."""
    device, numbers = f"device {track.device!r}", np.count_nonzero(valid)
    if numbers < 2:
        found = f"{numbers} among {len(valid)} rows"
        return Fault(device, "at least two poses that are numbers", found)
    expected = f"a stretch of at least {SHORTEST_LOSS_S:g} s without loss of tracking"
    return Fault(device, expected, "none")


def _chosen(tracks: tuple[Track, ...], device: str | None) -> tuple[Track, ...]:
    """Return the tracks to read."""
    if device is None:
        return tracks
    chosen = tuple(track for track in tracks if track.device == device)
    if not chosen:
        found = f"only {', '.join(repr(track.device) for track in tracks)}"
        raise Fault("", f"device {device!r}", found)
    return chosen


def _doodles(
    track: Track, valid: BoolArray, conversion: Conversion, zero_s: float
) -> tuple[list[Doodle], tuple[Dropout, ...]]:
    """Return the doodles of one device, none where it was never tracked, and where it was lost."""
    time_s = track.time_s - zero_s
    position_m, orientation_xyzw = conversion.poses(track.position, normalized(track.quaternion))
    tracking = find_dropouts(track.device, time_s, position_m, orientation_xyzw, valid)
    return [
        Doodle(
            time_s=time_s[rows],
            position_m=position_m[rows],
            orientation_xyzw=orientation_xyzw[rows],
            device=track.device,
            drawing=_drawing(track, rows),
        )
        for rows in tracking.stretches
        if len(rows) > 1
    ], tracking.dropouts


def _drawing(track: Track, rows: IntArray) -> BoolArray | None:
    """Return when the user meant to draw in one doodle; None where no row of it says so."""
    if track.drawing is None:
        return None
    drawing = track.drawing[rows]
    silent = np.isnan(drawing)
    if silent.all():
        return None
    if silent.any():
        place = track.place(int(rows[np.argmax(silent)]))
        expected = "0 or 1 in column drawing, as in other rows of the doodle"
        raise Fault(place, expected, "an empty cell")
    return drawing > 0
