"""The options of the commands that take poses from tracked devices, and what they show."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Mapping

    from smd.capture.take import Progress

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
Rate = Annotated[float, typer.Option(help="Frames a second, 10 to 1000.")]

SHOW_S = 0.25
"""From one state of the live line to the next."""


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
