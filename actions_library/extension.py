"""Extension: one more action for a library on disk, written completely or not at all."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

from actions_library.exemplars import write_exemplar
from actions_library.folder import EXEMPLARS_FOLDER, load_library, write_library
from actions_library.library import Credit, Library
from actions_library.manifest import MANIFEST, manifest_text
from actions_library.storage import CLIPS_FOLDER, write_clip_file
from smd.cast import IDLE
from smd.character.clip import Clip
from smd.errors import LibraryError
from smd.files import replacing
from smd.recognition.action import Action

_NAME = re.compile(r"[^\W\d_]\w{0,59}")


def require_word(name: str) -> None:
    """Raise LibraryError unless a name is a lower-case word, which may also name a file."""
    if not _NAME.fullmatch(name) or name != name.lower():
        raise LibraryError(
            "action: expected a lower-case word of letters, digits and _ that begins with a "
            f"letter, got {name[:60]!r}"
        )


def require_name(name: str) -> None:
    """Raise LibraryError unless a name is a word that a gesture may have."""
    require_word(name)
    if name == IDLE:
        raise LibraryError(
            f"action: expected another name than {IDLE!r}, which is played where nothing is drawn"
        )


def require_new(library: Library, name: str) -> None:
    """Raise LibraryError if a library has a gesture of this name; a clip alone waits for one."""
    if name in {action.name for action in library.actions if action.pattern is not None}:
        raise LibraryError(
            f"{library.folder}: action {name!r} is there already: expected another name, "
            "or --replace"
        )


def clip_source(
    action: str, clip: str | None, shelves: Sequence[Library]
) -> tuple[Library, Action]:
    """Return the clip for a new action: an action, and the library that has it.

    Parameters
    ----------
    action
        Name of the new action.
    clip
        Name of the action whose clip was asked for; by default one of the new action's own name,
        and else idling.
    shelves
        The library that is extended, and where else to look, in this order; those with another
        character than the first one's are passed over.

    Raises
    ------
    LibraryError
        If none of them has it; it names those there are.
    """
    joints = shelves[0].character.skeleton.joints
    fitting = [shelf for shelf in shelves if shelf.character.skeleton.joints == joints]
    for name in (action, IDLE) if clip is None else (clip,):
        for shelf in fitting:
            for known in shelf.actions:
                if known.name == name:
                    return shelf, known
    names = dict.fromkeys(known.name for shelf in fitting for known in shelf.actions)
    raise LibraryError(f"clip: expected that of {', '.join(names)}; got {clip or IDLE!r}")


def new_library(
    folder: Path,
    base: Library,
    kept: Collection[str],
    action: Action,
    clip: Clip,
    credit: Credit,
) -> Library:
    """Write a library of another one's character, some of its actions, and a new one.

    Parameters
    ----------
    folder
        Where; missing or empty. It gives the library its name.
    base
        The other library.
    kept
        Names of the actions to take over; idling always is.
    action, clip, credit
        The new action, how it is performed, and whose that is; it takes the place of one of its
        name.

    Raises
    ------
    LibraryError
        If the name is no word, the folder holds something, or it cannot be written.
    """
    require_name(action.name)
    require_place(folder)
    taken = tuple(known for known in base.actions if known.name in (*kept, IDLE))
    clips = {known.name: base.clip(known.name) for known in taken}
    return write_library(
        folder,
        name=folder.resolve().name,
        character=base.character,
        clips={**clips, action.name: clip},
        actions=_with(tuple(_resting(known, taken) for known in taken), action),
        credits={**{name: base.credit(name) for name in clips}, action.name: credit},
    )


def add_action(library: Library, action: Action, clip: Clip, credit: Credit) -> Library:
    """Put a gesture and its clip into a library's folder, in the place of one of its name.

    As `put_clip` does; raises LibraryError also if the name is not one a gesture may have.
    """
    require_name(action.name)
    return put_clip(library, action, clip, credit)


def put_clip(library: Library, action: Action, clip: Clip, credit: Credit) -> Library:
    """Put an action into a library's folder, in the place of one of its name if there is one.

    New files come first, under names that are not taken; ``library.json``, which is renamed into
    place, makes them count. Until then the library is what it was, and if anything fails the
    new files are taken away again. Other files in the folder are left alone.

    Parameters
    ----------
    library
        As it was read from its folder.
    action
        To add.
    clip, credit
        How it is performed, by the library's character, and whose that is.

    Returns
    -------
    Library
        As it is then.

    Raises
    ------
    LibraryError
        If the name is no word, or the clip moves another character.
    ExportError
        If the folder cannot be written.
    """
    require_word(action.name)
    if clip.skeleton.joints != library.character.skeleton.joints:
        raise LibraryError(
            f"clip {clip.name!r}: expected one that moves the character of {library.folder}"
        )
    stem = _free_stem(library.folder, action.name)
    clip_file, exemplar_file = f"{CLIPS_FOLDER}/{stem}.usdc", f"{EXEMPLARS_FOLDER}/{stem}.npz"
    exemplar_files = {**library.exemplar_files, action.name: exemplar_file}
    if action.exemplar is None:
        del exemplar_files[action.name]
    changed = replace(
        library,
        actions=_with(library.actions, action),
        clip_files={**library.clip_files, action.name: clip_file},
        exemplar_files=exemplar_files,
        credits={**library.credits, action.name: credit},
    )
    with _taken_back(library.folder, clip_file, exemplar_file):
        with _new_file(library.folder / clip_file) as path:
            write_clip_file(path, clip, library.character, f"../{library.character_file}")
        if action.exemplar is not None:
            with _new_file(library.folder / exemplar_file) as path:
                write_exemplar(path, action.exemplar)
        with replacing(library.folder / MANIFEST) as path:
            path.write_text(manifest_text(changed), encoding="utf-8", newline="\n")
    kept = {*changed.clip_files.values(), *changed.exemplar_files.values()}
    for file in {*library.clip_files.values(), *library.exemplar_files.values()} - kept:
        (library.folder / file).unlink(missing_ok=True)
    return load_library(library.folder)


def put_examples(library: Library, rehearsed: Sequence[Action]) -> Library:
    """Put actions with other examples, or another pattern, in the place of their namesakes.

    Their clips stay. All of them change or none, as in `put_clip`.

    Parameters
    ----------
    library
        As it was read from its folder.
    rehearsed
        Actions that it has, changed; an exemplar is neither gained nor lost.

    Returns
    -------
    Library
        As it is then.

    Raises
    ------
    LibraryError
        If the library has no action of a name.
    ExportError
        If the folder cannot be written.
    """
    exemplar_files = dict(library.exemplar_files)
    actions = library.actions
    with ExitStack() as undone:
        for action in rehearsed:
            library.action(action.name)
            actions = _with(actions, action)
            if action.exemplar is None:
                continue
            file = f"{EXEMPLARS_FOLDER}/{_free_stem(library.folder, action.name)}.npz"
            exemplar_files[action.name] = file
            undone.callback((library.folder / file).unlink, missing_ok=True)
            with _new_file(library.folder / file) as path:
                write_exemplar(path, action.exemplar)
        changed = replace(library, actions=actions, exemplar_files=exemplar_files)
        with replacing(library.folder / MANIFEST) as path:
            path.write_text(manifest_text(changed), encoding="utf-8", newline="\n")
        undone.pop_all()
    for file in {*library.exemplar_files.values()} - {*exemplar_files.values()}:
        (library.folder / file).unlink(missing_ok=True)
    return load_library(library.folder)


def rehearsed_library(folder: Path, base: Library, rehearsed: Sequence[Action]) -> Library:
    """Write a library with all of another one, and some of its actions with other examples.

    Parameters
    ----------
    folder
        Where; missing or empty. It gives the library its name.
    base
        The other library.
    rehearsed
        Actions that it has, changed.

    Raises
    ------
    LibraryError
        If the folder holds something, or it cannot be written, or the other library has no action
        of a name.
    """
    require_place(folder)
    actions = base.actions
    for action in rehearsed:
        base.action(action.name)
        actions = _with(actions, action)
    return write_library(
        folder,
        name=folder.resolve().name,
        character=base.character,
        clips=base.clips,
        actions=actions,
        credits=base.credits,
    )


def require_place(folder: Path) -> None:
    """Raise LibraryError unless a new library may be written to a folder."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise LibraryError(f"{folder}: expected a library or an empty folder, found other files")
    if not folder.resolve().parent.is_dir():
        raise LibraryError(f"{folder}: expected an existing folder {folder.parent}, found none")


def _resting(action: Action, among: tuple[Action, ...]) -> Action:
    """Return an action with its ``rest``, if that action is in the library too, else without."""
    came = action.rest in {other.name for other in among}
    return action if came else replace(action, rest="")


def _with(actions: tuple[Action, ...], new: Action) -> tuple[Action, ...]:
    """Return actions with a new one in its namesake's place, or at the end."""
    if new.name in {action.name for action in actions}:
        return tuple(new if action.name == new.name else action for action in actions)
    return (*actions, new)


def _free_stem(folder: Path, name: str) -> str:
    """Return a file's name without suffix that neither a clip nor an exemplar has."""
    taken = {
        path.stem.lower()  # where case does not count, Wave.usdc would be overwritten
        for part in (CLIPS_FOLDER, EXEMPLARS_FOLDER)
        if (folder / part).is_dir()
        for path in (folder / part).iterdir()
    }
    stem, count = name, 1
    while stem in taken:
        count += 1
        stem = f"{name}_{count}"
    return stem


@contextmanager
def _new_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path that becomes ``path``, whose folder is made where missing."""
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise LibraryError(f"{path.parent}: cannot be made: {error.strerror}") from error
    with replacing(path) as temporary:
        yield temporary


@contextmanager
def _taken_back(folder: Path, *files: str) -> Iterator[None]:
    """Remove files again if what follows fails."""
    try:
        yield
    except BaseException:
        for file in files:
            (folder / file).unlink(missing_ok=True)
        raise
