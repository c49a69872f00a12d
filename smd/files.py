"""Writing files so that nothing is ever left half-written."""

from __future__ import annotations

import filecmp
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from smd.errors import ExportError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path`` (same suffix) that replaces it on success.

    Raises
    ------
    ExportError
        If the folder does not exist or cannot be written, or ``path`` is a folder.
    """
    path = Path(path)
    if path.is_dir():
        raise ExportError(f"{path}: expected a file to write, found a folder")
    if not path.parent.is_dir():
        raise ExportError(f"{path}: expected an existing folder {path.parent}, found none")
    try:
        handle, name = tempfile.mkstemp(
            prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent
        )
        os.close(handle)
    except OSError as error:
        raise ExportError(
            f"{path}: expected a folder that can be written, got: {error.strerror}"
        ) from error
    temporary = Path(name)
    try:
        with _blaming(path):
            yield temporary
            mode = path.stat().st_mode if path.exists() else 0o666 & ~_umask()
            temporary.chmod(mode)
            temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_together(writers: Mapping[Path, Callable[[Path], None]]) -> None:
    """Write several files, all of them or none.

    Parameters
    ----------
    writers
        What writes each file, called with a temporary path of the same folder and suffix. The
        files appear in this order: let what refers to others come last.

    Raises
    ------
    ExportError
        If any of them cannot be written; files that were there before are unchanged.
    """
    with tempfile.TemporaryDirectory() as safe, ExitStack() as undone:
        for index, path in enumerate(writers):
            with _blaming(path):
                if path.is_file():
                    kept = Path(shutil.copy2(path, Path(safe) / str(index)))
                    undone.callback(_put_back, kept, path)
                elif not path.exists():
                    undone.callback(path.unlink, missing_ok=True)
        with ExitStack() as replaced:
            # The last one entered is the first to be renamed.
            for path, write in reversed(list(writers.items())):
                temporary = replaced.enter_context(replacing(path))
                with _blaming(path):
                    write(temporary)
        undone.pop_all()


@contextmanager
def _blaming(path: Path) -> Iterator[None]:
    """Say of an OSError which file could not be written."""
    try:
        yield
    except OSError as error:
        raise ExportError(f"{path}: cannot be written: {error.strerror or error}") from error


def _put_back(kept: Path, path: Path) -> None:
    """Restore a file, unless it is untouched."""
    if not filecmp.cmp(kept, path, shallow=False):
        shutil.copy2(kept, path)


def _umask() -> int:
    """Return the process's file mode mask (reading it means setting it for a moment)."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
