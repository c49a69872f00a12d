"""The dragon's library: what it can do, drawn as people's actions of the same name are."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from actions_library.authoring.creature import write_creature
from actions_library.authoring.dragon import gaits, jumps, standing
from actions_library.authoring.dragon.body import dragon_character
from actions_library.authoring.dragon.skeleton import dragon_rig
from actions_library.authoring.rig import Rig
from actions_library.library import Library
from smd.cast import IDLE
from smd.character.clip import Clip
from smd.recognition.action import Action

DRAGON_ACTIONS = (
    Action("walk", None, travels=True, cyclic=True),
    Action("run", None, travels=True, cyclic=True),
    Action("fly", None, travels=True, cyclic=True),
    Action("jump", None, travels=True),
    Action("hop", None),
    Action("turn_left", None),
    Action("turn_right", None),
    Action("bow", None),
    Action("sit_down", None, rest="idle_sitting"),
    Action("stand_up", None),
    Action("roar", None, description="Not drawn: jaw wide, wings and crest up."),
    Action("shake_head", None, description="Not drawn: no."),
    Action("look_around", None, description="Not drawn: to the left, then to the right."),
    Action("tail_swipe", None, description="Not drawn: the tail whips from left to right."),
    Action(IDLE, None, cyclic=True),
    Action("idle_sitting", None, cyclic=True, rest="idle_sitting"),
)
"""What the dragon can do; running is a gallop."""

_CLIPS = (
    *(gaits.walk, gaits.run, gaits.fly, jumps.jump, jumps.hop),
    *(standing.turn_left, standing.turn_right, standing.bow),
    *(standing.sit_down, standing.stand_up, standing.roar, standing.shake_head),
    *(standing.look_around, standing.tail_swipe, standing.idle, standing.idle_sitting),
)


def dragon_clips(rig: Rig) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.dragon.skeleton.dragon_rig`."""
    return tuple(_tidied(make(rig), rig) for make in _CLIPS)


def _tidied(clip: Clip, rig: Rig) -> Clip:
    """Return the clip with its bones exactly as long as at rest, and still where it stands still.

    Frames whose translations are the same number for number are stored once.
    """
    moved = [clip.skeleton.index(joint) for joint in (clip.skeleton.joints[0], rig.body)]
    translation = np.tile(clip.skeleton.rest_translation_m, (len(clip), 1, 1))
    translation[:, moved] = np.round(clip.translation_m[:, moved], 7)
    return replace(clip, translation_m=translation)


def write_dragon(folder: Path) -> Library:
    """Make the dragon, its clips and its actions, and write them as a library."""
    rig = dragon_rig()
    return write_creature(folder, dragon_character(rig.skeleton), dragon_clips(rig), DRAGON_ACTIONS)
