"""Lacking: actions of a Score that a character has no clip for, and idles through."""

from __future__ import annotations

import difflib
from collections.abc import Collection
from dataclasses import replace

from smd.cast import Cast
from smd.score import Part, Score


def without_lacking(score: Score, cast: Cast) -> tuple[Score, list[str]]:
    """Return a Score without the phrases that performers lack, and a line for each such action.

    The line names the action and its phrases' times; where no library of the cast has the action,
    also one that may have been meant.
    """
    parts, said = [], []
    anywhere = {
        one.name for library in (cast.shared, *cast.own.values()) for one in library.actions
    }
    for part in score.performers:
        known = [action.name for action in cast.of(part.device).actions]
        parts.append(
            replace(part, phrases=tuple(one for one in part.phrases if one.action in known))
        )
        said += _lines(part, known, anywhere)
    return replace(score, performers=tuple(parts)), said


def _lines(part: Part, known: Collection[str], anywhere: Collection[str]) -> list[str]:
    """Return a line for each action of a part that is not known."""
    lacking = dict.fromkeys(one.action for one in part.phrases if one.action not in known)
    lines = []
    for action in lacking:
        times = [f"{one.start_s:.2f}" for one in part.phrases if one.action == action]
        near = [] if action in anywhere else difflib.get_close_matches(action, known, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        lines.append(
            f"device {part.device!r}: {action!r} at {', '.join(times)} s: its character has no "
            f"such action, and idles{hint}"
        )
    return lines
