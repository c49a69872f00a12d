"""The options that say how a recording is to be read, shared by the commands that read one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from smd.doodle import Recording

Mount = Annotated[
    str | None,
    typer.Option(
        help="How the tracker sits on the prop, in degrees and metres, e.g. 'yaw=180,y=-0.05'."
    ),
]


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """How the user said that recordings are to be read; None: as the format says."""

    up: Annotated[
        str | None, typer.Option(help="The world's up axis in the file: x, y, z, -x, -y or -z.")
    ] = None
    front: Annotated[
        str | None, typer.Option(help="The prop's front axis in the file: x, y, z, -x, -y or -z.")
    ] = None
    handedness: Annotated[
        str | None, typer.Option(help="right or left; Unity and Unreal write left-handed files.")
    ] = None
    unit: Annotated[
        str | None, typer.Option(help="Unit of length in the file: m, cm, mm, in or ft.")
    ] = None
    quaternion: Annotated[str | None, typer.Option(help="Order of quaternions: xyzw or wxyz.")] = (
        None
    )
    mount: Mount = None

    @classmethod
    def from_pairs(cls, pairs: Iterable[tuple[str, str]]) -> ReadingOptions:
        """Return the options that a Score kept, or raise ScoreError naming the unknown one."""
        from smd.errors import ScoreError

        options = dict(pairs)
        for name in options:
            if name not in cls.__slots__:
                raise ScoreError(
                    f"reading: expected some of {', '.join(cls.__slots__)}, got {name!r}"
                )
        return cls(**options)

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """The options that were given, by name, as a Score keeps them."""
        named = ((name, getattr(self, name)) for name in self.__slots__)
        return tuple((name, value) for name, value in named if value is not None)

    def read(self, path: Path) -> Recording:
        """Read one recording file."""
        from smd.formats import SourceFrame, read_recording

        return read_recording(path, SourceFrame.from_options(**dict(self.pairs)))
