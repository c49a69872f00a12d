"""A performance as one picture: a row per phrase, eight moments a row, drawn without a screen.

The file is read back with USD's own skinning and drawn by VTK in a process of its own: where a
machine has nothing to draw with, VTK may end the process, and only that one.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from smd.errors import ExportError
from smd.files import replacing

ROWS = 16
"""Most rows of one filmstrip; a longer performance shows its first ones and says so."""

REFUSED = 3
"""Exit code of the drawing process when it printed what is wrong."""

_TIMEOUT_S = 600.0


def write_filmstrip(usd_path: Path | str, png_path: Path | str, *, rows: int = ROWS) -> None:
    """Draw a USD file's skinned characters as a filmstrip.

    Rows are the phrases of the Score that the file carries, in time order; without a Score, or
    with an empty one, they are time windows. A row has one camera, fitted to where the body
    goes.

    Parameters
    ----------
    usd_path
        Any USD file with skinned characters.
    png_path
        The picture.
    rows
        Most rows to draw, at least 1.

    Raises
    ------
    ExportError
        If the file holds no character, the picture cannot be written, or this machine cannot
        render; the message has the reason.
    """
    png_path = Path(png_path)
    if rows < 1:
        raise ExportError(f"rows: expected at least 1, got {rows}")
    if png_path.suffix.lower() != ".png":
        raise ExportError(
            f"{png_path}: expected a suffix of .png, found {png_path.suffix or 'none'}"
        )
    with replacing(png_path) as temporary:
        _draw_elsewhere(Path(usd_path), temporary, png_path, rows)


def _draw_elsewhere(usd_path: Path, temporary: Path, png_path: Path, rows: int) -> None:
    """Draw into ``temporary`` in a process of its own; errors name ``png_path``."""
    # -P: whatever lies in the working folder is not ours to run.
    command = [sys.executable, "-P", "-m", "exporters.strip", str(usd_path), str(temporary)]
    paths = os.pathsep.join(path or str(Path.cwd()) for path in sys.path)
    try:
        result = subprocess.run(
            [*command, str(rows)],
            env={**os.environ, "PYTHONPATH": paths},
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_TIMEOUT_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ExportError(f"{png_path}: the renderer did not run: {error}") from error
    if result.returncode == 0:
        return
    reason = _reason(result.stderr)
    if result.returncode == REFUSED:
        raise ExportError(reason)
    raise ExportError(
        f"{png_path}: this machine cannot render: the renderer ended with code "
        f"{result.returncode}: {reason}"
    )


def _reason(stderr: str) -> str:
    """Return the last line that a process printed, without VTK's colours and log columns."""
    lines = re.sub(r"\x1b\[[0-9;]*m", "", stderr).strip().splitlines()
    return lines[-1].rsplit("| ", 1)[-1] if lines else "no reason given"
