"""The moon's library: expressions, drawn as people's actions of the same name are, if there are."""

from __future__ import annotations

from pathlib import Path

from actions_library.authoring.moon.clips import MOON_CLIPS
from actions_library.authoring.moon.face import moon_character
from actions_library.authoring.moon.skeleton import moon_rig
from actions_library.authoring.rig import Rig
from actions_library.folder import load_library, write_library
from actions_library.gestures import with_gestures
from actions_library.library import Credit, Library
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
    clips = {clip.name: clip for clip in moon_clips(rig)}
    return write_library(
        folder,
        name="moon",
        character=moon_character(rig.skeleton),
        clips=clips,
        actions=with_gestures(MOON_ACTIONS, load_library()),
        credits=dict.fromkeys(clips, Credit("Spatial Motion Doodles", "MIT")),
    )
