"""Learning: from a few doodles of one gesture to the pattern of its tokens."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.errors import DoodleError, LearningError
from smd.recognition.average import average_doodle
from smd.recognition.generalization import generalized, main_token, pattern_of, stranger, ways_of
from smd.recognition.pattern import Pattern
from smd.recognition.progressive_alignment import WeightedToken
from smd.recognition.simplification import Group
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, Token, TokenRun
from smd.smoothing import WINDOW_S, smooth

LEAST_WEIGHT = 0.02
"""What a token counts for at least, beside the largest of its example: stillness has none."""


@dataclass(frozen=True, slots=True, eq=False)
class LearnedPattern:
    """A pattern, and its training examples.

    Attributes
    ----------
    pattern : accepts every example's sequence, and the average's.
    names : of the n examples.
    sequences : each example's tokens, without the rest before and after the gesture.
    spans_s : of each example, when its gesture begins and ends, on its doodle's clock.
    average : the mean of the examples' gestures.
    average_sequence : its tokens; empty if it took no part.
    mandatory : the tokens of each mandatory column, from first to last; empty if there are several
        ways.
    ways : number of ways of drawing the gesture that the pattern is a choice of.
    """

    pattern: Pattern
    names: tuple[str, ...]
    sequences: tuple[tuple[Token, ...], ...]
    spans_s: tuple[tuple[float, float], ...]
    average: Doodle
    average_sequence: tuple[Token, ...]
    mandatory: tuple[frozenset[Token], ...]
    ways: int

    def __str__(self) -> str:
        """Return the pattern and its source in one line."""
        count = len(self.names)
        source = f"{count} examples ({', '.join(self.names)})" if count > 1 else self.names[0]
        extra = " and their average" if self.average_sequence else ""
        ways = f", {self.ways} ways to draw it" if self.ways > 1 else ""
        return f"{self.pattern}  learned from {source}{extra}{ways}"


def learn_pattern(
    doodles: Sequence[Doodle],
    *,
    names: Sequence[str] = (),
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
) -> LearnedPattern:
    """Learn the pattern of a gesture from examples (section 4.3 of the paper [1]_).

    The examples and their average doodle are tokenized. Tokens that all sequences share are
    mandatory, and all others optional (`generalized`). If all share no movement, though each
    shares some with another, the pattern is a choice of several ways to draw the gesture
    (`ways_of`). So every example, and the average, is accepted. Rest before and after the gesture
    is ignored, and a pause within is optional if an example has one. The average is left out if
    there is one example, or if it shares nothing with its examples (which differ in time or side).

    Parameters
    ----------
    doodles
        At least one, each with the gesture once, with or without rest around it.
    names
        What to call them in messages; ``example 1`` and so on if empty.
    figure_height_m
        Height of the figurine that the prop stands for.

    Raises
    ------
    LearningError
        If there is no example, if one is too short or never moves, or if one has no movement in
        common with any other.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    """
    called = tuple(names) or tuple(f"example {i + 1}" for i in range(len(doodles)))
    if len(called) != len(doodles):
        raise LearningError(f"names: expected {len(doodles)}, one an example, got {len(called)}")
    if not doodles:
        raise LearningError("learning: expected at least one example, got none")
    runs = [_moving(called[i], i, doodle, figure_height_m) for i, doodle in enumerate(doodles)]
    spans_s = tuple((moving[0].start_s, moving[-1].end_s) for moving in runs)
    gestures = [_part(doodle, *span) for doodle, span in zip(doodles, spans_s, strict=True)]
    average = average_doodle(gestures, figure_height_m=figure_height_m)
    examples = [_strokes(moving) for moving in runs]
    mean = _strokes(without_rest(doodle_runs(average, figure_height_m))) if len(runs) > 1 else []
    ways = [generalized([mean, *examples])] if mean else []
    if not any(ways):
        mean, ways = [], ways_of(examples)
    # The average may be like examples that are nothing like each other.
    if len(examples) > 1 and (odd := stranger(examples)) is not None:
        raise _nothing_in_common(called, examples, odd)
    return LearnedPattern(
        pattern=pattern_of(ways),
        names=called,
        sequences=tuple(tuple(stroke.token for stroke in strokes) for strokes in examples),
        spans_s=spans_s,
        average=average,
        average_sequence=tuple(stroke.token for stroke in mean),
        mandatory=_mandatory(ways),
        ways=len(ways),
    )


def doodle_runs(doodle: Doodle, figure_height_m: float) -> tuple[TokenRun, ...]:
    """Return a doodle's runs of tokens; where it was not meant to draw, it is still."""
    motion = smooth(doodle)
    drawing = doodle.drawing_at(motion.time_s)
    return tokenize(motion, figure_height_m=figure_height_m, drawing=drawing)


def without_rest(runs: Sequence[TokenRun]) -> tuple[TokenRun, ...]:
    """Return runs from the first that moves to the last that does."""
    moving = [i for i, run in enumerate(runs) if run.token != STILL]
    return tuple(runs[moving[0] : moving[-1] + 1]) if moving else ()


def _moving(name: str, index: int, doodle: Doodle, figure_height_m: float) -> tuple[TokenRun, ...]:
    """Return the runs of an example's gesture."""
    try:
        moving = without_rest(doodle_runs(doodle, figure_height_m))
    except DoodleError as error:
        raise LearningError(f"{name}: {error}", index) from error
    if not moving:
        raise LearningError(
            f"{name}: expected a gesture, got {doodle.duration_s:.1f} s of stillness", index
        )
    return moving


def _part(doodle: Doodle, start_s: float, end_s: float) -> Doodle:
    """Return a doodle between two times and a smoothing window around them.

    Cut closer, the one-sided fit at the end would overshoot, and draw a movement of its own.
    """
    kept = (doodle.time_s >= start_s - WINDOW_S) & (doodle.time_s <= end_s + WINDOW_S)
    return doodle.selected(kept)


def _strokes(runs: Sequence[TokenRun]) -> list[WeightedToken]:
    """Return the tokens of runs with their share of the largest movement."""
    extent = [run.travel_heights + run.turn_rad for run in runs]
    largest = max(extent, default=0.0) or 1.0
    return [
        WeightedToken(run.token, max(each / largest, LEAST_WEIGHT))
        for run, each in zip(runs, extent, strict=True)
    ]


def _mandatory(ways: Sequence[Sequence[Group]]) -> tuple[frozenset[Token], ...]:
    """Return the tokens of the mandatory groups of the only way; none if there are several."""
    if len(ways) > 1:
        return ()
    return tuple(group.tokens for group in ways[0] if not group.optional)


def _nothing_in_common(
    names: Sequence[str], examples: Sequence[Sequence[WeightedToken]], odd: int
) -> LearningError:
    """Return the error that names the example that is like no other."""
    others = sorted({str(main_token(s)) for i, s in enumerate(examples) if i != odd})
    return LearningError(
        f"{names[odd]}: expected a movement that another example has, got mainly "
        f"{main_token(examples[odd])} where the others have mainly {', '.join(others)}",
        odd,
    )
