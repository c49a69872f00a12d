"""Performances as files: one module per output format."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from smd.errors import ExportError

if TYPE_CHECKING:
    from smd.acting.performance import Performance

WRITERS = {
    ".usda": "exporters.usd:write_usd",
    ".usdc": "exporters.usd:write_usd",
    ".usdz": "exporters.usd:write_usd",
}
"""By suffix, the function that writes such a file; its module is imported when it is needed."""


def write(performance: Performance, path: Path | str, **options: Any) -> None:
    """Write a performance in the format that the file's suffix names.

    Parameters
    ----------
    performance
        What to write.
    path
        Replaced as a whole once written.
    options
        Those of the format's function in `WRITERS`; for USD ``neutral`` and ``frame``
        (`exporters.usd.write_usd`).

    Raises
    ------
    ExportError
        If the suffix is none of `WRITERS`, or the file cannot be written.
    """
    path = Path(path)
    require_known_suffix(path)
    module, function = WRITERS[path.suffix.lower()].split(":")
    getattr(import_module(module), function)(performance, path, **options)


def require_known_suffix(path: Path) -> None:
    """Raise ExportError unless the file's suffix is one of `WRITERS`."""
    if path.suffix.lower() not in WRITERS:
        known = ", ".join(WRITERS)
        raise ExportError(f"{path}: expected a suffix of {known}, found {path.suffix or 'none'}")
