"""What is wrong with a file: said where it is found, named at the door.

Whoever reads a line, a row or a node knows the place and what belongs there, and raises a `Fault`.
Which file that is only the door knows, the public function that was asked to read it: it is
`naming` the file, in its own subsystem's error. Nothing between them carries the file's name.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

_Error = TypeVar("_Error", bound=Exception)


class Fault(Exception):  # noqa: N818 -- not the error: that names the file
    """Something wrong in a file whose name is not known here; a door makes it the user's error.

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
        """Return the fault that somebody who knows of no file has put into words already."""
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
            Which one it is.
        joint
            Between file and place.
        """
        where = f"{file}{joint}{self.place}" if self.place else f"{file}"
        return error(f"{where}: {self.what}")


@contextmanager
def naming(file: Path | str, error: type[Exception], joint: str = ": ") -> Iterator[None]:
    """Turn a fault that is found within into an error that names the file, as `Fault.of` does."""
    try:
        yield
    except Fault as fault:
        raise fault.of(file, error, joint) from fault.__cause__


def printable(text: str) -> str:
    """Return text on one line, what cannot be shown as underscores."""
    return "".join(c if c.isprintable() else "_" for c in text)
