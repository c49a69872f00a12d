"""The files of a command: the recordings that were named, and what stands beside them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from smd.score import Score

Recordings = Annotated[
    list[Path],
    typer.Argument(metavar="RECORDING…", help="Recording files, or folders of them."),
]

SCORE_SUFFIX = ".score.json"
"""Of the Scores that stand beside their recordings."""

PHRASES_SUFFIX = ".phrases.csv"
"""Of the tables of phrases that stand beside animations, often in the recordings' folder."""


def recording_files(paths: Iterable[Path]) -> Iterator[Path]:
    """Yield files as they are and the recordings inside folders, sorted by name.

    Scores and tables of phrases that stand beside their recordings are passed over.

    Raises
    ------
    RecordingError
        If a folder holds no recording.
    """
    from smd.errors import RecordingError
    from smd.formats import SUFFIXES

    for path in paths:
        if not path.is_dir():
            yield path
            continue
        inside = sorted(
            file
            for file in path.iterdir()
            if file.suffix.lower() in SUFFIXES
            and not file.name.endswith((SCORE_SUFFIX, PHRASES_SUFFIX))
            and file.is_file()
        )
        if not inside:
            raise RecordingError(
                f"{path}: expected recordings ({' '.join(sorted(SUFFIXES))}) in this folder, "
                "found none"
            )
        yield from inside


def beside(score: Score, score_file: Path) -> Score:
    """Return the Score with its recording and library named as seen from the Score's folder."""
    folder = score_file.resolve().parent
    return replace(
        score,
        recording=_seen_from(folder, score.recording),
        library=_library_from(folder, score.library),
        performers=tuple(
            replace(part, library=_library_from(folder, part.library)) for part in score.performers
        ),
    )


def _library_from(folder: Path, name: str) -> str:
    """Return how a library is named as seen from a folder; one that is shipped, by its name."""
    from actions_library.folder import names_shipped

    return name if not name or names_shipped(name) else _seen_from(folder, name)


def _seen_from(folder: Path, name: str) -> str:
    """Return a path relative to a folder, or whole where it is on another drive."""
    path = Path(name).resolve()
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return path.as_posix()
