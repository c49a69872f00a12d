"""The options that say how a recording is to be read, shared by the commands that read one."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from actions_library.library import Library
    from smd.cast import Cast
    from smd.doodle import Doodle, Recording
    from smd.score import Score

Recordings = Annotated[
    list[Path],
    typer.Argument(metavar="RECORDING…", help="Recording files, or folders of them."),
]
Up = Annotated[
    str | None, typer.Option(help="The world's up axis in the file: x, y, z, -x, -y or -z.")
]
Front = Annotated[
    str | None, typer.Option(help="The prop's front axis in the file: x, y, z, -x, -y or -z.")
]
Handedness = Annotated[
    str | None, typer.Option(help="right or left; Unity and Unreal write left-handed files.")
]
Unit = Annotated[str | None, typer.Option(help="Unit of length in the file: m, cm, mm, in or ft.")]
Quaternion = Annotated[str | None, typer.Option(help="Order of quaternions: xyzw or wxyz.")]
Mount = Annotated[
    str | None,
    typer.Option(
        help="How the tracker sits on the prop, in degrees and metres, e.g. 'yaw=180,y=-0.05'."
    ),
]
Device = Annotated[
    list[str] | None,
    typer.Option(help="Perform this device only; may be repeated. Default: all but headsets."),
]
OneDevice = Annotated[
    str | None,
    typer.Option("--device", help="The device to read. Default: the only one but headsets."),
]
LibraryFolder = Annotated[
    Path | None, typer.Option("--library", help="A library folder. Default: the shipped humanoid.")
]
Libraries = Annotated[
    list[str] | None,
    typer.Option(
        "--library",
        metavar="[DEVICE=]DIR",
        help="A library folder; after DEVICE= for that performer alone, and may be repeated. "
        "Default: the shipped humanoid.",
    ),
]
FIGURE_HEIGHT_M = 0.175  # smd.doodle's default, said here so that --help need not load NumPy
FigureHeight = Annotated[
    float,
    typer.Option(help="Height in metres of the figurine the prop stands for; it sets the scale."),
]
Tolerance = Annotated[
    float,
    typer.Option(
        help="How unlike its examples a gesture may be: below 1 more is rejected, above it less.",
        min=0.05,
        max=20.0,
    ),
]


class IntentName(StrEnum):
    """Whether movement was meant."""

    DRAWN = "drawn"
    FREE = "free"


Intent = Annotated[
    IntentName | None,
    typer.Option(
        help="Whether movement was meant: drawn, where a trigger was held, or free, where most is "
        "not. Default: drawn where the recording says when the user drew."
    ),
]


class UnexplainedName(StrEnum):
    """What is made of travel in which nothing is recognised."""

    LEAVE = "leave"
    FOLLOW = "follow"


Unexplained = Annotated[
    UnexplainedName,
    typer.Option(
        help="Where nothing is recognised and the prop travels: leave the character standing, or "
        "let it follow in the gait that suits."
    ),
]
Expressiveness = Annotated[
    float,
    typer.Option(
        help="How much of the Effort is played: 0 neutral clips, 1 as read, up to 2.",
        min=0.0,
        max=2.0,
    ),
]


class HeadingName(StrEnum):
    """What characters face by."""

    PROP = "prop"
    PATH = "path"


Heading = Annotated[
    HeadingName,
    typer.Option(help="What characters face by: prop, where it faces, or path, where it goes."),
]
Ground = Annotated[
    Path | None,
    typer.Option(
        help="What they walk on: a USD file of meshes; its origin is the middle of the devices' "
        "first places. Default: the level ground."
    ),
]
FramesPerSecond = Annotated[
    float, typer.Option("--fps", help="Frames per second of the animation.", min=1.0, max=240.0)
]


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """How the user said that recordings are to be read; None: as the format says."""

    up: str | None = None
    front: str | None = None
    handedness: str | None = None
    unit: str | None = None
    quaternion: str | None = None
    mount: str | None = None

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


@dataclass(frozen=True, slots=True)
class LibraryFolders:
    """Where the performers' libraries are.

    Attributes
    ----------
    shared : of those without one of their own; None for the shipped humanoid.
    own : by device.
    """

    shared: Path | None = None
    own: Mapping[str, Path] = field(default_factory=dict)

    @classmethod
    def from_options(cls, values: Iterable[str] | None) -> LibraryFolders:
        """Return what ``--library`` was given, or end as after wrong usage."""
        shared: list[Path] = []
        own: dict[str, Path] = {}
        for value in values or ():
            device, equals, folder = value.partition("=")
            if not equals or Path(value).is_dir():  # a folder's name may hold the sign
                shared.append(Path(value))
            elif not device or not folder or device in own:
                raise typer.BadParameter(f"expected DIR, or DEVICE=DIR once a device: {value!r}")
            else:
                own[device] = Path(folder)
        if len(shared) > 1:
            raise typer.BadParameter(
                f"expected one DIR, and DEVICE=DIR for others: {str(shared[1])!r}"
            )
        return cls(shared[0] if shared else None, own)

    def over(self, score: Score, score_file: Path) -> LibraryFolders:
        """Return these, and where they say nothing those that a Score names."""
        named = {part.device: part.library for part in score.performers if part.library}
        own = {device: score_file.parent / folder for device, folder in named.items()}
        shared = score_file.parent / score.library if score.library else None
        return LibraryFolders(self.shared or shared, {**own, **self.own})

    def load(self) -> Cast:
        """Read the libraries."""
        import smd

        own = {device: smd.load_library(folder) for device, folder in self.own.items()}
        return smd.Cast(smd.load_library(self.shared), own)

    def named_in(self, score: Score) -> Score:
        """Return a Score that names them."""
        parts = tuple(
            replace(part, library=str(self.own.get(part.device, ""))) for part in score.performers
        )
        return replace(score, performers=parts, library=str(self.shared or ""))


def understanding(
    options: ReadingOptions,
    library: Library | Cast,
    folders: LibraryFolders,
    *,
    figure_height_m: float,
    devices: list[str] | None,
    tolerance: float,
    intent: str | None = None,
    unexplained: str = UnexplainedName.LEAVE,
) -> Callable[[Path], tuple[Recording, Score]]:
    """Return what reads a recording and its Score; the Score keeps how it was read."""

    def understood(file: Path) -> tuple[Recording, Score]:
        import smd

        recording = options.read(file)
        score = smd.parse(
            recording,
            library,
            figure_height_m=figure_height_m,
            devices=devices,
            tolerance=tolerance,
            intent=intent,
            unexplained=unexplained,
        )
        return recording, folders.named_in(replace(score, reading=options.pairs))

    return understood


SCORE_SUFFIX = ".score.json"
"""Of the Scores that stand beside their recordings."""

PHRASES_SUFFIX = ".phrases.csv"
"""Of the tables of phrases that stand beside animations, often in the recordings' folder."""


def recording_files(paths: Iterable[Path]) -> Iterator[Path]:
    """Yield files as they are and the recordings inside folders, sorted by name.

    Scores and tables of phrases that stand beside their recordings are passed over.

    Raises
    ------
    RecordingError
        If a folder holds no recording.
    """
    from smd.errors import RecordingError
    from smd.formats import SUFFIXES

    for path in paths:
        if not path.is_dir():
            yield path
            continue
        inside = sorted(
            file
            for file in path.iterdir()
            if file.suffix.lower() in SUFFIXES
            and not file.name.endswith((SCORE_SUFFIX, PHRASES_SUFFIX))
            and file.is_file()
        )
        if not inside:
            raise RecordingError(
                f"{path}: expected recordings ({' '.join(sorted(SUFFIXES))}) in this folder, "
                "found none"
            )
        yield from inside


def doodles_of_one(recording: Recording, device: str | None) -> tuple[Doodle, ...]:
    """Return the doodles of a device, by default of the only one that is no headset.

    Raises
    ------
    RecordingError
        If there is no such device, or several to choose from.
    """
    from smd.doodle import HEADSETS
    from smd.errors import RecordingError

    known = recording.devices
    played = [name for name in known if name.lower() not in HEADSETS] or list(known)
    if device is None and len(played) > 1:
        raise RecordingError(
            f"{recording.source}: expected one device, or --device with one of "
            f"{', '.join(played)}; found {len(played)}"
        )
    if device is not None and device not in known:
        raise RecordingError(
            f"{recording.source}: expected a device of {', '.join(known)}, got {device!r}"
        )
    return recording.of(device or played[0])


def summary(recording: Recording, score: Score) -> str:
    """Return in one line what was read and understood."""
    start_s = min(doodle.time_s[0] for doodle in recording.doodles)
    end_s = max(doodle.time_s[-1] for doodle in recording.doodles)
    devices = ", ".join(part.device for part in score.performers)
    parts = [f"{end_s - start_s:.1f} s, {devices}"]
    implied = [phrase.implied for part in score.performers for phrase in part.phrases]
    parts.append(count(implied.count(False), "phrase"))
    if any(implied):
        parts.append(f"{implied.count(True)} implied")
    if recording.dropouts:
        split = sum(not dropout.bridged for dropout in recording.dropouts)
        parts.append(f"{count(len(recording.dropouts), 'dropout')} ({split} over 0.25 s)")
    return ", ".join(parts)


def count(number: int, noun: str) -> str:
    """Return a number with its noun: 1 phrase, 2 phrases."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def beside(score: Score, score_file: Path) -> Score:
    """Return the Score with its recording and library named as seen from the Score's folder."""
    folder = score_file.resolve().parent
    return replace(
        score,
        recording=_seen_from(folder, score.recording),
        library=_seen_from(folder, score.library) if score.library else "",
        performers=tuple(
            replace(part, library=_seen_from(folder, part.library) if part.library else "")
            for part in score.performers
        ),
    )


def _seen_from(folder: Path, name: str) -> str:
    """Return a path relative to a folder, or whole where it is on another drive."""
    path = Path(name).resolve()
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return path.as_posix()
