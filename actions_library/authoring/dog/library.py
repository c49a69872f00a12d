"""The dog's library: what it can do, drawn as people's actions of the same name are."""

from __future__ import annotations

from pathlib import Path

from actions_library.authoring.dog import gaits, standing
from actions_library.authoring.dog.body import dog_character
from actions_library.authoring.dog.skeleton import dog_rig
from actions_library.authoring.rig import Rig
from actions_library.folder import load_library, write_library
from actions_library.gestures import with_gestures
from actions_library.library import Credit, Library
from smd.cast import IDLE
from smd.character.clip import Clip
from smd.recognition.action import Action

DOG_ACTIONS = (
    Action("walk", None, travels=True, cyclic=True),
    Action("trot", None, travels=True, cyclic=True, description="Not drawn: between walk and run."),
    Action("run", None, travels=True, cyclic=True),
    Action("sit_down", None, rest="idle_sitting"),
    Action("stand_up", None),
    Action(IDLE, None, cyclic=True),
    Action("idle_sitting", None, cyclic=True, rest="idle_sitting"),
)
"""What the dog can do; running is a gallop."""

_CLIPS = (
    gaits.walk,
    gaits.trot,
    gaits.gallop,
    standing.sit_down,
    standing.stand_up,
    standing.idle,
    standing.idle_sitting,
)


def dog_clips(rig: Rig) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.dog.skeleton.dog_rig`."""
    return tuple(make(rig) for make in _CLIPS)


def write_dog(folder: Path) -> Library:
    """Make the dog, its clips and its actions, and write them as a library."""
    rig = dog_rig()
    clips = {clip.name: clip for clip in dog_clips(rig)}
    return write_library(
        folder,
        name="dog",
        character=dog_character(rig.skeleton),
        clips=clips,
        actions=with_gestures(DOG_ACTIONS, load_library()),
        credits=dict.fromkeys(clips, Credit("Spatial Motion Doodles", "MIT")),
    )
