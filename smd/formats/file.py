"""A recording's file: its bytes or its text, or one line that says why there is none."""

from __future__ import annotations

import codecs
from functools import cached_property
from pathlib import Path

from laban.faults import Fault


class RecordingFile:
    """A regular file that is there; what is in it is read when a format asks for it.

    Attributes
    ----------
    path : for what opens files itself, as USD does.

    Raises
    ------
    Fault
        If there is nothing, a folder, or a device.
    """

    def __init__(self, path: Path) -> None:
        try:
            if path.is_dir():
                raise Fault("", "a recording", "a folder")
            if not path.exists():
                raise Fault("", "a recording", "no such file")
        except OSError as error:  # a name too long, a folder that may not be entered
            raise Fault("", "a file that can be read", str(error.strerror)) from error
        if not path.is_file():
            raise Fault("", "a recording", "no regular file")
        self.path = path

    @property
    def suffix(self) -> str:
        """In lower case, with its dot."""
        return self.path.suffix.lower()

    def read_bytes(self) -> bytes:
        """Return its content.

        Raises
        ------
        Fault
            If it cannot be read.
        """
        try:
            return self.path.read_bytes()
        except OSError as error:
            raise Fault("", "a file that can be read", str(error.strerror)) from error

    @cached_property
    def text(self) -> str:
        r"""Its text in UTF-8, line ends as ``\n`` and a byte order mark left out.

        Raises
        ------
        Fault
            If it cannot be read, or is not UTF-8 text.
        """
        data = self.read_bytes()
        if _is_utf16(data):
            raise Fault("", "text in UTF-8", "UTF-16; save it again as UTF-8")
        data = data.rstrip(b"\0")  # what a power cut may leave at the end of a file that grew
        if b"\0" in data:
            raise Fault("", "text", "binary data")
        try:
            text = data.removeprefix(codecs.BOM_UTF8).decode("utf-8")
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            found = f"byte 0x{data[error.start]:02x}; save it again as UTF-8"
            raise Fault(f"line {line}", "text in UTF-8", found) from None
        return text.replace("\r\n", "\n").replace("\r", "\n")


def _is_utf16(data: bytes) -> bool:
    """Return whether data starts with UTF-16's mark, or every other byte of plain text is zero."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return True
    start = data[:200]
    zeros = max(start[0::2].count(0), start[1::2].count(0))
    return len(start) > 1 and start.count(0) == zeros > 0.8 * (len(start) // 2)
