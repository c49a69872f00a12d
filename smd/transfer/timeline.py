"""Timeline: a performer's time cut into phrases and the idling between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from smd.score import Phrase
from smd.transfer.body_time import BodyTime

SHORTEST_IDLE_S = 0.3
"""A gap shorter than this is too short to come to rest in: the next phrase fills it."""


class Cue(NamedTuple):
    """How a phrase is played; see `Span`."""

    planned: tuple[BodyTime, float] | None = None
    standing_s: float = 0.0
    run_up_s: float = 0.0
    turning_rad_s: float = np.inf
    along: bool = False


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of a performer's time.

    Attributes
    ----------
    start_s, end_s : on the recording's clock.
    phrase : what is performed; None for idling. Where a short gap was before it, the phrase
        starts after the span does.
    planned : the time that its clip needs, and when it strikes, where that is planned.
    standing_s : time that it takes to get from standing into its clip, and back.
    turning_rad_s : how fast it turns to its heading, on average; by default at once.
    along : whether it faces along its path, since its gait is not the drawn one.
    run_up_s : time in which it gathers speed before a flight, and loses it after; 0 where its clip
        decides.
    """

    start_s: float
    end_s: float
    phrase: Phrase | None = None
    planned: tuple[BodyTime, float] | None = None
    standing_s: float = 0.0
    run_up_s: float = 0.0
    turning_rad_s: float = np.inf
    along: bool = False


def timeline(
    phrases: Sequence[Phrase],
    start_s: float,
    end_s: float,
    cues: Sequence[Cue] | None = None,
) -> tuple[Span, ...]:
    """Cut the time from ``start_s`` to ``end_s`` into spans that follow each other.

    Parameters
    ----------
    phrases
        In time order, within that time or less than a frame beyond it.
    cues
        How each is played, where that is planned.
    """
    spans: list[Span] = []
    now_s = start_s
    for phrase, cue in zip(phrases, cues or [Cue()] * len(phrases), strict=True):
        if phrase.start_s - now_s >= SHORTEST_IDLE_S:
            spans.append(Span(now_s, phrase.start_s))
            now_s = phrase.start_s
        until_s = min(phrase.end_s, end_s)
        if until_s > now_s:
            spans.append(Span(now_s, until_s, phrase, *cue))
            now_s = until_s
    if end_s > now_s or not spans:
        spans.append(Span(now_s, max(end_s, now_s)))
    return tuple(spans)
