"""The library of faces: short motions and moods of the humanoid, none of which anybody draws."""

from __future__ import annotations

from actions_library.authoring.clips.faces import MOODS, MOTIONS, TAKE_S, mood, motion
from actions_library.authoring.clips.idling import idle
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.recognition.action import Action

_WORDS = {name: name.removeprefix("mood_").replace("_", " ") for name in (*MOTIONS, *MOODS)}

FACE_ACTIONS = (
    *(Action(name, None, description=f"Not drawn: the face, {_WORDS[name]}.") for name in MOTIONS),
    *(
        Action(name, None, description=f"Not drawn: takes of {TAKE_S:.0f} s, {_WORDS[name]}.")
        for name in MOODS
    ),
    Action("idle", None, cyclic=True),
)


def face_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """Return the clip of each, in their order."""
    made = [motion(skeleton, name) for name in MOTIONS] + [mood(skeleton, name) for name in MOODS]
    return (*made, idle(skeleton))
