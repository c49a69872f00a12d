"""Gestures lent from one library's actions to those of another that have their name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from actions_library.library import Library
from smd.recognition.action import Action


def with_gestures(actions: Iterable[Action], lender: Library) -> tuple[Action, ...]:
    """Return the actions, drawn as the lender's of the same name are.

    An action takes pattern, exemplar and description; whether it travels, repeats and what it
    rests in follow its own clip. Those that the lender does not draw stay as they are.
    """
    drawn = {action.name: action for action in lender.actions if action.pattern is not None}
    return tuple(
        replace(
            action,
            pattern=drawn[action.name].pattern,
            exemplar=drawn[action.name].exemplar,
            description=drawn[action.name].description,
        )
        if action.name in drawn
        else action
        for action in actions
    )
