"""A folder of numbered takes: their names, and the files of each."""

from __future__ import annotations

import re
from pathlib import Path

from smd.errors import CaptureError


class Shelf:
    """Files in a folder that are named by a stem and a number, such as ``story-001.csv``.

    Parameters
    ----------
    folder
        Created if it is missing and its parent exists.
    stem
        Beginning of the takes' names.

    Raises
    ------
    CaptureError
        If the folder cannot be made.
    """

    def __init__(self, folder: Path, stem: str) -> None:
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise CaptureError(
                f"{folder}: expected a folder, or a place to make one: {error.strerror}"
            ) from error
        self._folder, self._stem = folder, stem
        numbers = [self._number(path) for path in folder.iterdir()]
        self._last = max(numbers, default=0)

    def next(self) -> Path:
        """Return the next take's path, without a suffix; no file there has this name."""
        self._last += 1
        return self._folder / f"{self._stem}-{self._last:03d}"

    def discard(self, take: Path) -> None:
        """Remove all files of a take."""
        for path in self._folder.glob(f"{take.name}.*"):
            path.unlink()

    def _number(self, path: Path) -> int:
        found = re.match(re.escape(self._stem) + r"-(\d+)\.", path.name)
        return int(found[1]) if found else 0
