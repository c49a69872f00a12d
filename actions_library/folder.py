"""A library's folder: read, and written whole or not at all."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from actions_library.library import Credit, Library
from actions_library.manifest import MANIFEST, manifest_text, read_manifest
from smd.errors import LibraryError

if TYPE_CHECKING:
    from smd.character.character import Character
    from smd.character.clip import Clip
    from smd.recognition.action import Action

EXEMPLARS_FOLDER = "exemplars"
HUMANOID = "humanoid"

_SHELF = Path(__file__).parent


def load_library(path: Path | str | None = None) -> Library:
    """Read a library's actions and patterns; its character and clips follow when asked for.

    Parameters
    ----------
    path
        The folder, or, where no folder is called so, the name of a library that is shipped (see
        `shipped_libraries`); None for the humanoid. A shipped library is read once.

    Raises
    ------
    LibraryError
        If there is no such folder, or its ``library.json`` is not one of ours.
    """
    if path is None:
        return _shipped(HUMANOID)
    folder = Path(path)
    if names_shipped(path):
        return _shipped(str(path))
    if folder.is_dir():
        return read_manifest(folder)
    names = ", ".join(shipped_libraries())
    raise LibraryError(f"{path}: expected a library's folder, or one of {names}; found neither")


def names_shipped(path: Path | str) -> bool:
    """Return whether a path names a library that is shipped, and no folder."""
    return str(path) in shipped_libraries() and not Path(path).is_dir()


def shipped_libraries() -> tuple[str, ...]:
    """Return the names of the libraries that are shipped."""
    return tuple(sorted(file.parent.name for file in _SHELF.glob(f"*/{MANIFEST}")))


@cache
def _shipped(name: str) -> Library:
    """Read a shipped library; nothing of it changes, so all may share it and what it has read."""
    read = read_manifest(_SHELF / name)
    return _ShippedLibrary(**{one.name: getattr(read, one.name) for one in fields(read)})


class _ShippedLibrary(Library):
    """One that is shipped: another process has it as well, and takes its own."""

    def __reduce__(self) -> tuple[Any, ...]:
        return _shipped, (self.folder.name,)


def write_library(
    folder: Path | str,
    *,
    name: str,
    character: Character,
    clips: Mapping[str, Clip],
    actions: tuple[Action, ...],
    credits: Mapping[str, Credit] | None = None,
) -> Library:
    """Write a library's folder, in the place of one that is there, and return it.

    Everything is written beside the folder and renamed into place, exemplars of the actions too.

    Parameters
    ----------
    folder
        Where; its parent must exist. What is there already must be a library, or be empty.
    name
        Of the library.
    character
        What the clips move.
    clips
        A clip for each action, by the action's name; all of the character's skeleton.
    actions
        With unique names.
    credits
        Of the clips whose author is known, by the action's name.

    Raises
    ------
    LibraryError
        If an action has no clip, the folder holds something else, or it cannot be written.
    """
    from actions_library.exemplars import write_exemplar
    from actions_library.storage import (
        CHARACTER_FILE,
        CLIPS_FOLDER,
        write_character_file,
        write_clip_file,
    )
    from actions_library.usd_skel import unique_identifiers

    folder, actions = Path(folder), tuple(actions)
    if folder.exists() and not (folder / MANIFEST).is_file() and any(folder.iterdir()):
        raise LibraryError(f"{folder}: expected a library or an empty folder, found other files")
    stems = dict(zip(clips, unique_identifiers(clips), strict=True))
    files = {clip: f"{CLIPS_FOLDER}/{stem}.usdc" for clip, stem in stems.items()}
    exemplar_files = {
        action.name: f"{EXEMPLARS_FOLDER}/{stems.get(action.name)}.npz"
        for action in actions
        if action.exemplar is not None
    }
    library = Library(name, folder, actions, CHARACTER_FILE, files, exemplar_files, credits or {})
    try:
        temporary = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    except OSError as error:
        raise LibraryError(f"{folder}: cannot be written: {error.strerror}") from error
    try:
        fresh = temporary / "new"
        (fresh / CLIPS_FOLDER).mkdir(parents=True)
        write_character_file(fresh / CHARACTER_FILE, character)
        for action in actions:
            clip = clips[action.name]
            if clip.skeleton.joints != character.skeleton.joints:
                raise LibraryError(f"clip {action.name!r}: expected the character's skeleton")
            write_clip_file(fresh / files[action.name], clip, character, f"../{CHARACTER_FILE}")
            if action.exemplar is not None:
                (fresh / EXEMPLARS_FOLDER).mkdir(exist_ok=True)
                write_exemplar(fresh / exemplar_files[action.name], action.exemplar)
        (fresh / MANIFEST).write_text(manifest_text(library), encoding="utf-8", newline="\n")
        _exchange(fresh, folder, temporary / "old")
    except OSError as error:
        raise LibraryError(f"{folder}: cannot be written: {error.strerror}") from error
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    return read_manifest(folder)


def _exchange(fresh: Path, folder: Path, old: Path) -> None:
    """Rename ``fresh`` to ``folder``, whose present content goes to ``old``, or back on failure."""
    if folder.exists():
        folder.replace(old)
    try:
        fresh.replace(folder)
    except OSError:
        if old.exists():
            old.replace(folder)
        raise
