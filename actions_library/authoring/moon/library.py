"""The moon's library: expressions, drawn as people's actions of the same name are, if there are."""

from __future__ import annotations

from pathlib import Path

from actions_library.authoring.creature import write_creature
from actions_library.authoring.moon.clips import MOON_CLIPS
from actions_library.authoring.moon.face import moon_character
from actions_library.authoring.moon.skeleton import moon_rig
from actions_library.authoring.rig import Rig
from actions_library.library import Library
from smd.cast import IDLE
from smd.character.clip import Clip
from smd.recognition.action import Action

MOON_ACTIONS = (
    Action(IDLE, None, cyclic=True),
    Action("smile", None, description="Not drawn: a broad smile."),
    Action("frown", None, description="Not drawn: displeased."),
    Action("sad", None, description="Not drawn: looks down, the corners of the mouth low."),
    Action("surprise", None, description="Not drawn: eyes and mouth open."),
    Action("wink", None, description="Not drawn: the left eye."),
    Action("yawn", None, description="Not drawn: the mouth open wide."),
    Action("kiss", None, description="Not drawn: lips ahead, eyes closed."),
    Action("huff", None, description="Not drawn: the cheeks blown up."),
    Action("nod", None),
    Action("shake_head", None, description="Not drawn: no."),
)
"""What the moon can do; nodding is what people do too."""


def moon_clips(rig: Rig) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.moon.skeleton.moon_rig`."""
    return tuple(make(rig) for make in MOON_CLIPS)


def write_moon(folder: Path) -> Library:
    """Make the moon, its clips and its actions, and write them as a library."""
    rig = moon_rig()
    return write_creature(folder, moon_character(rig.skeleton), moon_clips(rig), MOON_ACTIONS)
