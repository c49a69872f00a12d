"""The caterpillar's library: what it can do, drawn as people's actions of the same name are."""

from __future__ import annotations

from pathlib import Path

from actions_library.authoring.caterpillar import crawls, standing
from actions_library.authoring.caterpillar.body import caterpillar_character
from actions_library.authoring.caterpillar.skeleton import caterpillar_rig
from actions_library.authoring.creature import write_creature
from actions_library.authoring.rig import Rig
from actions_library.library import Library
from smd.cast import IDLE
from smd.character.clip import Clip
from smd.recognition.action import Action

CATERPILLAR_ACTIONS = (
    Action("crawl", None, travels=True, cyclic=True),
    Action("walk", None, travels=True, cyclic=True),
    Action("hump", None, travels=True, cyclic=True, description="Not drawn: faster than walk."),
    Action("loop", None, travels=True, cyclic=True, description="Not drawn: faster than hump."),
    Action("crouch", None),
    Action("look", None, description="Not drawn: raises its front and looks about."),
    Action("jump", None, travels=True),
    Action(IDLE, None, cyclic=True),
)
"""What the caterpillar can do; its walk is the usual crawl."""

_CLIPS = (
    crawls.crawl,
    crawls.walk,
    crawls.hump,
    crawls.loop,
    standing.crouch,
    standing.look,
    standing.jump,
    standing.idle,
)


def caterpillar_clips(rig: Rig) -> tuple[Clip, ...]:
    """Return every clip of a rig of `actions_library.authoring.caterpillar.skeleton`."""
    return tuple(make(rig) for make in _CLIPS)


def write_caterpillar(folder: Path) -> Library:
    """Make the caterpillar, its clips and its actions, and write them as a library."""
    rig = caterpillar_rig()
    return write_creature(
        folder, caterpillar_character(rig.skeleton), caterpillar_clips(rig), CATERPILLAR_ACTIONS
    )
