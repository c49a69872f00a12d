"""What to type next where a recording was hardly understood, in the order of what it changes."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from smd.cast import Cast
    from smd.doodle import Recording
    from smd.score import Score

LITTLE = 0.25
"""Share of the movement up to which a recording counts as not understood."""

TOLERANCES = (1.25, 1.5, 2.0)
"""How much more tolerance is worth proposing: beyond, idle hands pass too."""

LIVE = ("mount", "figure-height")
"""What can be said of the reading of what is being played."""


def next_steps(
    file: Path,
    recording: Recording,
    score: Score,
    cast: Cast,
    *,
    options: ReadingOptions,
    tolerance: float,
    only: Collection[str] = (),
) -> Iterator[str]:
    """Yield a line for each thing worth trying; none where most was understood, or nothing moves.

    Parameters
    ----------
    file
        Of the recording.
    options, tolerance
        As it was read and recognised.
    only
        The options that the command has; all if empty.
    """
    from smd.advice import Asked, better_reading, is_understood, understood_share
    from smd.formats.reading import format_frame
    from smd.recognition.acceptance import Intent

    if is_understood(recording, score):
        return
    said = {part.intent for part in score.performers if part.intent}
    asked = Asked(
        dict(options.pairs),
        format_frame(file),
        score.figure_height_m,
        tolerance,
        Intent(*said) if len(said) == 1 else None,
    )
    better = better_reading(recording, score, cast, asked, only=only)
    if better is not None:
        yield f"try {better}"
        return
    if understood_share(recording, score) > LITTLE:
        return
    shares = {
        one.likeliest[0].distance / (one.likeliest[0].most or 1.0): one.action
        for _, one in score.suggestions
    }
    action = shares[min(shares)] if shares else "ACTION"
    yield (
        f"try smd rehearse {action} --library my/: draw an action once or twice, and your way of "
        "drawing it is known"
    )
    yield "or smd teach NAME --library my/ --clip ACTION: teach a gesture of your own"
    for factor in TOLERANCES:
        near = sum(share <= factor for share in shares)
        if near:
            what = "suggestion" if near == 1 else "suggestions"
            yield f"or --tolerance {factor * tolerance:g}: {near} {what} may pass"
            break
    if not any(phrase.implied for part in score.performers for phrase in part.phrases):
        yield "or --unexplained follow: the character goes along where nothing is recognised"
