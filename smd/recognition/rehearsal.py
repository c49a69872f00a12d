"""Rehearsal: a performer's own examples beside others', and their effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.errors import LearningError
from smd.recognition import pattern as ast
from smd.recognition.acceptance import PLAINLY
from smd.recognition.action import Action
from smd.recognition.background import weighed
from smd.recognition.bank import compile_library, distances
from smd.recognition.exemplar import exemplar_of
from smd.recognition.learning import doodle_runs, learn_pattern, without_rest
from smd.recognition.matching import Match
from smd.recognition.pattern import Pattern
from smd.recognition.recognizer import Recognizer
from smd.recognition.traits import Traits, traits_of
from smd.smoothing import smooth


@dataclass(frozen=True, slots=True)
class Likeness:
    """The matches of a take, and the action that was asked for.

    Attributes
    ----------
    action : that was asked for.
    matches : how well the take fits each action, and none, the best first; none alone where it
        never moves.
    """

    action: str
    matches: tuple[Match, ...]

    @property
    def ranked(self) -> tuple[Match, ...]:
        """The matches of actions, the best first."""
        return tuple(match for match in self.matches if match.action is not None)

    @property
    def is_still(self) -> bool:
        """Whether the take never moves."""
        return not self.ranked

    @property
    def place(self) -> int:
        """Where the action comes among all, from 1; the take moves."""
        return 1 + [match.action for match in self.ranked].index(self.action)

    @property
    def is_another(self) -> bool:
        """Whether the take is plainly one of another action."""
        if self.is_still or self.place == 1:
            return False
        best = self.ranked[0]
        asked = self.ranked[self.place - 1]
        return self.share(best) <= 1.0 and asked.distance > PLAINLY * best.distance

    def share(self, match: Match | None = None) -> float:
        """Return the cost of a match, by default the action's, over its threshold.

        Up to 1 it is accepted.
        """
        match = self.ranked[self.place - 1] if match is None else match
        return match.distance / match.most


@dataclass(frozen=True, slots=True)
class Gain:
    """The effect of a rehearsal on one action.

    Attributes
    ----------
    action : its name.
    before : the matches of each take with the library as it was.
    after : the same with all takes added but the one that is tested (leave-one-out); empty if
        there is only one take of the action.
    """

    action: str
    before: tuple[Likeness, ...]
    after: tuple[Likeness, ...]


def likeness(recognizer: Recognizer, action: str, doodle: Doodle) -> Likeness:
    """Return the matches of a take of an action.

    Raises
    ------
    DoodleError
        If it is too short to be smoothed.
    """
    return Likeness(action, tuple(recognizer.rank(doodle)))


def add_examples(
    action: Action,
    doodles: Sequence[Doodle],
    *,
    names: Sequence[str] = (),
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
) -> Action:
    """Return an action with a performer's own examples beside those that it has.

    Its pattern stays as it is. An action without any examples is recognised by its tokens alone,
    and goes on so: there the pattern is widened to accept these takes, each as it is drawn.

    Parameters
    ----------
    action
        One that is drawn.
    doodles
        Each with the gesture once, with or without rest around it.
    names
        What to call them; ``example 1`` and so on if empty.
    figure_height_m
        Height of the figurine that the prop stands for.

    Raises
    ------
    LearningError
        If nobody draws the action, or if an example never moves or is one that it has already.
    DoodleError
        If an example is too short to be smoothed.
    """
    if action.pattern is None:
        raise LearningError(
            f"action {action.name!r}: expected one that is drawn; it has no pattern"
        )
    called = tuple(names) or tuple(f"example {i + 1}" for i in range(len(doodles)))
    if not doodles:
        return action
    learned_from = (*action.learned_from, *called)
    before = action.exemplar
    if before is None:
        pattern = _widened(action.pattern, doodles, called, figure_height_m)
        return replace(action, pattern=pattern, learned_from=learned_from)
    own = [
        _traits(name, i, doodle, figure_height_m)
        for i, (name, doodle) in enumerate(zip(called, doodles, strict=True))
    ]
    known = before.examples()
    for i, one in enumerate(own):
        if any(_is_same(one, other) for other in known):
            raise LearningError(
                f"{called[i]}: expected a new take, got one that is there already", i
            )
        known.append(one)
    numbers = [*before.own.nonzero()[0].tolist(), *range(len(before), len(before) + len(own))]
    exemplar = weighed(exemplar_of(known, own=numbers))
    return replace(action, learned_from=learned_from, exemplar=exemplar)


def gains(
    actions: Sequence[Action],
    takes: Mapping[str, Sequence[Doodle]],
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
) -> list[Gain]:
    """Return the effect of adding takes to actions, by action.

    Each take is tested on a library without it: before, on the actions as they are; after, with
    all other takes added (leave-one-out).

    Parameters
    ----------
    actions
        Of a library.
    takes
        By the name of an action among them, at least one each; all of them move.
    figure_height_m
        Height of the figurine that the prop stands for.
    """

    def looks(known: Sequence[Action], name: str, doodle: Doodle) -> Likeness:
        return likeness(Recognizer(known, figure_height_m=figure_height_m), name, doodle)

    def extended(action: Action, doodles: Sequence[Doodle]) -> Action:
        return add_examples(action, doodles, figure_height_m=figure_height_m)

    rehearsed = {one.name: extended(one, takes.get(one.name, ())) for one in actions if one.pattern}
    now = Recognizer(actions, figure_height_m=figure_height_m)
    found = []
    for action in actions:
        own = takes.get(action.name, ())
        if not own:
            continue
        after = []
        for i, doodle in enumerate(own):
            if len(own) > 1:
                without = extended(action, [*own[:i], *own[i + 1 :]])
                then = {**rehearsed, action.name: without}
                after.append(looks(list(then.values()), action.name, doodle))
        before = tuple(likeness(now, action.name, doodle) for doodle in own)
        found.append(Gain(action.name, before, tuple(after)))
    return found


def _traits(name: str, index: int, doodle: Doodle, figure_height_m: float) -> Traits:
    """Return the traits of an example's gesture, without the rest around it."""
    runs = without_rest(doodle_runs(doodle, figure_height_m))
    if not runs:
        raise LearningError(
            f"{name}: expected a gesture, got {doodle.duration_s:.1f} s of stillness", index
        )
    gesture = smooth(doodle).between(runs[0].start_s, runs[-1].end_s)
    return traits_of(gesture, figure_height_m=figure_height_m)


def _is_same(a: Traits, b: Traits) -> bool:
    """Return whether two examples are of one recording; files hold single precision."""
    return all(
        np.allclose(ours, theirs, rtol=0.0, atol=1e-4)
        for ours, theirs in zip((a.measures, *a.courses), (b.measures, *b.courses), strict=True)
    )


def _widened(
    pattern: Pattern, doodles: Sequence[Doodle], names: Sequence[str], figure_height_m: float
) -> Pattern:
    """Return a pattern that accepts examples as well, each as it is drawn."""
    for name, doodle in zip(names, doodles, strict=True):
        learned = learn_pattern([doodle], names=[name], figure_height_m=figure_height_m)
        bank = compile_library({"action": pattern})
        if distances(bank, learned.sequences[0])[0] > 0.0:
            pattern = Pattern(ast.Choice((pattern.root, learned.pattern.root)))
    return pattern
