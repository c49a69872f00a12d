"""Faults: errors in a file, raised where they are found and given the file's name at the door.

Code that reads a line, a row or a node knows the place and what it expected there, and raises a
`Fault`. Only the door, the public function that was asked to read the file, knows its name: it is
`naming` the file, in its own subsystem's error. No function between them passes the name along.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

_Error = TypeVar("_Error", bound=Exception)


class Fault(Exception):  # noqa: N818 -- not the error: that names the file
    """An error in a file whose name is not known here; a door turns it into the user's error.

    Attributes
    ----------
    place : where in the file (a line, a key, a prim); empty for the whole of it.
    what : what was expected there and what was found, on one line.
    """

    def __init__(self, place: str, expected: str, found: object) -> None:
        self.place = place
        self.what = printable(f"expected {expected}, found {found}")
        super().__init__(place, expected, found)

    @classmethod
    def saying(cls, place: str, what: str) -> Fault:
        """Return a fault with a message that was worded already, by code that knows no file."""
        fault = cls(place, "", "")
        fault.what = printable(what)
        return fault

    def __str__(self) -> str:
        return f"{self.place}: {self.what}" if self.place else self.what

    def of(self, file: Path | str, error: type[_Error], joint: str = ": ") -> _Error:
        """Return the user's error: file, place, expected, found.

        Parameters
        ----------
        file
            As the user named it.
        error
            Type of the error.
        joint
            Text between file and place.
        """
        where = f"{file}{joint}{self.place}" if self.place else f"{file}"
        return error(f"{where}: {self.what}")


@contextmanager
def naming(file: Path | str, error: type[Exception], joint: str = ": ") -> Iterator[None]:
    """Turn a fault raised within into an error that names the file, as `Fault.of` does."""
    try:
        yield
    except Fault as fault:
        raise fault.of(file, error, joint) from fault.__cause__


def printable(text: str) -> str:
    """Return text on one line, with underscores for characters that cannot be printed."""
    return "".join(c if c.isprintable() else "_" for c in text)
