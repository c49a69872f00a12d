"""One command over many files: where each result goes, and going on past a broken one."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

import typer


def targets(named: Sequence[Path], files: Sequence[Path], output: Path, suffix: str) -> list[Path]:
    """Return where the result of each of ``files`` goes.

    One file that was named itself goes to ``output``; several, or a folder's, go into the folder
    ``output``, which is made where only it is missing, under their own names with ``suffix``.

    Raises
    ------
    ExportError
        If ``output`` is a file where a folder is needed, or its parent does not exist.
    """
    from smd.errors import ExportError

    if len(files) == 1 and not named[0].is_dir() and not output.is_dir():
        return [output]
    if output.suffix and not output.is_dir():
        raise ExportError(
            f"{output}: expected a folder for the results of {len(files)} recordings, "
            "got the name of a file"
        )
    if not output.is_dir():
        try:
            output.mkdir()
        except OSError as error:
            raise ExportError(
                f"{output}: expected a folder that can be made, got: {error.strerror}"
            ) from error
    stems = Counter(file.stem for file in files)
    return [
        output / ((file.name if stems[file.stem] > 1 else file.stem) + suffix) for file in files
    ]


def for_each(files: Sequence[Path], work: Callable[[int, Path], None]) -> None:
    """Call ``work(index, file)`` for each file, showing progress on a terminal.

    With several files a broken one costs one line, not the others; the exit code is then 3.
    """
    if len(files) == 1:
        work(0, files[0])
        return
    from laban import LabanError
    from smd.errors import SmdError

    failures = []
    hidden = not sys.stderr.isatty()
    with typer.progressbar(enumerate(files), len(files), hidden=hidden, file=sys.stderr) as bar:
        for index, file in bar:
            try:
                work(index, file)
            except (SmdError, LabanError) as error:
                failures.append(str(error))
    for line in failures:
        print(f"smd: {line}", file=sys.stderr)
    if failures:
        print(f"smd: {len(failures)} of {len(files)} recordings failed", file=sys.stderr)
        raise typer.Exit(3)
