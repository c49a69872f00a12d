"""The Score's file: JSON that a person can read and correct (docs/score.md)."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from laban.effort import AXES, Effort
from laban.faults import naming
from laban.json_node import Node, parse_json, read_json, shown
from smd.errors import ScoreError
from smd.files import replacing
from smd.score import INTENTS, Alternative, Part, Phrase, Score, Suggestion

SCHEMA = "smd.score"
VERSION = 2

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
    """Return a performer, its phrases a line each, and its suggestions alike."""
    times_s = _phrase_times_s(part)
    phrases = [
        _phrase_json(phrase, *both) for phrase, both in zip(part.phrases, times_s, strict=True)
    ]
    suggestions = list(_suggestions_json(part, times_s))
    named = [("library", part.library), ("intent", part.intent)]
    said = "".join(f'"{key}": {_json(value)}, ' for key, value in named if value)
    last = f', "suggestions": {_lines_json(suggestions)}' if suggestions else ""
    return f'    {{"device": {_json(part.device)}, {said}"phrases": {_lines_json(phrases)}{last}}}'


def _lines_json(lines: Sequence[str]) -> str:
    """Return a list of JSON with an item a line."""
    return "[\n      " + ",\n      ".join(lines) + "\n    ]" if lines else "[]"


def _phrase_times_s(part: Part) -> list[tuple[float, float]]:
    """Return when phrases start and end, as the file says it."""
    times_s: list[tuple[float, float]] = []
    for phrase in part.phrases:
        # Neighbours may overlap by rounding alone: `Part` allows a nanosecond.
        start_s = max(_rounded(phrase.start_s), times_s[-1][1] if times_s else -math.inf)
        times_s.append((start_s, _rounded(phrase.end_s)))
        if times_s[-1][1] <= start_s:
            raise ScoreError(
                f"device {part.device!r}: phrase {phrase.action!r} at {phrase.start_s:g} s: "
                f"expected to last at least 0.001 s, got {phrase.end_s - phrase.start_s:g} s"
            )
    return times_s


def _suggestions_json(part: Part, times_s: Sequence[tuple[float, float]]) -> Iterator[str]:
    """Yield suggestions, one line each: in place of a phrase's, it is a phrase.

    One of which rounding leaves nothing is left out.
    """
    real = [both for phrase, both in zip(part.phrases, times_s, strict=True) if not phrase.implied]
    from_s = -math.inf
    for one in part.suggestions:
        middle_s = 0.5 * (one.start_s + one.end_s)
        start_s = max([_rounded(one.start_s), from_s, *(end for _, end in real if end < middle_s)])
        end_s = min([_rounded(one.end_s), *(start for start, _ in real if start > middle_s)])
        from_s = max(from_s, end_s)
        if end_s > start_s:
            yield (
                f'{{"action": {_json(one.action)}, "start_s": {start_s:.3f}, '
                f'"end_s": {end_s:.3f}, "alternatives": {_alternatives_json(one.likeliest)}}}'
            )


def _phrase_json(phrase: Phrase, start_s: float, end_s: float) -> str:
    effort = {
        axis: _rounded(value)
        for axis in AXES
        if (value := getattr(phrase.effort, axis)) is not None
    }
    implied = ', "implied": true' if phrase.implied else ""
    return (
        f'{{"action": {_json(phrase.action)}, "start_s": {start_s:.3f}, "end_s": {end_s:.3f}, '
        f'"effort": {_json(effort)}, "confidence": {_json(_rounded(phrase.confidence))}, '
        f'"alternatives": {_alternatives_json(phrase.alternatives)}{implied}}}'
    )


def _alternatives_json(alternatives: Iterable[Alternative]) -> str:
    items = []
    for other in alternatives:
        item: dict[str, Any] = {"action": other.action, "distance": _rounded(other.distance)}
        if other.most is not None:
            item["most"] = _rounded(other.most)
        if other.reason:
            item["reason"] = other.reason
        items.append(item)
    return _json(items)


# ---------------------------------------------------------------------------- reading


def read_score(path: Path | str) -> Score:
    """Read a Score's JSON file.

    Raises
    ------
    ScoreError
        If there is no such file or it is not a Score; one line names the file, the key, what
        was expected and what was found.
    """
    with naming(path, ScoreError):
        return _score(read_json(Path(path), "a Score file", keys_once=True))


def score_from_json(text: str, source: str = "score") -> Score:
    """Read a Score from JSON text.

    What a person would leave out may be missing: ``recording``, ``library``,
    ``figure_height_m``, ``reading``, ``warnings``, a performer's ``library``, ``intent`` and
    ``suggestions``, and a phrase's ``effort``, ``confidence``, ``alternatives`` and ``implied``.
    Keys that are not known are refused, so that a slip of the pen does not pass for silence.
    Phrases may stand in any order: a suggestion becomes one wherever it is moved to, and an
    implied phrase gives way to it.

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
    with naming(source, ScoreError):
        return _score(parse_json(text, keys_once=True))


def _effort(node: Node) -> Effort:
    members = node.members((), AXES)
    return Effort(**{axis: value.number(-1.0, 1.0) for axis, value in members.items()})


def _alternative(node: Node) -> Alternative:
    members = node.members(("action", "distance"), ("most", "reason"))
    return Alternative(
        members["action"].name(),
        members["distance"].number(),
        members["most"].number() if "most" in members else None,
        members["reason"].text() if "reason" in members else "",
    )


def _alternatives(members: dict[str, Node]) -> tuple[Alternative, ...]:
    items = members["alternatives"].items() if "alternatives" in members else []
    return tuple(_alternative(item) for item in items)


def _phrase(node: Node) -> Phrase:
    members = node.members(
        ("action", "start_s", "end_s"), ("effort", "confidence", "alternatives", "implied")
    )
    start_s, end_s = _times_s(members)
    values: dict[str, Any] = {}
    if "effort" in members:
        values["effort"] = _effort(members["effort"])
    if "confidence" in members:
        values["confidence"] = members["confidence"].number(0.0, 1.0)
    if "implied" in members:
        values["implied"] = members["implied"].truth()
    alternatives = _alternatives(members)
    return Phrase(members["action"].name(), start_s, end_s, alternatives=alternatives, **values)


def _suggestion(node: Node) -> Suggestion:
    members = node.members(("action", "start_s", "end_s"), ("alternatives",))
    start_s, end_s = _times_s(members)
    action, others = members["action"].name(), _alternatives(members)
    own = [other for other in others if other.action == action][:1]
    if not own:
        raise members["action"].fault("one of its alternatives")
    return Suggestion(start_s, end_s, (*own, *(other for other in others if other is not own[0])))


def _times_s(members: dict[str, Node]) -> tuple[float, float]:
    start_s, end_s = members["start_s"].number(), members["end_s"].number()
    if end_s <= start_s:
        raise members["end_s"].fault(f"more than {start_s:g}, its start_s")
    return start_s, end_s


def _phrases(node: Node) -> tuple[Phrase, ...]:
    """Read phrases in any order into time order, the implied ones where no other is."""
    found = [(_phrase(item), item) for item in node.items()]
    real = _in_order([each for each in found if not each[0].implied], "the phrase before")
    implied = _in_order([each for each in found if each[0].implied], "the phrase before")
    left = [piece for phrase in implied for piece in _outside(phrase, real)]
    return tuple(sorted([*real, *left], key=lambda phrase: phrase.start_s))


_Timed = TypeVar("_Timed", Phrase, Suggestion)


def _in_order(found: list[tuple[_Timed, Node]], before: str) -> list[_Timed]:
    """Return what was read in time order, or refuse what starts within what is before it."""
    found = sorted(found, key=lambda each: each[0].start_s)
    for (earlier, _), (later, node) in pairwise(found):
        if later.start_s < earlier.end_s:
            raise node.options()["start_s"].fault(
                f"{earlier.end_s:g} or later, the end of {before}"
            )
    return [one for one, _ in found]


def _outside(implied: Phrase, real: Sequence[Phrase]) -> Iterator[Phrase]:
    """Yield what is left of an implied phrase beside others."""
    start_s = implied.start_s
    for phrase in real:
        if phrase.end_s > start_s and phrase.start_s < implied.end_s:
            if phrase.start_s > start_s:
                yield replace(implied, start_s=start_s, end_s=phrase.start_s)
            start_s = phrase.end_s
    if start_s < implied.end_s:
        yield replace(implied, start_s=start_s)


def _suggestions(node: Node, phrases: Sequence[Phrase]) -> tuple[Suggestion, ...]:
    """Read suggestions in time order; those that were accepted are to be gone."""
    found = [(_suggestion(item), item) for item in node.items()]
    for one, item in found:
        for phrase in phrases:
            overlaps = phrase.start_s < one.end_s and phrase.end_s > one.start_s
            if overlaps and not phrase.implied:
                raise item.fault(
                    "movement that no phrase explains: move a suggestion over, do not copy it",
                    f"{one.start_s:g} to {one.end_s:g} s, which is in the phrase "
                    f"{shown(phrase.action)} at {phrase.start_s:g} s",
                )
    return tuple(_in_order(found, "the suggestion before"))


def _part(node: Node) -> Part:
    members = node.members(("device", "phrases"), ("library", "intent", "suggestions"))
    phrases = _phrases(members["phrases"])
    library = members["library"].text() if "library" in members else ""
    intent = members["intent"].one_of(INTENTS) if "intent" in members else ""
    suggestions: tuple[Suggestion, ...] = ()
    if "suggestions" in members:
        suggestions = _suggestions(members["suggestions"], phrases)
    return Part(members["device"].name(), phrases, library, intent, suggestions)


def _performers(node: Node) -> tuple[Part, ...]:
    parts: dict[str, Part] = {}
    for item in node.items():
        part = _part(item)
        if part.device in parts:
            raise item.fault("each device once", f"the device {shown(part.device)} again")
        parts[part.device] = part
    return tuple(parts.values())


def _check_schema(node: Node) -> None:
    """Refuse what is not a Score, or one of a version that this release cannot know."""
    if not isinstance(node.value, dict):
        raise node.fault("an object")
    schema, version = node.value.get("schema"), node.value.get("version")
    if schema != SCHEMA:
        found = shown(schema) if "schema" in node.value else "none"
        raise node.fault(f'the schema "{SCHEMA}"', found)
    place = Node(version, "version")
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise place.fault(f"the number {VERSION}", None if "version" in node.value else "none")
    if version > VERSION:
        raise place.fault(f"{VERSION}, the newest this release reads", f"the newer {version}")


def _from_version_1(value: dict[str, Any]) -> dict[str, Any]:
    """Return a Score of version 2: what it has more may be left out."""
    return {**value, "version": 2}


_UPGRADES = {1: _from_version_1}
"""From each version before this one to the next."""


def _score(node: Node) -> Score:
    _check_schema(node)
    while node.value["version"] < VERSION:
        node = replace(node, value=_UPGRADES[node.value["version"]](node.value))
    members = node.members(
        ("schema", "version", "performers"),
        ("recording", "library", "figure_height_m", "reading", "warnings"),
    )
    values: dict[str, Any] = {
        key: members[key].text() for key in ("recording", "library") if key in members
    }
    if "figure_height_m" in members:
        values["figure_height_m"] = members["figure_height_m"].positive()
    if "reading" in members:
        options = members["reading"].options()
        values["reading"] = tuple((key, option.text()) for key, option in options.items())
    if "warnings" in members:
        values["warnings"] = tuple(item.text() for item in members["warnings"].items())
    return Score(_performers(members["performers"]), **values)
