"""``library.json``: a library's table of contents, one action a line."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from actions_library.library import Credit, Library
from smd.errors import LibraryError, PatternError
from smd.recognition.action import Action
from smd.recognition.pattern import Pattern

if TYPE_CHECKING:
    from smd.recognition.exemplar import Exemplar, Ownership

MANIFEST = "library.json"
SCHEMA, VERSION = "smd.library", 4


def read_manifest(folder: Path) -> Library:
    """Return the library that a folder's ``library.json`` describes.

    Raises
    ------
    LibraryError
        If the folder or the file is missing, or a key is absent or not of its type.
    """
    path = folder / MANIFEST
    if not folder.is_dir():
        raise LibraryError(f"{folder}: expected a library's folder, found none")
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise LibraryError(
            f"{path}: expected a library's table of contents: {error.strerror}"
        ) from error
    except ValueError as error:
        raise LibraryError(f"{path}: expected JSON: {error}") from error
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise LibraryError(f"{path}: schema: expected {SCHEMA!r}")
    version = document.get("version")
    if type(version) is not int or not 1 <= version <= VERSION:
        raise LibraryError(f"{path}: version: expected 1 to {VERSION}, got {version!r}")
    rows = _value(path, document, "actions", list)
    for index, row in enumerate(rows):
        if not isinstance(row, dict):
            raise LibraryError(f"{path}: actions[{index}]: expected an object, got {row!r}")
    for step in range(version, VERSION):
        rows = [_UPGRADES[step](row) for row in rows]
    actions, clip_files, exemplar_files, credits = [], {}, {}, {}
    for row in rows:
        action = _action(path, row)
        actions.append(action)
        clip_files[action.name] = _file(path, row, "clip")
        credits[action.name] = Credit(
            author=_value(path, row, "author", str), licence=_value(path, row, "licence", str)
        )
        if action.exemplar is not None:
            exemplar_files[action.name] = _file(path, row, "exemplar")
    return Library(
        name=_value(path, document, "name", str),
        folder=folder,
        actions=tuple(actions),
        character_file=_file(path, document, "character"),
        clip_files=clip_files,
        exemplar_files=exemplar_files,
        credits=credits,
    )


def manifest_text(library: Library) -> str:
    """Return the text of ``library.json``."""
    head = {
        "schema": SCHEMA,
        "version": VERSION,
        "name": library.name,
        "character": library.character_file,
    }
    rows = [
        {
            "name": action.name,
            "pattern": None if action.pattern is None else str(action.pattern),
            "clip": library.clip_files[action.name],
            "travels": action.travels,
            "cyclic": action.cyclic,
            "description": action.description,
            "exemplar": library.exemplar_files.get(action.name),
            "own": action.exemplar.ownership if action.exemplar else False,
            "learned_from": list(action.learned_from),
            "rest": action.rest,
            "author": library.credit(action.name).author,
            "licence": library.credit(action.name).licence,
        }
        for action in library.actions
    ]
    lines = [f" {json.dumps(key)}: {json.dumps(value)}," for key, value in head.items()]
    table = ",\n".join("  " + json.dumps(row, ensure_ascii=False) for row in rows)
    return "\n".join(["{", *lines, ' "actions": [', table, " ]", "}", ""])


def _upgraded_1(row: dict[str, Any]) -> dict[str, Any]:
    """Return an action of version 1, which knew patterns alone, as of version 2."""
    return {**row, "exemplar": None, "learned_from": []}


def _upgraded_2(row: dict[str, Any]) -> dict[str, Any]:
    """Return an action of version 2, which idled one way and knew no authors, as of version 3."""
    return {**row, "rest": "", "author": "", "licence": ""}


def _upgraded_3(row: dict[str, Any]) -> dict[str, Any]:
    """Return an action of version 3, which did not say whose examples are, as of version 4.

    What was learned from recordings was so from the user's.
    """
    return {**row, "own": bool(row.get("learned_from"))}


_UPGRADES: Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]] = MappingProxyType(
    {1: _upgraded_1, 2: _upgraded_2, 3: _upgraded_3}
)
"""From each past version to the next one."""


def _action(path: Path, row: dict[str, Any]) -> Action:
    name = _value(path, row, "name", str)
    text = row.get("pattern")
    if text is not None and not isinstance(text, str):
        raise LibraryError(f"{path}: action {name!r}: pattern: expected text or null")
    try:
        pattern = None if text is None else Pattern.parse(text)
    except PatternError as error:
        raise LibraryError(f"{path}: action {name!r}: pattern: {error}") from error
    learned_from = _value(path, row, "learned_from", list)
    if not all(isinstance(source, str) for source in learned_from):
        raise LibraryError(f"{path}: action {name!r}: learned_from: expected a list of text")
    return Action(
        name=name,
        pattern=pattern,
        travels=_value(path, row, "travels", bool),
        cyclic=_value(path, row, "cyclic", bool),
        description=_value(path, row, "description", str),
        learned_from=tuple(learned_from),
        rest=_value(path, row, "rest", str),
        exemplar=_exemplar(path, row),
    )


def _exemplar(path: Path, row: dict[str, Any]) -> Exemplar | None:
    """Return what the action remembers of examples, read from its file."""
    if "exemplar" in row and row["exemplar"] is None:
        return None
    from actions_library.exemplars import read_exemplar

    return read_exemplar(path.parent / _file(path, row, "exemplar"), _own(path, row))


def _own(path: Path, row: dict[str, Any]) -> Ownership:
    """Return which of an action's examples are the performer's own."""
    own = row.get("own")
    if isinstance(own, bool):
        return own
    if isinstance(own, list) and all(type(number) is int for number in own):
        return tuple(own)
    raise LibraryError(
        f"{path}: {_place(row, 'own')}: expected true, false or a list of numbers, got {own!r}"
    )


def _value(path: Path, row: dict[str, Any], key: str, kind: type) -> Any:
    """Return ``row[key]`` if it is of the type ``kind``."""
    where = _place(row, key)
    if key not in row:
        raise LibraryError(f"{path}: {where}: expected {kind.__name__}, found no such key")
    if not isinstance(row[key], kind):
        raise LibraryError(f"{path}: {where}: expected {kind.__name__}, got {row[key]!r}")
    return row[key]


def _place(row: dict[str, Any], key: str) -> str:
    """Return a key with the action whose it is; only the whole document has actions."""
    return key if key == "name" or "actions" in row else f"action {row.get('name')!r}: {key}"


def _file(path: Path, row: dict[str, Any], key: str) -> str:
    """Return a file's name that stays inside the library's folder."""
    name = str(_value(path, row, key, str))
    parts = PurePosixPath(name).parts
    if not parts or ".." in parts or "\\" in name or ":" in name or name.startswith("/"):
        raise LibraryError(
            f"{path}: {_place(row, key)}: expected a file inside the folder, got {name!r}"
        )
    return name
