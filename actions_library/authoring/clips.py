"""All clips of the shipped humanoid."""

from __future__ import annotations

from actions_library.authoring import gestures, locomotion
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton

_CLIPS = (
    locomotion.walk,
    locomotion.run,
    locomotion.side_step_left,
    locomotion.side_step_right,
    locomotion.jump,
    gestures.turn_left,
    gestures.turn_right,
    gestures.punch,
    gestures.throw,
    locomotion.fly,
    gestures.bow,
    gestures.idle,
)


def humanoid_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.humanoid.humanoid_skeleton`."""
    return tuple(make(skeleton) for make in _CLIPS)
