"""Phrases as named ranges of time: in the metadata of a USD file, and as a table beside it."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from pxr import Usd

from laban import AXES, Effort
from smd.acting.performance import Performance
from smd.errors import ExportError, SmdError
from smd.score import Phrase

PHRASES_KEY = "smd:phrases"
"""In a SkelRoot's custom data: a dictionary a phrase, by its number from ``p0000`` on."""

COLUMNS = (
    "device",
    "action",
    "start_s",
    "end_s",
    "start_frame",
    "end_frame",
    *AXES,
    "confidence",
)


def name_phrases(prim: Usd.Prim, performance: Performance, phrases: tuple[Phrase, ...]) -> None:
    """Write phrases into a prim's custom data, with their times in seconds and time codes."""
    entries = {}
    for index, phrase in enumerate(phrases):
        entry: dict[str, Any] = {
            "action": phrase.action,
            "start_s": phrase.start_s,
            "end_s": phrase.end_s,
            "start": time_code(phrase.start_s, performance),
            "end": time_code(phrase.end_s, performance),
            "confidence": phrase.confidence,
        }
        if effort := effort_read(phrase.effort):
            entry["effort"] = effort
        entries[f"p{index:04d}"] = entry
    if entries:
        prim.SetCustomDataByKey(PHRASES_KEY, entries)


def phrases_of(prim: Usd.Prim) -> tuple[Phrase, ...]:
    """Return the phrases that `name_phrases` wrote, in time order, their confidence too.

    Raises
    ------
    ExportError
        If what is there was written by somebody else.
    """
    entries = prim.GetCustomDataByKey(PHRASES_KEY) or {}
    try:
        phrases = [
            Phrase(
                str(entry["action"]),
                float(entry["start_s"]),
                float(entry["end_s"]),
                Effort(**entry.get("effort", {})),
                float(entry["confidence"]),
            )
            for entry in entries.values()
        ]
    except (AttributeError, KeyError, TypeError, ValueError, SmdError) as error:
        raise ExportError(
            f"{prim.GetPath()}: {PHRASES_KEY}: expected phrases as smd writes them, found "
            f"something else ({error})"
        ) from error
    return tuple(sorted(phrases, key=lambda phrase: phrase.start_s))


def time_code(time_s: float, performance: Performance) -> float:
    """Return a time on the recording's clock as a time code, not rounded to a frame."""
    return (time_s - performance.start_s) * performance.rate_hz


def effort_read(effort: Effort) -> dict[str, float]:
    """Return the axes of an Effort that were read, by name."""
    values = {axis: getattr(effort, axis) for axis in AXES}
    return {axis: float(value) for axis, value in values.items() if value is not None}


def write_phrase_table(performance: Performance, path: Path) -> None:
    """Write every phrase as a row of CSV, by device and time; frames are the nearest ones.

    Axes of Effort that were not read are left empty.
    """
    # No replacing: it is written together with the stage that it describes.
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        table.writeheader()
        for actor in performance.actors:
            for phrase in actor.phrases:
                effort = effort_read(phrase.effort)
                table.writerow(
                    {
                        "device": actor.name,
                        "action": phrase.action,
                        "start_s": f"{phrase.start_s:.3f}",
                        "end_s": f"{phrase.end_s:.3f}",
                        "start_frame": round(time_code(phrase.start_s, performance)),
                        "end_frame": round(time_code(phrase.end_s, performance)),
                        "confidence": f"{phrase.confidence:.3f}",
                        **{axis: f"{value:.3f}" for axis, value in effort.items()},
                    }
                )
