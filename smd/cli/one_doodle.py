"""The one doodle of a recording, where a command wants one performance of one device."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from smd.doodle import Doodle, Recording

OneDevice = Annotated[
    str | None,
    typer.Option("--device", help="The device to read. Default: the only one but headsets."),
]


def doodles_of_one(recording: Recording, device: str | None) -> tuple[Doodle, ...]:
    """Return the doodles of a device, by default of the only one that is no headset.

    Raises
    ------
    RecordingError
        If there is no such device, or several to choose from.
    """
    from smd.doodle import HEADSETS
    from smd.errors import RecordingError

    known = recording.devices
    played = [name for name in known if name.lower() not in HEADSETS] or list(known)
    if device is None and len(played) > 1:
        raise RecordingError(
            f"{recording.source}: expected one device, or --device with one of "
            f"{', '.join(played)}; found {len(played)}"
        )
    if device is not None and device not in known:
        raise RecordingError(
            f"{recording.source}: expected a device of {', '.join(known)}, got {device!r}"
        )
    return recording.of(device or played[0])


def one_example(file: Path, options: ReadingOptions, device: str | None) -> Doodle:
    """Return the one doodle of a recording; an example holds the gesture once."""
    from smd.errors import RecordingError

    doodles = doodles_of_one(options.read(file), device)
    if len(doodles) > 1:
        raise RecordingError(
            f"{file}: expected one performance of the gesture, found {len(doodles)} doodles: "
            f"tracking was lost from {doodles[0].time_s[-1]:.2f} to {doodles[1].time_s[0]:.2f} s"
        )
    return doodles[0]


def drawn_doodle(path: Path, options: ReadingOptions) -> Doodle:
    """Return the one doodle of a performance: that of the device whose trigger was held."""
    from smd.errors import RecordingError

    doodles = options.read(path).doodles
    drawn = [one for one in doodles if one.drawing is not None and one.drawing.any()]
    if len(drawn) != 1:
        devices = ", ".join(dict.fromkeys(doodle.device for doodle in drawn)) or "none"
        raise RecordingError(
            f"{path}: expected one doodle of one device, found {len(drawn)} of {devices}: "
            "name one with --device, and keep it in sight"
        )
    return drawn[0]
