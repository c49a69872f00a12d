"""Opening a source by its name on the command line."""

from __future__ import annotations

import gc
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from smd.capture.replay import ReplaySource
from smd.capture.source import Source
from smd.errors import CaptureError
from smd.formats import SUFFIXES, SourceFrame

OPENVR, REPLAY = "openvr", "replay:"


@contextmanager
def open_source(name: str, rate_hz: float, frame: SourceFrame | None = None) -> Iterator[Source]:
    """Yield a source, and close it afterwards.

    Parameters
    ----------
    name
        ``openvr``; ``replay:FILE``; ``replay:FOLDER`` for its recordings one after another; or
        ``replay:-`` for one on standard input.
    rate_hz
        Frames a second, of a source that is polled.
    frame
        How recordings are to be read.

    Raises
    ------
    CaptureError
        If there is no such source, or it cannot be opened.
    RecordingError
        If a recording cannot be read.
    """
    source = _source(name, rate_hz, frame)
    gc.collect()
    gc.freeze()  # a pass over all loaded objects would stop every thread for some 20 ms
    try:
        yield source
    finally:
        gc.unfreeze()
        source.close()


def _source(name: str, rate_hz: float, frame: SourceFrame | None) -> Source:
    if name == OPENVR:
        from smd.capture.openvr import OpenVRSource

        return OpenVRSource(rate_hz)
    if not name.startswith(REPLAY) or name == REPLAY:
        raise CaptureError(f"source: expected {OPENVR} or {REPLAY}FILE, got {name!r}")
    place = name.removeprefix(REPLAY)
    if place == "-":
        return _from_standard_input(frame)
    path = Path(place)
    if not path.is_dir():
        return ReplaySource([path], frame)
    files = sorted(each for each in path.iterdir() if each.suffix.lower() in SUFFIXES)
    if not files:
        raise CaptureError(f"{path}: expected recordings in this folder, found none")
    return ReplaySource(files, frame)


def _from_standard_input(frame: SourceFrame | None) -> Source:
    """Return a recording from standard input, by way of a file, since readers read files."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "standard-input.txt"
        path.write_bytes(sys.stdin.buffer.read())
        return ReplaySource([path], frame)
