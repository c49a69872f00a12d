"""The options of the commands that take poses from tracked devices, and what they show."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from contextlib import AbstractContextManager

    from smd.capture.source import Device
    from smd.capture.source import Source as OpenSource
    from smd.capture.take import Progress
    from smd.formats import SourceFrame

Source = Annotated[
    str,
    typer.Option(
        help="Where poses come from: openvr, or replay:FILE, replay:FOLDER or replay:- (standard "
        "input) for what was recorded."
    ),
]
Devices = Annotated[
    list[str] | None,
    typer.Option(
        "--device",
        help="Record this device: a serial, left, right or tracker; may be repeated. Default: all "
        "controllers and trackers.",
    ),
]
Rate = Annotated[float, typer.Option("--rate", help="Frames a second, 10 to 1000.")]
TakesFolder = Annotated[
    Path, typer.Option("-o", "--output", help="Folder of the takes; made where missing.")
]

RATE_HZ = 90.0
"""Of most headsets."""

SOURCE = "openvr"

SHOW_S = 0.25
"""From one state of the live line to the next."""


@dataclass(frozen=True, slots=True)
class CapturingOptions:
    """Which devices the user records, how often, and where their poses come from."""

    devices: Devices = None
    rate_hz: Rate = RATE_HZ
    source: Source = SOURCE

    def require_rate(self) -> None:
        """Raise CaptureError if nothing is recorded at such a rate."""
        from smd.capture.take import require_rate

        require_rate(self.rate_hz)

    def opened(self, frame: SourceFrame | None = None) -> AbstractContextManager[OpenSource]:
        """Open the source, and let go of it afterwards; ``frame``: how a replay is to be read."""
        from smd.capture.opening import open_source

        return open_source(self.source, self.rate_hz, frame)

    def names_of(self, there: Sequence[Device]) -> dict[str, str]:
        """Return the names of the devices to record, by serial; CaptureError if one is missing."""
        from smd.capture.selection import chosen_devices

        return {each.serial: each.name for each in chosen_devices(there, self.devices or ())}


def held_takes(
    opened: OpenSource, names: Mapping[str, str], place: Callable[[], Path]
) -> Iterator[Path | None]:
    """Record what is done while a trigger is held; yield each take's file, and None for each grip.

    After each take a tick in the hand says that it was recorded.
    """
    from smd.capture.hand import grips, stretches
    from smd.capture.recorder import Recorder
    from smd.capture.take import record

    for held, frames in stretches(opened.poses()):
        if held:
            path = place()
            with Recorder(path, names) as recorder:
                for _ in record(frames, recorder, names, hold_to_draw=True):
                    pass
            for serial in names:
                opened.tick(serial)
            yield path
        else:
            for _ in grips(frames):
                yield None


class LiveLine:
    """How a take goes, in one line of a terminal that is written over; nothing in a pipe."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self._names = names
        self._shown_s = -SHOW_S
        self._terminal = sys.stderr.isatty()

    def show(self, progress: Progress) -> None:
        """Show a take's progress, if it is time to."""
        if not self._terminal or time.monotonic() - self._shown_s < SHOW_S:
            return
        self._shown_s = time.monotonic()
        devices = "  ".join(
            f"{name} lost" if serial in progress.lost else name
            for serial, name in self._names.items()
        )
        line = (
            f"{progress.time_s:7.1f} s  {progress.rate_hz:5.1f} Hz  {devices}  "
            f"dropouts {progress.losses}"
        )
        print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Take the line away."""
        if self._terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
