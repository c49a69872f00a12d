"""Recorder: appends samples to a recording file as they come, so that nothing is lost.

Each frame is one write of whole rows, handed to the operating system at once: rows survive if the
program is killed. Twenty times a second a separate thread flushes the file to the disk, so a power
cut costs little more than that. The file is a native CSV from its first row on; its metadata says
that it grows row by row (`smd.formats.native.GROWS`), so that a reader ignores an incomplete last
row.
"""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType

from smd.capture.source import Pose, Row
from smd.errors import CaptureError
from smd.formats.native import COLUMNS, GROWS, SCHEMA, VERSION, device_cell

SYNC_S = 0.05
"""Interval at which the file is flushed to the disk."""


_POSE = "{:.6f},{:.6f},{:.6f},{:.7f},{:.7f},{:.7f},{:.7f}"  # micrometres: finer than any tracker
_LOST = "nan,nan,nan,nan,nan,nan,nan"


class Recorder:
    """A recording that grows.

    Parameters
    ----------
    path
        A ``.csv`` in a folder that exists.
    devices
        The name in each device's rows, by serial.
    force
        Overwrite an existing file.

    Raises
    ------
    CaptureError
        If the file exists, or cannot be created.
    RecordingError
        If a name cannot stand in a recording.
    """

    def __init__(self, path: Path, devices: Mapping[str, str], *, force: bool = False) -> None:
        self.path = path
        self._cells = {serial: device_cell(name) for serial, name in devices.items()}
        self._fd = _new_file(path, force=force)
        self._size = 0
        self._zero_s: float | None = None
        self._failed: OSError | None = None
        self.last_s = 0.0  # of the last row
        head = [f"# schema: {SCHEMA}", f"# version: {VERSION}", f"# {GROWS}: yes"]
        head += [f"# {name}: {serial}" for serial, name in devices.items() if name != serial]
        self._over = threading.Event()
        self._syncing = threading.Thread(target=self._sync, daemon=True)
        try:
            self._append("\n".join([*head, ",".join(COLUMNS), ""]))
            _sync_folder(path.parent)
        except BaseException:
            os.close(self._fd)
            raise
        self._syncing.start()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def write(self, time_s: float, rows: Mapping[str, Row]) -> None:
        """Append the rows of one frame, by serial.

        Raises
        ------
        CaptureError
            If the disk is full or gone; what was written stays good.
        """
        if self._zero_s is None:
            self._zero_s = time_s
        self.last_s = time_s - self._zero_s
        self._append("".join(self._row(serial, *row) for serial, row in rows.items()))

    def close(self) -> None:
        """Flush the file to the disk, and close it."""
        if self._over.is_set():
            return
        self._over.set()
        self._syncing.join()
        try:
            os.fsync(self._fd)
        except OSError as error:
            raise self._error(error) from error
        finally:
            os.close(self._fd)

    def _row(self, serial: str, pose: Pose | None, drawing: bool | None) -> str:
        """Return the row of one device at the time of the last row."""
        numbers = _LOST if pose is None else _POSE.format(*pose)
        mark = "" if drawing is None else int(drawing)
        return f"{self.last_s:.6f},{self._cells[serial]},{numbers},{mark}\n"

    def _append(self, text: str) -> None:
        """Write all of a text, or none of it."""
        if self._failed:
            raise self._error(self._failed) from self._failed
        rest = text.encode()
        size = self._size + len(rest)
        try:
            while rest:
                rest = rest[os.write(self._fd, rest) :]
        except OSError as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self._fd, self._size)
            raise self._error(error) from error
        self._size = size

    def _sync(self) -> None:
        """Flush the file to the disk, periodically; a failure is raised at the next row."""
        while not self._over.wait(SYNC_S):
            try:
                os.fsync(self._fd)
            except OSError as error:
                self._failed = error
                return

    def _error(self, error: OSError) -> CaptureError:
        return CaptureError(
            f"{self.path}: cannot be written any more: {error.strerror}; "
            f"the {self.last_s:.1f} s until then are in it: free the disk, and record again"
        )


def _new_file(path: Path, *, force: bool) -> int:
    """Open a new file for appending, or raise CaptureError with what to do."""
    if path.suffix.lower() != ".csv":
        raise CaptureError(f"{path}: expected a file name that ends in .csv")
    flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | getattr(os, "O_BINARY", 0)
    try:
        return os.open(path, flags | (os.O_TRUNC if force else os.O_EXCL), 0o666)
    except FileExistsError as error:
        raise CaptureError(
            f"{path}: is there already: choose another name, or write over it with --force"
        ) from error
    except OSError as error:
        if not path.parent.is_dir():
            raise CaptureError(
                f"{path}: expected an existing folder {path.parent}: make it, and try again"
            ) from error
        raise CaptureError(f"{path}: cannot be written: {error.strerror}") from error


def _sync_folder(folder: Path) -> None:
    """Flush a new file's name to the disk, if the system lets a folder be opened."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
