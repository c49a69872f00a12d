"""The Score's file: JSON that a person can read and correct (docs/score.md)."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from laban import AXES, Effort
from smd.errors import ScoreError
from smd.files import replacing
from smd.score import Alternative, Part, Phrase, Score

SCHEMA = "smd.score"
VERSION = 1

# ---------------------------------------------------------------------------- writing


def score_to_json(score: Score) -> str:
    """Return a Score as JSON text, one phrase a line, so that a line diff reads.

    Times have three decimals, as do efforts, confidences and distances; effort axes that were
    not read are left out.

    Raises
    ------
    ScoreError
        If a phrase is shorter than the half millisecond that three decimals can tell.
    """
    head: list[tuple[str, Any]] = [
        ("schema", SCHEMA),
        ("version", VERSION),
        ("recording", score.recording),
        ("library", score.library),
        ("figure_height_m", score.figure_height_m),
        ("reading", dict(score.reading)),
        ("warnings", list(score.warnings)),
    ]
    lines = [f"  {_json(key)}: {_json(value)}," for key, value in head]
    parts = ",\n".join(_part_json(part) for part in score.performers)
    body = f"[\n{parts}\n  ]" if parts else "[]"
    return "\n".join(["{", *lines, f'  "performers": {body}', "}", ""])


def write_score(score: Score, path: Path | str) -> None:
    """Write a Score as a JSON file, replacing ``path`` whole or not at all.

    Raises
    ------
    ScoreError
        As `score_to_json`.
    ExportError
        If ``path`` cannot be written.
    """
    text = score_to_json(score)
    with replacing(Path(path)) as temporary:
        temporary.write_bytes(text.encode("utf-8"))


def _json(value: Any) -> str:
    """Return one line of JSON; readable beyond ASCII wherever UTF-8 can hold it."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False)
    # A file name that is not UTF-8 reaches Python with lone surrogates, which cannot be written.
    return text if text.isascii() or _is_utf8(text) else json.dumps(value, allow_nan=False)


def _is_utf8(text: str) -> bool:
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return True


def _rounded(value: float) -> float:
    """Return a number with three decimals, without a negative zero."""
    return round(value, 3) + 0.0


def _part_json(part: Part) -> str:
    """Return a performer, its phrases a line each."""
    lines = []
    previous_end_s = -math.inf
    for phrase in part.phrases:
        # Neighbours may overlap by rounding alone: `Part` allows a nanosecond.
        start_s = max(_rounded(phrase.start_s), previous_end_s)
        previous_end_s = _rounded(phrase.end_s)
        if previous_end_s <= start_s:
            raise ScoreError(
                f"device {part.device!r}: phrase {phrase.action!r} at {phrase.start_s:g} s: "
                f"expected to last at least 0.001 s, got {phrase.end_s - phrase.start_s:g} s"
            )
        lines.append(f"      {_phrase_json(phrase, start_s, previous_end_s)}")
    body = "[\n" + ",\n".join(lines) + "\n    ]" if lines else "[]"
    own = f'"library": {_json(part.library)}, ' if part.library else ""
    return f'    {{"device": {_json(part.device)}, {own}"phrases": {body}}}'


def _phrase_json(phrase: Phrase, start_s: float, end_s: float) -> str:
    effort = {
        axis: _rounded(value)
        for axis in AXES
        if (value := getattr(phrase.effort, axis)) is not None
    }
    alternatives = [
        {"action": other.action, "distance": _rounded(other.distance)}
        for other in phrase.alternatives
    ]
    return (
        f'{{"action": {_json(phrase.action)}, "start_s": {start_s:.3f}, "end_s": {end_s:.3f}, '
        f'"effort": {_json(effort)}, "confidence": {_json(_rounded(phrase.confidence))}, '
        f'"alternatives": {_json(alternatives)}}}'
    )


# ---------------------------------------------------------------------------- reading


def read_score(path: Path | str) -> Score:
    """Read a Score's JSON file.

    Raises
    ------
    ScoreError
        If there is no such file or it is not a Score; one line names the file, the key, what
        was expected and what was found.
    """
    path = Path(path)
    if path.is_dir():
        raise ScoreError(f"{path}: expected a Score file, found a folder")
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise ScoreError(f"{path}: expected a Score file, found none") from None
    except OSError as error:
        raise ScoreError(f"{path}: cannot be read: {error.strerror or error}") from error
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ScoreError(
            f"{path}: expected UTF-8 text, found byte 0x{data[error.start]:02x} at {error.start}"
        ) from None
    return score_from_json(text, str(path))


def score_from_json(text: str, source: str = "score") -> Score:
    """Read a Score from JSON text.

    What a person would leave out may be missing: ``recording``, ``library``,
    ``figure_height_m``, ``reading``, ``warnings``, a performer's ``library``, and a phrase's
    ``effort``, ``confidence`` and ``alternatives``. Keys that are not known are refused, so that a
    slip of the pen does not pass for silence.

    Parameters
    ----------
    text
        The file's text.
    source
        Where it came from, for messages.

    Raises
    ------
    ScoreError
        If it is not a Score; one line names ``source``, the key, what was expected and found.
    """
    if "\0" in text:
        raise ScoreError(f"{source}: expected UTF-8 text, found zero bytes, as in UTF-16")
    try:
        value = json.loads(text, object_pairs_hook=_without_repeats)
    except json.JSONDecodeError as error:
        raise ScoreError(
            f"{source}: line {error.lineno}, column {error.colno}: expected JSON, got: {error.msg}"
        ) from None
    except RecursionError:
        raise ScoreError(f"{source}: expected a Score, found JSON nested too deeply") from None
    except ValueError as error:
        raise ScoreError(f"{source}: expected a Score, got: {error}") from None
    return _score(_Node(value, source))


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object's members; the last of two equal keys would win unseen."""
    members = dict(pairs)
    if len(members) < len(pairs):
        keys = [key for key, _ in pairs]
        repeated = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {_shown(repeated)} twice in one object")
    return members


def _shown(value: Any) -> str:
    """Return a value as a message shows it: on one line, cut short."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return "a list"
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."


@dataclass(frozen=True, slots=True)
class _Node:
    """A JSON value that knows where it stands, so that each complaint can name the place."""

    value: Any
    source: str
    path: str = ""

    def fault(self, expected: str, found: str | None = None) -> ScoreError:
        place = f"{self.source}: {self.path}" if self.path else self.source
        return ScoreError(f"{place}: expected {expected}, found {found or _shown(self.value)}")

    def members(self, needed: Iterable[str], spare: Iterable[str] = ()) -> dict[str, _Node]:
        """Return an object's members, all those needed and no unknown ones."""
        members = self.options()
        needed, known = tuple(needed), (*needed, *spare)
        for key in members:
            if key not in known:
                near = difflib.get_close_matches(key, known, n=1)
                expected = f'"{near[0]}"' if near else "one of " + ", ".join(known)
                raise self.fault(f"the key {expected}", f"the unknown key {_shown(key)}")
        for key in needed:
            if key not in members:
                raise self.fault(f'the key "{key}"', "none")
        return members

    def options(self) -> dict[str, _Node]:
        """Return an object's members, whatever their keys."""
        if not isinstance(self.value, dict):
            raise self.fault("an object")
        prefix = f"{self.path}." if self.path else ""
        return {
            key: _Node(value, self.source, f"{prefix}{key}") for key, value in self.value.items()
        }

    def items(self) -> list[_Node]:
        if not isinstance(self.value, list):
            raise self.fault("a list")
        return [
            _Node(value, self.source, f"{self.path}[{i}]") for i, value in enumerate(self.value)
        ]

    def text(self) -> str:
        if not isinstance(self.value, str):
            raise self.fault("text in quotes")
        return self.value

    def name(self) -> str:
        text = self.text()
        if not text.strip():
            raise self.fault("a name")
        return text

    def number(self, low: float = -math.inf, high: float = math.inf) -> float:
        expected = "a number" if math.isinf(high) else f"a number in [{low:g}, {high:g}]"
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise self.fault(expected)
        try:
            number = float(self.value)
        except OverflowError:
            raise self.fault("a finite number") from None
        if not math.isfinite(number):
            raise self.fault("a finite number")
        if not low <= number <= high:
            raise self.fault(expected)
        return number


def _effort(node: _Node) -> Effort:
    members = node.members((), AXES)
    return Effort(**{axis: value.number(-1.0, 1.0) for axis, value in members.items()})


def _alternative(node: _Node) -> Alternative:
    members = node.members(("action", "distance"))
    return Alternative(members["action"].name(), members["distance"].number())


def _phrase(node: _Node, earliest_s: float) -> Phrase:
    """Read a phrase that may not start before ``earliest_s``."""
    members = node.members(("action", "start_s", "end_s"), ("effort", "confidence", "alternatives"))
    start_s, end_s = members["start_s"].number(), members["end_s"].number()
    if start_s < earliest_s:
        raise members["start_s"].fault(f"{earliest_s:g} or later, the end of the phrase before")
    if end_s <= start_s:
        raise members["end_s"].fault(f"more than {start_s:g}, its start_s")
    values: dict[str, Any] = {}
    if "effort" in members:
        values["effort"] = _effort(members["effort"])
    if "confidence" in members:
        values["confidence"] = members["confidence"].number(0.0, 1.0)
    if "alternatives" in members:
        values["alternatives"] = tuple(_alternative(n) for n in members["alternatives"].items())
    return Phrase(members["action"].name(), start_s, end_s, **values)


def _part(node: _Node) -> Part:
    members = node.members(("device", "phrases"), ("library",))
    phrases: list[Phrase] = []
    for item in members["phrases"].items():
        phrases.append(_phrase(item, phrases[-1].end_s if phrases else -math.inf))
    library = members["library"].text() if "library" in members else ""
    return Part(members["device"].name(), tuple(phrases), library)


def _performers(node: _Node) -> tuple[Part, ...]:
    parts: dict[str, Part] = {}
    for item in node.items():
        part = _part(item)
        if part.device in parts:
            raise item.fault("each device once", f"the device {_shown(part.device)} again")
        parts[part.device] = part
    return tuple(parts.values())


def _check_schema(node: _Node) -> None:
    """Refuse what is not a Score, or one of a version that this release cannot know."""
    if not isinstance(node.value, dict):
        raise node.fault("an object")
    schema, version = node.value.get("schema"), node.value.get("version")
    if schema != SCHEMA:
        found = _shown(schema) if "schema" in node.value else "none"
        raise node.fault(f'the schema "{SCHEMA}"', found)
    place = _Node(version, node.source, "version")
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise place.fault(f"the number {VERSION}", None if "version" in node.value else "none")
    if version > VERSION:
        raise place.fault(f"{VERSION}, the newest this release reads", f"the newer {version}")


def _score(node: _Node) -> Score:
    _check_schema(node)
    members = node.members(
        ("schema", "version", "performers"),
        ("recording", "library", "figure_height_m", "reading", "warnings"),
    )
    values: dict[str, Any] = {
        key: members[key].text() for key in ("recording", "library") if key in members
    }
    if "figure_height_m" in members:
        values["figure_height_m"] = members["figure_height_m"].number()
        if values["figure_height_m"] <= 0:
            raise members["figure_height_m"].fault("a positive number")
    if "reading" in members:
        options = members["reading"].options()
        values["reading"] = tuple((key, option.text()) for key, option in options.items())
    if "warnings" in members:
        values["warnings"] = tuple(item.text() for item in members["warnings"].items())
    return Score(_performers(members["performers"]), **values)
