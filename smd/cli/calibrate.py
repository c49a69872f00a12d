"""``smd calibrate``: where a prop's centre is, seen from its tracker."""

from __future__ import annotations

import math

import typer

from smd.cli import one_doodle, places
from smd.cli.option_groups import unfolded
from smd.cli.reading import ReadingOptions


@unfolded
def calibrate(
    recordings: places.Recordings,
    *,
    device: one_doodle.OneDevice = None,
    reading: ReadingOptions,
) -> None:
    """Find the lever arm from tracker to prop.

    Record the prop while it is turned about its centre in one place, nodding, turning and
    rolling, for fifteen seconds. What is printed last goes to the other commands.
    """
    from smd.errors import DoodleError, RecordingError
    from smd.formats.frame import Mount
    from smd.recognition.lever import estimate_lever
    from smd.smoothing import smooth

    files = list(places.recording_files(recordings))
    motions = []
    for file in files:
        try:
            motions += [smooth(d) for d in one_doodle.doodles_of_one(reading.read(file), device)]
        except DoodleError as error:
            raise RecordingError(f"{file}: {error}") from error
    try:
        arm = estimate_lever(motions)
    except DoodleError as error:
        raise RecordingError(f"{', '.join(map(str, files))}: {error}") from error
    known = Mount() if reading.mount is None else Mount.parse(reading.mount)
    numbers = ", ".join(
        f"{axis} {1000 * length:.1f} ± {2000 * error:.1f}"
        for axis, length, error in zip("xyz", arm.lever_m, arm.error_m, strict=True)
    )
    typer.echo(f"turned {math.degrees(arm.turn_rad):.0f} degrees in all")
    typer.echo(f"from tracker to centre, mm (± two standard errors): {numbers}")
    typer.echo(
        f"strayed from its place (root mean square): tracker {1000 * arm.tracker_wander_m:.1f} mm, "
        f"centre {1000 * arm.centre_wander_m:.1f} mm"
    )
    typer.echo(f"--mount {known.stepped(arm.lever_m)}")
