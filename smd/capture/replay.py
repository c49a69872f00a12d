"""A recording played back as a source, frame by frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from smd.capture.source import Device, Frame, Pose, Sample
from smd.doodle import HEADSETS, Doodle, Recording
from smd.formats import SourceFrame, read_recording

BETWEEN_S = 1.0
"""From the last frame of one recording to the first of the next."""


class ReplaySource:
    """Recordings, one after another, as fast as they are consumed.

    The trigger is pressed while the user drew, if a recording says so, and otherwise all along;
    after each recording it is released. Rows that were lost are left out.

    Parameters
    ----------
    files
        At least one.
    frame
        How they are to be read.

    Raises
    ------
    RecordingError
        If one cannot be read.
    """

    def __init__(self, files: Sequence[Path], frame: SourceFrame | None = None) -> None:
        self._recordings = [read_recording(file, frame) for file in files]

    def devices(self) -> tuple[Device, ...]:
        """Return the recordings' devices; their names are their serials."""
        names = dict.fromkeys(name for each in self._recordings for name in each.devices)
        return tuple(_device(name) for name in names)

    def poses(self) -> Iterator[Frame]:
        """Yield what was recorded, in time order; the first frame is at 0."""
        start_s = 0.0
        for recording in self._recordings:
            for frame in _frames(recording, start_s):
                yield frame
                last_s = frame.time_s
            let_go = tuple(Sample(name, None, trigger=False) for name in recording.devices)
            yield Frame(last_s + 0.5 * BETWEEN_S, let_go)
            start_s = last_s + BETWEEN_S

    def tick(self, serial: str) -> None:
        """Do nothing: nobody holds the device."""

    def close(self) -> None:
        """Do nothing: there is nothing to close."""


def _device(name: str) -> Device:
    """Return the device of a recording, as far as its name identifies it."""
    if name.lower() in HEADSETS:
        return Device(name, "headset")
    role = name if name in ("left", "right") else ""
    return Device(name, "controller", role)


def _frames(recording: Recording, start_s: float) -> Iterator[Frame]:
    """Yield the frames of one recording, the first one at ``start_s``."""
    first_s = min(float(doodle.time_s[0]) for doodle in recording.doodles)
    rows = (row for doodle in recording.doodles for row in _samples(doodle))
    timed = sorted(rows, key=itemgetter(0))
    for time_s, together in groupby(timed, key=itemgetter(0)):
        yield Frame(time_s - first_s + start_s, tuple(sample for _, sample in together))


def _samples(doodle: Doodle) -> Iterator[tuple[float, Sample]]:
    """Yield time and sample of each row of a doodle."""
    pressed = [True] * len(doodle) if doodle.drawing is None else doodle.drawing.tolist()
    for time_s, position, orientation, trigger in zip(
        doodle.time_s.tolist(),
        doodle.position_m.tolist(),
        doodle.orientation_xyzw.tolist(),
        pressed,
        strict=True,
    ):
        pose: Pose = (*position, *orientation)
        yield time_s, Sample(doodle.device, pose, trigger)
