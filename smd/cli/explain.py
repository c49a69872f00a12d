"""``smd parse --explain``: what each phrase was weighed by, term by term."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from smd.recognition.acceptance import Intent
from smd.recognition.recognizers import recognizer_of

if TYPE_CHECKING:
    from smd.cast import Cast
    from smd.doodle import Doodle, Recording
    from smd.recognition import Match
    from smd.score import Part, Phrase, Score

SHOWN_OTHERS = 2
"""So many of the actions that came next are shown."""


def explanation(score: Score, recording: Recording, cast: Cast) -> Iterator[str]:
    """Yield lines on each phrase: its terms, what would have rejected it, and what came next.

    A phrase is weighed again by itself: terms may differ a little from those in the flow. Then
    come the suggestions, with each action that was likely and what kept it out.
    """
    for part in score.performers:
        phrases = [phrase for phrase in part.phrases if not phrase.implied]
        if not phrases and not part.suggestions:
            yield f"  {part.device}: nothing in it is like an action of the library"
        yield from _phrases(phrases, part, score, recording, cast)
        if part.suggestions:
            yield f"  {part.device}: what was left unexplained; 1.00 is what an action may cost"
        for suggestion in part.suggestions:
            yield f"    {suggestion.start_s:8.2f} – {suggestion.end_s:7.2f} s"
            for one in suggestion.likeliest:
                share = "" if one.most is None else f"{one.distance / one.most:5.2f}"
                yield f"              {one.action:16}  {share:>5}  {one.reason}".rstrip()


def _phrases(
    phrases: Sequence[Phrase], part: Part, score: Score, recording: Recording, cast: Cast
) -> Iterator[str]:
    """Yield lines on what phrases were weighed by, where there are any."""
    if phrases:
        recognizer = recognizer_of(
            cast.of(part.device),
            figure_height_m=score.figure_height_m,
            intent=Intent(part.intent) if part.intent else None,
        )
        yield f"  {part.device}: what each phrase was weighed by, small is alike"
        for phrase in phrases:
            whole = next(
                doodle
                for doodle in recording.of(part.device)
                if doodle.time_s[-1] >= phrase.start_s
            )
            yield from _weighed(phrase, recognizer.rank(_during(whole, phrase)))


def _during(doodle: Doodle, phrase: Phrase) -> Doodle:
    """Return the doodle from a phrase's start to its end."""
    kept = (doodle.time_s >= phrase.start_s - 1e-3) & (doodle.time_s <= phrase.end_s + 1e-3)
    return doodle.selected(kept)


def _weighed(phrase: Phrase, matches: list[Match]) -> Iterator[str]:
    """Yield a phrase's terms, and the matches that came next."""
    by_name = {match.action: match for match in matches}
    own, nothing = by_name.get(phrase.action), by_name[None]
    yield f"    {phrase.start_s:8.2f} – {phrase.end_s:7.2f} s  {phrase.action}"
    if own is None:
        yield "              weighed by itself, it is nothing"
        return
    width = max(len(name) for name, _ in own.terms)
    for name, value in own.terms:
        yield f"              {name:{width}}  {value:7.2f}"
    yield f"              {'in all':{width}}  {own.distance:7.2f}"
    others = [match for match in matches if match.action not in (None, phrase.action)]
    for match in others[:SHOWN_OTHERS]:
        yield f"              {match.action}: {match.distance:.2f}"
    yield f"              nothing at all: {nothing.distance:.2f}"
