"""The dog's library: what it can do, drawn as people's actions of the same name are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from actions_library.authoring.creature import write_creature
from actions_library.authoring.dog import acts, gaits, jumps, standing
from actions_library.authoring.dog.body import dog_character
from actions_library.authoring.dog.moods import HAPPY, PLAIN, SAD, Mood
from actions_library.authoring.dog.skeleton import dog_rig
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_posing import at_half_rate
from actions_library.library import Library
from smd.cast import IDLE
from smd.character.clip import Clip
from smd.recognition.action import Action

_GAITS: Mapping[str, Callable[[Rig, Mood], Clip]] = {
    "walk": gaits.walk,
    "trot": gaits.trot,
    "run": gaits.gallop,
}
_MOODS = (PLAIN, HAPPY, SAD)

DOG_ACTIONS = (
    *(
        Action(
            mood.named(name),
            None,
            travels=True,
            cyclic=True,
            description=f"Not drawn: {'between walk and run' if not mood.name else mood.name}.",
        )
        for name in _GAITS
        for mood in _MOODS
    ),
    Action("jump", None, travels=True),
    Action("sit_down", None, rest="idle_sitting"),
    Action("stand_up", None),
    Action("wave", None),
    Action("bow", None),
    *(
        Action(name, None, description="Not drawn: a Score asks for it.")
        for name in ("look", "shake", "scratch", "bark", "yawn")
    ),
    Action(IDLE, None, cyclic=True),
    *(
        Action(name, None, cyclic=True, description="Not drawn: a Score asks for it.")
        for name in ("idle_panting", "idle_looking")
    ),
    Action("idle_sitting", None, cyclic=True, rest="idle_sitting"),
)
"""What the dog can do; running is a gallop."""


def _in(mood: Mood, gait: Callable[[Rig, Mood], Clip]) -> Callable[[Rig], Clip]:
    return lambda rig: gait(rig, mood)


_CLIPS: tuple[Callable[[Rig], Clip], ...] = (
    *(_in(mood, gait) for gait in _GAITS.values() for mood in _MOODS),
    jumps.jump,
    standing.sit_down,
    standing.stand_up,
    acts.wave,
    acts.bow,
    acts.look,
    acts.shake,
    acts.scratch,
    acts.bark,
    acts.yawn,
    standing.idle,
    standing.idle_panting,
    standing.idle_looking,
    standing.idle_sitting,
)


def dog_clips(rig: Rig) -> tuple[Clip, ...]:
    """Return every clip, made for `actions_library.authoring.dog.skeleton.dog_rig`.

    What travels has 60 frames a second, what stays in its place 30.
    """
    travels = {action.name: action.travels for action in DOG_ACTIONS}
    clips = (make(rig) for make in _CLIPS)
    return tuple(clip if travels[clip.name] else at_half_rate(clip) for clip in clips)


def write_dog(folder: Path) -> Library:
    """Make the dog, its clips and its actions, and write them as a library."""
    rig = dog_rig()
    return write_creature(folder, dog_character(rig.skeleton), dog_clips(rig), DOG_ACTIONS)
