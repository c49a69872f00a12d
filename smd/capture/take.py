"""One take: frames from a source, recorded as they arrive, with the times of drawing."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass, field

from smd.capture.recorder import Recorder
from smd.capture.source import Frame, Row
from smd.errors import CaptureError

SLOWEST_HZ, FASTEST_HZ = 10.0, 1000.0
"""Below, gestures are undersampled; above, no tracker has new data."""


def require_rate(rate_hz: float) -> float:
    """Return a rate of recording, or raise CaptureError if it is out of range."""
    if not SLOWEST_HZ <= rate_hz <= FASTEST_HZ:
        raise CaptureError(
            f"rate: expected {SLOWEST_HZ:g} to {FASTEST_HZ:g} frames a second, got {rate_hz:g}: "
            "90 suits most headsets"
        )
    return rate_hz


def require_seconds(seconds: float | None) -> float:
    """Return the length of a take, infinite where none is given, or raise CaptureError."""
    if seconds is None:
        return math.inf
    if not seconds > 0.0:
        raise CaptureError(f"seconds: expected a positive number, got {seconds:g}")
    return seconds


@dataclass(slots=True)
class Progress:
    """The progress of a take.

    Attributes
    ----------
    time_s : of the last frame, counted from the first.
    frames : that were recorded.
    lost : devices that are not tracked now, by serial, and since when.
    losses : how often tracking was lost.
    """

    time_s: float = 0.0
    frames: int = 0
    lost: dict[str, float] = field(default_factory=dict)
    losses: int = 0

    @property
    def rate_hz(self) -> float:
        """Frames a second over all of the take."""
        return (self.frames - 1) / self.time_s if self.time_s > 0.0 else 0.0


def record(
    frames: Iterable[Frame],
    recorder: Recorder,
    serials: Container[str],
    *,
    hold_to_draw: bool = False,
    seconds: float = math.inf,
) -> Iterator[Progress]:
    """Record frames, and yield the progress after each.

    A device without a pose gets a row that says that it was lost; one that is absent from a frame
    gets none.

    Parameters
    ----------
    frames
        From a source.
    recorder
        The file that they are written to.
    serials
        Serials of the devices to record.
    hold_to_draw
        Whether a device draws only while its trigger is held (one without a trigger: while any
        trigger is). Otherwise the recording does not hold the intent.
    seconds
        Length of the take.
    """
    start_s: float | None = None
    progress = Progress()
    for frame in frames:
        start_s = frame.time_s if start_s is None else start_s
        if frame.time_s - start_s > seconds + 1e-9:
            return
        rows = rows_of(frame, serials, hold_to_draw=hold_to_draw)
        recorder.write(frame.time_s, rows)
        progress.time_s = frame.time_s - start_s
        progress.frames += 1
        for serial, (pose, _) in rows.items():
            if pose is not None:
                progress.lost.pop(serial, None)
            elif serial not in progress.lost:
                progress.lost[serial] = progress.time_s
                progress.losses += 1
        yield progress


def rows_of(frame: Frame, serials: Container[str], *, hold_to_draw: bool) -> dict[str, Row]:
    """Return the rows of some devices in a frame: the pose of each, and whether it draws."""
    any_held = any(sample.trigger for sample in frame.samples)
    rows: dict[str, Row] = {}
    for serial, pose, trigger, _ in frame.samples:
        if serial in serials:
            held = any_held if trigger is None else trigger
            rows[serial] = (pose, held if hold_to_draw else None)
    return rows
