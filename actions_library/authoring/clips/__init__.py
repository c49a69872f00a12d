"""All clips of the shipped humanoid, a family a module."""

from __future__ import annotations

from actions_library.authoring.clips import (
    air,
    gaits,
    greetings,
    idling,
    jumps,
    side_steps,
    strikes,
    throwing,
    turns,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton

_CLIPS = (
    gaits.walk,
    gaits.run,
    side_steps.side_step_left,
    side_steps.side_step_right,
    jumps.jump,
    turns.turn_left,
    turns.turn_right,
    strikes.punch,
    throwing.throw,
    air.fly,
    greetings.bow,
    idling.idle,
)


def humanoid_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.humanoid.humanoid_skeleton`."""
    return tuple(make(skeleton) for make in _CLIPS)
