"""Performances as files: one module per output format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from smd.errors import ExportError

if TYPE_CHECKING:
    from actions_library.stage_frame import StageFrame
    from smd.acting.performance import Performance


class Writer(Protocol):
    """A function that writes a format."""

    def __call__(self, performance: Performance, path: Path) -> None:
        """Write a performance; the file is complete or absent.

        Raises
        ------
        ExportError
            If the file cannot be written.
        """


class StageWriter(Protocol):
    """A `Writer` of USD stages: own coordinates, variants, few keys."""

    def __call__(
        self,
        performance: Performance,
        path: Path,
        *,
        neutral: Performance | None = ...,
        frame: StageFrame = ...,
        keys_within_m: float | None = ...,
    ) -> None:
        """Write a performance; the options are those of `write`."""


@dataclass(frozen=True, slots=True)
class ExportFormat:
    """A kind of file that a performance can be written to.

    Attributes
    ----------
    suffixes : of its files, in lower case.
    writer : returns the function that writes them; its module is imported only then.
    stage_writer : the same, where the format knows the options of a `StageWriter`.
    """

    suffixes: tuple[str, ...]
    writer: Callable[[], Writer]
    stage_writer: Callable[[], StageWriter] | None = None


def _usd() -> StageWriter:
    from exporters.usd import write_usd

    return write_usd


FORMATS = (ExportFormat((".usda", ".usdc", ".usdz"), _usd, _usd),)
"""All output formats; a file's suffix decides which one is used."""


def write(
    performance: Performance,
    path: Path | str,
    *,
    neutral: Performance | None = None,
    frame: StageFrame | None = None,
    keys_within_m: float | None = None,
) -> None:
    """Write a performance in the format that the file's suffix names.

    Parameters
    ----------
    performance
        What to write.
    path
        Replaced as a whole once written.
    neutral
        The same Score performed without expression, written as a variant: USD alone.
    frame
        Coordinates of the USD stage, by default ours: USD alone.
    keys_within_m
        As few keys as put no point of the skin further than this from where it is at each frame, by
        default a key each frame: USD alone.

    Raises
    ------
    ExportError
        If no format has the suffix, the format lacks a given option or does not take its value, or
        the file cannot be written.
    """
    path = Path(path)
    found = _format_of(path)
    options = {"neutral": neutral, "frame": frame, "keys_within_m": keys_within_m}
    asked = [name for name, value in options.items() if value is not None]
    if not asked:
        found.writer()(performance, path)
        return
    if found.stage_writer is None:
        able = ", ".join(s for each in FORMATS if each.stage_writer for s in each.suffixes)
        raise ExportError(f"{path}: expected {able} with {asked[0]}, found {path.suffix}")
    from actions_library.stage_frame import OURS

    found.stage_writer()(
        performance, path, neutral=neutral, frame=frame or OURS, keys_within_m=keys_within_m
    )


def require_known_suffix(path: Path) -> None:
    """Raise ExportError unless the file's suffix is one of `FORMATS`."""
    _format_of(path)


def _format_of(path: Path) -> ExportFormat:
    for each in FORMATS:
        if path.suffix.lower() in each.suffixes:
            return each
    known = ", ".join(suffix for each in FORMATS for suffix in each.suffixes)
    raise ExportError(f"{path}: expected a suffix of {known}, found {path.suffix or 'none'}")
