"""Stretch: a whole take, slower or faster."""

from __future__ import annotations

import math
from dataclasses import replace

from smd.doodle import Recording
from smd.errors import TransferError
from smd.score import Score

AUTO = "auto"
"""As long as most phrases need."""

FACTORS = (1.0, 1.15, 1.3, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 6.5, 8.0)
"""What is tried then, in order."""

LEAST, MOST = 0.1, 20.0


def factors(stretch: float | str) -> tuple[float, ...]:
    """Return the factors to try for what was asked.

    Raises
    ------
    TransferError
        If it is neither "auto" nor a number from 0.1 to 20.
    """
    if stretch == AUTO:
        return FACTORS
    try:
        factor = float(stretch)
    except (TypeError, ValueError):
        factor = math.nan
    if not LEAST <= factor <= MOST:
        raise TransferError(
            f"stretch: expected {AUTO!r} or a number from {LEAST:g} to {MOST:g}, got {stretch!r}"
        )
    return (factor,)


def stretched(score: Score, recording: Recording, factor: float) -> tuple[Score, Recording]:
    """Return a take that begins when it did and lasts a factor longer."""
    if factor == 1.0:
        return score, recording
    start_s = min(float(doodle.time_s[0]) for doodle in recording.doodles)

    def later(time_s: float) -> float:
        return start_s + factor * (time_s - start_s)

    doodles = tuple(
        replace(doodle, time_s=start_s + factor * (doodle.time_s - start_s))
        for doodle in recording.doodles
    )
    parts = tuple(
        replace(
            part,
            phrases=tuple(
                replace(phrase, start_s=later(phrase.start_s), end_s=later(phrase.end_s))
                for phrase in part.phrases
            ),
            suggestions=(),
        )
        for part in score.performers
    )
    return replace(score, performers=parts), replace(recording, doodles=doodles)
