"""Cautions: what a Score asks for that a character can only do badly, a line each."""

from __future__ import annotations

from collections.abc import Iterator

from smd.score import Part
from smd.transfer.repertoire import Repertoire

FASTEST_PLAYED = 3.0
"""How many times as fast as it was made a clip may be played before it is worth a line."""


def hurried(part: Part, pieces: Repertoire) -> Iterator[str]:
    """Yield a line on each phrase that is too short for its clip.

    It is played all the same, in its time: what the Score says is done.
    """
    for phrase in part.phrases:
        piece = pieces.of(phrase)
        if piece.clip.cyclic:
            continue
        lasting_s = phrase.end_s - phrase.start_s
        if piece.clip.duration_s > FASTEST_PLAYED * lasting_s:
            yield (
                f"device {part.device!r}: {phrase.action!r} at {phrase.start_s:.2f} s lasts "
                f"{lasting_s:.2f} s: its clip, {piece.clip.duration_s:.2f} s long, is played "
                f"{piece.clip.duration_s / lasting_s:.1f} times as fast"
            )
