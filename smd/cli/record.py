"""``smd record``: from tracked devices to a recording."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.capturing import RATE_HZ, SOURCE, CapturingOptions, Devices, LiveLine, Rate, Source

if TYPE_CHECKING:
    from collections.abc import Iterable

    from smd.capture.take import Progress


def record(
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="TAKE", help="The recording: TAKE.csv.")
    ],
    devices: Devices = None,
    rate_hz: Rate = RATE_HZ,
    seconds: Annotated[
        float | None, typer.Option(help="Length of the take. Default: until Ctrl-C.")
    ] = None,
    hold_to_draw: Annotated[
        bool,
        typer.Option("--hold-to-draw", help="Only what is done while the trigger is held counts."),
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Write over a recording that is there.")
    ] = False,
    source: Source = SOURCE,  # last in the help, and so apart from what it belongs to
) -> None:
    """Record tracked devices until Ctrl-C.

    Every sample is in the file as soon as it is there; nothing is lost if the program or the
    computer dies.
    """
    from smd.capture.recorder import Recorder
    from smd.capture.take import Progress, record, require_seconds

    capturing = CapturingOptions(devices, rate_hz, source)
    capturing.require_rate()
    length_s = require_seconds(seconds)
    progress = Progress()
    with capturing.opened() as opened:
        names = capturing.names_of(opened.devices())
        live = LiveLine(names)
        with Recorder(output, names, force=force) as recorder:
            try:
                for serial in names:
                    opened.tick(serial)
                for progress in record(
                    opened.poses(), recorder, names, hold_to_draw=hold_to_draw, seconds=length_s
                ):
                    live.show(progress)
            except KeyboardInterrupt:
                pass  # the way to end a take
            finally:
                live.clear()
                typer.echo(_summary(output, names.values(), progress))
        for serial in names:
            opened.tick(serial)


def _summary(output: Path, names: Iterable[str], progress: Progress) -> str:
    """Return in one line what is in the file now."""
    from smd.cli.wording import count

    return (
        f"{output}: {progress.time_s:.1f} s of {', '.join(names)}, "
        f"{count(progress.frames, 'frame')} at {progress.rate_hz:.1f} Hz, "
        f"tracking lost {count(progress.losses, 'time')}"
    )
