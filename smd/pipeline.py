"""The one place where the stages meet: from a recording to a Score to a performance."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M

if TYPE_CHECKING:
    from smd.acting.performance import Performance
    from smd.acting.terrain import Terrain
    from smd.cast import ActionLibrary, Cast
    from smd.doodle import Recording
    from smd.score import Score
    from smd.transfer.limits import Limits


def parse(
    recording: Recording,
    library: ActionLibrary | Cast,
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
    devices: Collection[str] | None = None,
    tolerance: float = 1.0,
    intent: str | None = None,
    unexplained: str = "leave",
) -> Score:
    """Recognise the actions in a recording and read the Effort of each.

    This is short for a `Parser` and its `parse`; whoever parses many recordings makes one.

    Parameters
    ----------
    recording
        What was drawn.
    library
        The actions to recognise; their clips are not read. In a `Cast`, each device's own, and
        those of the shared one that its own lacks.
    figure_height_m, devices, tolerance, intent, unexplained
        Those of `smd.parsing.Parser`.

    Returns
    -------
    Score
        A part for each device, in the recording's order; a part may be empty. What no phrase
        explains, and is like an action, is among its suggestions.

    Raises
    ------
    ScoreError
        If the figure height or ``tolerance`` is not positive, ``intent`` or ``unexplained`` is
        neither, or a device is not in the recording.
    LibraryError
        If a cast has a library for a device that is not in the recording.
    """
    from smd.parsing import Parser

    parser = Parser(
        library,
        figure_height_m=figure_height_m,
        devices=devices,
        tolerance=tolerance,
        intent=intent,
        unexplained=unexplained,
    )
    return parser.parse(recording)


def animate(
    score: Score,
    recording: Recording,
    library: ActionLibrary | Cast,
    *,
    rate_hz: float = 24.0,
    expressiveness: float = 1.0,
    heading: str = "prop",
    timing: str = "feasible",
    stretch: float | str = 1.0,
    limits: Limits | None = None,
    hold: bool = False,
    ground: Terrain | Path | str | None = None,
) -> Performance:
    """Act out a Score: each device a character, each phrase an action on the doodle's path.

    Parameters
    ----------
    score
        Who does what, when and how. What a character has no clip for it idles through, and a
        warning names it.
    recording
        The doodles that the Score was read from.
    library
        The character and its clips; in a `Cast`, each device's own.
    rate_hz
        Frames per second. At 24, what Blender's importer leaves its scene at, a file plays at its
        true speed there.
    expressiveness
        How much of the Score's Effort is played, from 0 (neutral clips) to 2.
    heading
        What characters face by: "prop", where the prop faces, or "path", where it goes.
    timing
        When phrases are played: "drawn", as in the Score, or "feasible", as a body can.
    stretch
        How many times as long as the recording the performance lasts; "auto" for as long as most
        phrases need.
    limits
        What a body can; by default a person.
    hold
        Whether characters hold their props in a hand.
    ground
        What they go on: a USD file of meshes, or a terrain; by default the level ground.

    Raises
    ------
    ScoreError
        If the Score names a device or a time that is not there.
    LibraryError
        If a cast has a library for a device that is not in the recording.
    ImportedFileError
        If ``ground`` is no USD file, or holds no mesh.
    TransferError
        If it cannot be acted out, or there is no ground, or more than one, below a way.
    """
    from actions_library.importers.usd_ground import read_terrain
    from smd.transfer.perform import perform

    return perform(
        score,
        recording,
        library,
        rate_hz=rate_hz,
        expressiveness=expressiveness,
        heading=heading,
        timing=timing,
        stretch=stretch,
        limits=limits,
        hold=hold,
        terrain=read_terrain(ground) if isinstance(ground, str | Path) else ground,
    )
