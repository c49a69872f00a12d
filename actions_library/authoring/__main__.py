"""Write a shipped library: ``python -m actions_library.authoring CHARACTER FOLDER``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from actions_library.authoring.actions import HUMANOID_ACTIONS
from actions_library.authoring.body import humanoid_character
from actions_library.authoring.caterpillar.library import write_caterpillar
from actions_library.authoring.clips import humanoid_clips
from actions_library.authoring.clips.face_actions import FACE_ACTIONS, face_clips
from actions_library.authoring.dog.library import write_dog
from actions_library.authoring.dragon.library import write_dragon
from actions_library.authoring.examples import with_examples
from actions_library.authoring.moon.library import write_moon
from actions_library.folder import write_library
from actions_library.library import Credit, Library
from smd.errors import SmdError


def write_humanoid(folder: Path) -> Library:
    """Make the humanoid, its clips, its actions and their examples, and write them as a library."""
    character = humanoid_character()
    clips = {clip.name: clip for clip in humanoid_clips(character.skeleton)}
    actions = with_examples(HUMANOID_ACTIONS)
    ours = Credit("Spatial Motion Doodles", "MIT")
    return write_library(
        folder,
        name="humanoid",
        character=character,
        clips=clips,
        actions=actions,
        credits=dict.fromkeys(clips, ours),
    )


def write_faces(folder: Path) -> Library:
    """Make the humanoid and the clips of its face, and write them as a library."""
    character = humanoid_character()
    clips = {clip.name: clip for clip in face_clips(character.skeleton)}
    ours = Credit("Spatial Motion Doodles", "MIT")
    return write_library(
        folder,
        name="faces",
        character=character,
        clips=clips,
        actions=FACE_ACTIONS,
        credits=dict.fromkeys(clips, ours),
    )


CHARACTERS: Mapping[str, Callable[[Path], Library]] = {
    "humanoid": write_humanoid,
    "faces": write_faces,
    "dog": write_dog,
    "caterpillar": write_caterpillar,
    "dragon": write_dragon,
    "moon": write_moon,
}
"""What writes each character's library."""


def main(arguments: list[str]) -> int:
    """Write the character's library into the folder named, and say what was made."""
    if len(arguments) != 2 or arguments[0] not in CHARACTERS:
        names = "|".join(CHARACTERS)
        print(f"usage: python -m actions_library.authoring {names} FOLDER", file=sys.stderr)
        return 2
    character, folder = arguments
    try:
        library = CHARACTERS[character](Path(folder))
    except SmdError as error:
        print(error, file=sys.stderr)
        return 3
    print(f"{library.folder}: {', '.join(action.name for action in library.actions)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
