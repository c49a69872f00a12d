"""A library made from imported files: a character first, then a clip for each action."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from actions_library.adoption.character import adopted_character
from actions_library.adoption.clip import Adopted, adopted_clip
from actions_library.extension import put_clip
from actions_library.folder import write_library
from actions_library.importers.imported import Animation, Imported
from actions_library.library import Credit, Library
from smd.cast import IDLE
from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.tracks import Tracks
from smd.errors import LibraryError
from smd.recognition.action import Action

_IDLE_NAME = re.compile(r"(?:^|[^a-z])idle(?:$|[^a-z])", re.IGNORECASE)


def library_from(
    folder: Path,
    imported: Imported,
    *,
    front: Sequence[float] | None = None,
    credit: Credit = Credit(),  # noqa: B008 - frozen
) -> tuple[Library, str | None]:
    """Write a library of an imported character with an idle clip, and return it.

    The idle clip is the file's animation of that name, or the rest pose. The animation's name is
    returned too, None for the rest pose.

    Parameters
    ----------
    folder
        Where; missing or empty. It gives the library its name.
    imported
        With meshes.
    front
        Level direction in which the figure faces, where the guess is wrong.
    credit
        Whose it is.

    Raises
    ------
    ImportedFileError
        If the file holds no mesh that its joints move.
    LibraryError
        If the folder holds something, or cannot be written.
    """
    if folder.is_dir() and any(folder.iterdir()):
        raise LibraryError(f"{folder}: expected a missing or an empty folder, found files in it")
    name = folder.resolve().name
    character = adopted_character(imported, name, front=front)
    idling = _idling(imported)
    if idling is None:
        clip = _at_rest(character, imported.rest_tracks)
    else:
        adopted = adopted_clip(
            imported, idling, character, IDLE, travels=False, cyclic=True, front=front
        )
        clip = adopted.clip
    library = write_library(
        folder,
        name=name,
        character=character,
        clips={IDLE: clip},
        actions=(Action(IDLE, None, cyclic=True),),
        credits={IDLE: credit},
    )
    return library, None if idling is None else idling.name


def _idling(imported: Imported) -> Animation | None:
    """Return the animation that is called idle, the shortest name of several."""
    found = [a for a in imported.animations if _IDLE_NAME.search(a.name)]
    return min(found, key=lambda a: (len(a.name), a.name), default=None)


def _at_rest(character: Character, tracks: Tracks) -> Clip:
    """Return a clip of a character in its rest pose; of one frame's tracks."""
    skeleton, frames = character.skeleton, 2
    return Clip(
        name=IDLE,
        skeleton=skeleton,
        rate_hz=1.0,
        rotation_xyzw=np.tile(skeleton.rest_rotation_xyzw, (frames, 1, 1)),
        translation_m=np.tile(skeleton.rest_translation_m, (frames, 1, 1)),
        stage_end_frames=np.array([0, 0, 1, 1, 1]),
        contact_joints=(),
        contacts=np.zeros((frames, 0), dtype=bool),
        cyclic=True,
        tracks=tracks.among(character.shapes).at(np.zeros(frames)),
    )


def import_clip(
    library: Library,
    imported: Imported,
    animation: Animation,
    action: str,
    *,
    travels: bool | None = None,
    cyclic: bool | None = None,
    front: Sequence[float] | None = None,
    description: str = "",
    credit: Credit = Credit(),  # noqa: B008 - frozen
) -> tuple[Library, Adopted]:
    """Put an imported animation into a library as an action's clip, and return both.

    An existing action keeps its gesture; a new one has none yet.

    Parameters
    ----------
    library
        As it was read from its folder.
    imported, animation
        Of which file, and which of its animations.
    action
        Name of the action.
    travels, cyclic, front
        As in `actions_library.adoption.clip.adopted_clip`.
    description
        What the gesture of the prop will be; empty keeps what is there.
    credit
        Whose the clip is.

    Raises
    ------
    ImportedFileError
        If the skeletons are not of the same kind.
    LibraryError
        If the action's name is no word, or the folder cannot be written.
    """
    idles = action == IDLE
    adopted = adopted_clip(
        imported,
        animation,
        library.character,
        action,
        travels=False if idles else travels,
        cyclic=True if idles else cyclic,
        front=front,
    )
    known = next((a for a in library.actions if a.name == action), Action(action, None))
    changed = replace(
        known,
        travels=adopted.ground.travels,
        cyclic=adopted.clip.cyclic,
        description=description or known.description,
    )
    return put_clip(library, changed, adopted.clip, credit), adopted
