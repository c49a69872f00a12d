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
from actions_library.gestures import with_gestures
from actions_library.importers.imported import Animation, Imported
from actions_library.library import Credit, Library
from smd.cast import IDLE
from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.tracks import Tracks
from smd.errors import LibraryError
from smd.recognition.action import Action

_IDLE_NAME = re.compile(r"(?:^|[^a-z])idle(?:$|[^a-z])", re.IGNORECASE)
_NO_LETTERS = re.compile(r"[^a-z0-9]+")


def library_from(
    folder: Path,
    imported: Imported,
    *,
    front: Sequence[float] | None = None,
    credit: Credit = Credit(),  # noqa: B008 - frozen
    lender: Library | None = None,
) -> tuple[Library, dict[str, str]]:
    """Write a library of an imported character with an idle clip, and return it.

    The idle clip is the file's animation of that name, or the rest pose. With a lender, the file's
    animations that are called as an action that it draws become actions with its gestures. The
    name of each action's animation is returned too, without idling in the rest pose.

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
    lender
        Whose gestures it is to be drawn with.

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
    found = {IDLE: _idling(imported), **_called_as(imported, lender)}
    taken = {name: animation for name, animation in found.items() if animation is not None}
    clips, actions = {IDLE: _at_rest(character, imported.rest_tracks)}, []
    for action, animation in taken.items():
        idles = action == IDLE
        adopted = adopted_clip(
            imported,
            animation,
            character,
            action,
            travels=False if idles else None,
            cyclic=True if idles else None,
            front=front,
        )
        clips[action] = adopted.clip
        if not idles:
            ground = adopted.ground
            actions.append(Action(action, None, travels=ground.travels, cyclic=adopted.clip.cyclic))
    library = write_library(
        folder,
        name=name,
        character=character,
        clips=clips,
        actions=(
            Action(IDLE, None, cyclic=True),
            *(with_gestures(actions, lender) if lender else actions),
        ),
        credits=dict.fromkeys(clips, credit),
    )
    return library, {action: animation.name for action, animation in taken.items()}


def _called_as(imported: Imported, lender: Library | None) -> dict[str, Animation]:
    """Return the animations that are called as an action that a library draws, by the action.

    ``Armature|Turn Left`` is called as ``turn_left``. Of several, the first in the file.
    """
    drawn = {a.name for a in lender.actions if a.pattern is not None} if lender else set()
    called: dict[str, Animation] = {}
    for animation in imported.animations:
        name = _NO_LETTERS.sub("_", animation.name.lower().rpartition("|")[2]).strip("_")
        if name in drawn:
            called.setdefault(name, animation)
    return called


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
    lender: Library | None = None,
) -> tuple[Library, Adopted]:
    """Put an imported animation into a library as an action's clip, and return both.

    An existing action keeps its gesture; a new one has none yet, or that of a lender's action of
    its name.

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
    lender
        Whose gesture it is to be drawn with.

    Raises
    ------
    ImportedFileError
        If the skeletons are not of the same kind.
    LibraryError
        If the action's name is no word, the lender does not draw it, or the folder cannot be
        written.
    """
    drawn = [a.name for a in lender.actions if a.pattern is not None] if lender else [action]
    if action not in drawn:
        raise LibraryError(f"gestures: expected an action of {', '.join(drawn)}; got {action!r}")
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
    if lender is not None:
        (known,) = with_gestures([known], lender)
    changed = replace(
        known,
        travels=adopted.ground.travels,
        cyclic=adopted.clip.cyclic,
        description=description or known.description,
    )
    return put_clip(library, changed, adopted.clip, credit), adopted
