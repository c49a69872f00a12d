"""``library.json``: a library's table of contents, one action a line."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from actions_library.library import Credit, Library
from laban.faults import Fault, naming
from laban.json_node import Node, read_json
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
    if not folder.is_dir():
        raise LibraryError(f"{folder}: expected a library's folder, found none")
    path = folder / MANIFEST
    with naming(path, LibraryError):
        return _library(folder, read_json(path, "a library's table of contents"))


def _library(folder: Path, node: Node) -> Library:
    version = _version(node)
    actions, clip_files, exemplar_files, credits = [], {}, {}, {}
    for item in node.member("actions").items():
        row = _upgraded(item, version)
        action = _action(folder, row)
        actions.append(action)
        clip_files[action.name] = _file(row.member("clip"))
        credits[action.name] = Credit(
            author=row.member("author").text(), licence=row.member("licence").text()
        )
        if action.exemplar is not None:
            exemplar_files[action.name] = _file(row.member("exemplar"))
    return Library(
        name=node.member("name").text(),
        folder=folder,
        actions=tuple(actions),
        character_file=_file(node.member("character")),
        clip_files=clip_files,
        exemplar_files=exemplar_files,
        credits=credits,
    )


def _version(node: Node) -> int:
    """Return the version of a manifest that this release reads."""
    schema, version = node.member("schema"), node.member("version")
    if schema.value != SCHEMA:
        raise schema.fault(f'"{SCHEMA}"')
    if not 1 <= version.whole() <= VERSION:
        raise version.fault(f"1 to {VERSION}")
    return version.whole()


def _upgraded(row: Node, version: int) -> Node:
    """Return an action as of this version; its place is its name, where it has one."""
    name = row.member("name").text()
    value = row.value
    for step in range(version, VERSION):
        value = _UPGRADES[step](value)
    return Node(value, f"action {name!r}")


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


def _action(folder: Path, row: Node) -> Action:
    return Action(
        name=row.member("name").text(),
        pattern=_pattern(row.options().get("pattern")),
        travels=row.member("travels").truth(),
        cyclic=row.member("cyclic").truth(),
        description=row.member("description").text(),
        learned_from=tuple(source.text() for source in row.member("learned_from").items()),
        rest=row.member("rest").text(),
        exemplar=_exemplar(folder, row),
    )


def _pattern(node: Node | None) -> Pattern | None:
    """Return an action's pattern; an action without one may leave it out."""
    if node is None or node.value is None:
        return None
    try:
        return Pattern.parse(node.text())
    except PatternError as error:
        raise Fault.saying(node.place, str(error)) from error


def _exemplar(folder: Path, row: Node) -> Exemplar | None:
    """Return what the action remembers of examples, read from its file."""
    node = row.member("exemplar")
    if node.value is None:
        return None
    from actions_library.exemplars import read_exemplar

    return read_exemplar(folder / _file(node), _own(row.member("own")))


def _own(node: Node) -> Ownership:
    """Return which of an action's examples are the performer's own."""
    own = node.value
    if isinstance(own, bool):
        return own
    if isinstance(own, list) and all(type(number) is int for number in own):
        return tuple(own)
    raise node.fault("true, false or a list of numbers", repr(own)[:60])


def _file(node: Node) -> str:
    """Return a file's name that stays inside the library's folder."""
    name = node.text()
    parts = PurePosixPath(name).parts
    if not parts or ".." in parts or "\\" in name or ":" in name or name.startswith("/"):
        raise node.fault("a file inside the folder")
    return name
