"""Performances as files: one module per output format."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from smd.errors import ExportError

if TYPE_CHECKING:
    from smd.transfer.performance import Performance

SUFFIXES = (".usda", ".usdc", ".usdz")
"""Of the files that `write` makes."""


def write(performance: Performance, path: Path | str) -> None:
    """Write a performance in the format that the file's suffix names.

    Raises
    ------
    ExportError
        If the suffix is none of `SUFFIXES`, or the file cannot be written.
    """
    path = Path(path)
    require_known_suffix(path)
    from exporters.usd import write_usd

    write_usd(performance, path)


def require_known_suffix(path: Path) -> None:
    """Raise ExportError unless the file's suffix is one of `SUFFIXES`."""
    if path.suffix.lower() not in SUFFIXES:
        raise ExportError(f"{path}: expected a suffix of {', '.join(SUFFIXES)}")
