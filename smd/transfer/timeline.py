"""Timeline: a performer's time cut into phrases and the idling between them."""

from __future__ import annotations

from dataclasses import dataclass

from smd.score import Part, Phrase

SHORTEST_IDLE_S = 0.3
"""A gap shorter than this is too short to come to rest in: the next phrase fills it."""


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of a performer's time.

    Attributes
    ----------
    start_s, end_s : on the recording's clock.
    phrase : what is performed; None for idling. Where a short gap was before it, the phrase
        starts after the span does.
    """

    start_s: float
    end_s: float
    phrase: Phrase | None = None


def timeline(part: Part, start_s: float, end_s: float) -> tuple[Span, ...]:
    """Cut the time from ``start_s`` to ``end_s`` into spans that follow each other.

    Parameters
    ----------
    part
        Phrases within that time, or less than a frame beyond it.
    """
    spans: list[Span] = []
    now_s = start_s
    for phrase in part.phrases:
        if phrase.start_s - now_s >= SHORTEST_IDLE_S:
            spans.append(Span(now_s, phrase.start_s))
            now_s = phrase.start_s
        until_s = min(phrase.end_s, end_s)
        if until_s > now_s:
            spans.append(Span(now_s, until_s, phrase))
            now_s = until_s
    if end_s > now_s or not spans:
        spans.append(Span(now_s, max(end_s, now_s)))
    return tuple(spans)
