"""The one place where the stages meet: from a Score to a performance."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from actions_library.library import Library
    from smd.doodle import Recording
    from smd.score import Score
    from smd.transfer.performance import Performance


def animate(
    score: Score, recording: Recording, library: Library, *, rate_hz: float = 24.0
) -> Performance:
    """Act out a Score: each device a character, each phrase an action on the doodle's path.

    Parameters
    ----------
    score
        Who does what, when and how.
    recording
        The doodles that the Score was read from.
    library
        The character and its clips.
    rate_hz
        Frames per second. At 24, what Blender's importer leaves its scene at, a file plays at its
        true speed there.

    Raises
    ------
    ScoreError
        If the Score names an action, a device or a time that is not there.
    TransferError
        If it cannot be acted out.
    """
    from smd.transfer.perform import perform

    return perform(score, recording, library, rate_hz=rate_hz)
