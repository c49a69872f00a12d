"""All clips of the shipped humanoid, a family a module."""

from __future__ import annotations

from actions_library.authoring.clips import (
    air,
    gaits,
    greetings,
    ground,
    idling,
    joy,
    jumps,
    quick_steps,
    side_steps,
    sitting,
    strikes,
    throwing,
    turns,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton

_CLIPS = (
    gaits.walk,
    gaits.run,
    gaits.sneak,
    gaits.walk_backward,
    side_steps.side_step_left,
    side_steps.side_step_right,
    turns.turn_left,
    turns.turn_right,
    turns.spin,
    jumps.jump,
    jumps.leap,
    jumps.hop,
    ground.crawl,
    ground.roll,
    ground.fall,
    air.fly,
    air.swim,
    air.climb,
    strikes.punch,
    strikes.kick,
    strikes.push,
    strikes.slash,
    throwing.throw,
    throwing.pick_up,
    greetings.bow,
    greetings.nod,
    greetings.wave,
    joy.clap,
    joy.cheer,
    joy.dance,
    sitting.crouch,
    sitting.sit_down,
    sitting.stand_up,
    quick_steps.gallop_left,
    quick_steps.gallop_right,
    quick_steps.run_backward,
    idling.idle,
    sitting.idle_sitting,
)


def humanoid_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.humanoid.humanoid_skeleton`."""
    return tuple(make(skeleton) for make in _CLIPS)
