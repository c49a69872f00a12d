"""Advice: what to try where a recording was hardly understood.

Most often the prop was held, or the file's numbers mean, something else than was said. Other
readings of the same numbers are tried quietly, on a part of the recording; chance makes no story
readable, so one that does is worth a person's while.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from smd.doodle import Doodle, Recording
from smd.errors import DoodleError
from smd.formats.frame import METRES_PER_UNIT, Conversion, Mount, SourceFrame
from smd.recognition.acceptance import OTHERS_MARGIN, Intent
from smd.recognition.recognizers import recognizer_of
from smd.recognition.tokenizer import tokenize
from smd.smoothing import smooth

if TYPE_CHECKING:
    from smd.cast import Cast
    from smd.recognition.recognizer import Recognizer
    from smd.score import Score

AS_STRICT = float(np.exp(OTHERS_MARGIN[Intent.DRAWN] - OTHERS_MARGIN[Intent.FREE]))
"""Tolerance at which drawn movement may cost no more than free movement, of others' examples."""

SAMPLE_S = 12.0
"""So much of one device is read in every way: as many seconds as move most."""

UNDERSTOOD = 0.9
"""Share of the movement from which a recording counts as understood, and nothing is tried."""

READABLE = 0.6
"""Share of the movement that another reading has to explain to be told. The right one explains a
story as a whole; free play and idle hands (A-Frame sessions dance and grabLeft, nine recordings)
give three phrases in no other reading."""

LEAST_PHRASES = 3
"""So many phrases another reading has to give: fewer may be chance."""

LEFT_OVER = 0.5
"""Share of what is left unexplained now that another reading may leave so at most: a prop back to
front makes walks backward of walks, and still half a story readable."""

LEAST_HEIGHTS, MOST_HEIGHTS = 1.0, 40.0
"""Figure heights that a prop's whole way spans, if its unit is right: from a story on a table to
one through a room."""

FACTOR = 10.0
"""A prop may be so many times as large, or as small, as was said."""

PRESETS = (
    {"up": "z", "front": "x"},
    {"up": "z", "front": "x", "handedness": "left", "unit": "cm"},
)
"""Of robots, and of Unreal: axes that differ in more than one answer (docs/conventions.md)."""


@dataclass(frozen=True, slots=True)
class Advice:
    """Another way to read a recording.

    Attributes
    ----------
    options : what differs, by the option's name without dashes, as a person types it.
    phrases : how many would be recognised in the whole recording.
    share : of the movement that they explain.
    """

    options: tuple[tuple[str, str], ...]
    phrases: int
    share: float

    def __str__(self) -> str:
        typed = " ".join(f"--{name} {value}" for name, value in self.options)
        noun = "phrase" if self.phrases == 1 else "phrases"
        return f"{typed}: {self.phrases} {noun} would be recognised"


@dataclass(frozen=True, slots=True)
class Asked:
    """How a recording was read and recognised.

    Attributes
    ----------
    options : of `SourceFrame.from_options`, that were given.
    format_frame : what the file's format says (`smd.formats.reading.format_frame`).
    figure_height_m, tolerance, intent : as in `smd.parse`.
    """

    options: Mapping[str, str]
    format_frame: SourceFrame
    figure_height_m: float
    tolerance: float = 1.0
    intent: Intent | None = None

    def conversion(self, options: Mapping[str, str]) -> Conversion:
        """Return the conversion of some options."""
        return SourceFrame.from_options(**options).completed(self.format_frame).conversion()


def better_reading(
    recording: Recording,
    score: Score,
    library: Cast,
    asked: Asked,
    *,
    only: Collection[str] = (),
) -> Advice | None:
    """Return the reading that would have changed most, if one makes the recording readable.

    Nothing is tried where most of the movement is understood, or nothing moves.

    Parameters
    ----------
    recording
        As it was read.
    score
        What was understood of it.
    library
        What was looked for.
    asked
        How it was read.
    only
        The options that may differ; all if empty.
    """
    doodles, present = _performed(recording, score), _present_share(recording, score)
    if present >= UNDERSTOOD:
        return None
    sample, trials = [busiest(doodles)], Trials(library, asked)
    best, most = None, Explained()
    for options in otherwise(doodles, asked):
        if only and not set(options) <= set(only):
            continue
        found = trials.glance(sample, options)
        if found.readable and found.certainty > most.certainty:
            best, most = options, found
    if best is None:
        return None
    whole = trials.of(doodles, best)
    if not whole.readable or 1.0 - whole.share > LEFT_OVER * (1.0 - present):
        return None
    return Advice(tuple(best.items()), whole.phrases, whole.share)


def is_understood(recording: Recording, score: Score) -> bool:
    """Tell whether there is nothing to advise: most is understood, or nothing moves."""
    return _present_share(recording, score) >= UNDERSTOOD


def _performed(recording: Recording, score: Score) -> list[Doodle]:
    return [doodle for part in score.performers for doodle in recording.of(part.device)]


def _present_share(recording: Recording, score: Score) -> float:
    """Return the share of movement that is understood; nothing of what has a senseless size."""
    doodles = _performed(recording, score)
    if not any(_moves(doodle) for doodle in doodles):
        return 1.0
    fits = _size_fits(doodles, score.figure_height_m)
    return understood_share(recording, score) if fits else 0.0


def otherwise(doodles: Sequence[Doodle], asked: Asked) -> Iterator[dict[str, str]]:
    """Return what else could be said: of the axes, unless the size makes no sense as it is."""
    size_fits = _size_fits(doodles, asked.figure_height_m)
    return axes_otherwise(asked) if size_fits else size_otherwise(asked)


def size_otherwise(asked: Asked) -> Iterator[dict[str, str]]:
    """Yield what else could be said of a recording's size, and of the prop's."""
    now = SourceFrame.from_options(**asked.options).completed(asked.format_frame)
    yield from ({"unit": unit} for unit in METRES_PER_UNIT if unit != now.unit)
    yield from PRESETS
    for factor in (FACTOR, 1.0 / FACTOR):
        yield {"figure-height": f"{asked.figure_height_m * factor:g}"}


def axes_otherwise(asked: Asked) -> Iterator[dict[str, str]]:
    """Yield what else could be said of a recording's axes, the commonest mistakes first.

    Left and right exchanged are not among them: mirrored, a story reads as well.
    """
    now = SourceFrame.from_options(**asked.options).completed(asked.format_frame)
    mount = now.mount or Mount()
    current = mount.yaw_deg, mount.pitch_deg, mount.roll_deg
    turns = dict.fromkeys((*_COMMON, *((yaw, *tilt) for tilt in _TILTS for yaw in _YAWS)))
    for yaw, pitch, roll in turns:
        if (yaw, pitch, roll) != current:
            yield {"mount": _typed(replace(mount, yaw_deg=yaw, pitch_deg=pitch, roll_deg=roll))}
    yield from ({"up": up} for up in ("y", "z", "-y", "-z", "x", "-x") if up != now.up)
    yield from PRESETS


_COMMON = ((0.0, 0.0, 0.0), (180.0, 0.0, 0.0), (0.0, 0.0, 180.0), (180.0, 0.0, 180.0))
_YAWS = (0.0, 90.0, -90.0, 180.0)
_TILTS = ((0.0, 0.0), (90.0, 0.0), (-90.0, 0.0), (0.0, 90.0), (0.0, -90.0), (0.0, 180.0))
"""Pitch and roll that, with four yaws each, bring any axis of the prop to its front and any across
it to its top."""


def _typed(mount: Mount) -> str:
    """Return a mount as a person types it."""
    named = (
        ("yaw", mount.yaw_deg),
        ("pitch", mount.pitch_deg),
        ("roll", mount.roll_deg),
        ("x", mount.x_m),
        ("y", mount.y_m),
        ("z", mount.z_m),
    )
    return ",".join(f"{name}={value:g}" for name, value in named if value) or "yaw=0"


@dataclass(frozen=True, slots=True)
class Explained:
    """What is recognised in a reading.

    Attributes
    ----------
    phrases : how many.
    certainty : sum of their confidences.
    share : of the movement that they explain.
    """

    phrases: int = 0
    certainty: float = 0.0
    share: float = 0.0

    @property
    def readable(self) -> bool:
        """Whether that is more than chance gives."""
        return self.phrases >= LEAST_PHRASES and self.share >= READABLE


def understood_share(recording: Recording, score: Score) -> float:
    """Return the share of a recording's movement that lies within phrases, implied ones apart.

    Movement is counted as tokens are: in figure heights travelled plus radians turned, where it is
    meant at all. Where nothing moves, all is understood.
    """
    explained, moved = 0.0, 0.0
    for part in score.performers:
        phrases = [phrase for phrase in part.phrases if not phrase.implied]
        edges_s = np.array([[phrase.start_s, phrase.end_s] for phrase in phrases]).reshape(-1)
        for doodle in recording.of(part.device):
            try:
                motion = smooth(doodle)
            except DoodleError:
                continue
            for run in tokenize(motion, figure_height_m=score.figure_height_m):
                middle_s = 0.5 * (run.start_s + run.end_s)
                extent = run.travel_heights + run.turn_rad
                moved += extent
                explained += extent * (int(np.searchsorted(edges_s, middle_s)) % 2)
    return explained / moved if moved else 1.0


class Trials:
    """Other readings of a recording's doodles."""

    def __init__(self, library: Cast, asked: Asked) -> None:
        self._library, self._asked = library, asked

    def of(self, doodles: Sequence[Doodle], options: Mapping[str, str]) -> Explained:
        """Return what is recognised in doodles that are read otherwise."""
        return self._read(doodles, options, glance=False)

    def glance(self, doodles: Sequence[Doodle], options: Mapping[str, str]) -> Explained:
        """Return what is recognised without dense stretches, which take most of the time."""
        return self._read(doodles, options, glance=True)

    def _read(
        self, doodles: Sequence[Doodle], options: Mapping[str, str], *, glance: bool
    ) -> Explained:
        asked = self._asked
        height_m = float(options.get("figure-height", asked.figure_height_m))
        of_frame = {name: value for name, value in options.items() if name != "figure-height"}
        before = asked.conversion(asked.options)
        after = asked.conversion({**asked.options, **of_frame})
        read = [_reread(doodle, before, after) for doodle in doodles]
        if not _size_fits(read, height_m):
            return Explained()
        devices = {doodle.device for doodle in doodles}
        return _explained(read, {d: self._recognizer(d, height_m, glance) for d in devices})

    def _recognizer(self, device: str, figure_height_m: float, glance: bool) -> Recognizer:
        return recognizer_of(
            self._library.of(device),
            figure_height_m=figure_height_m,
            tolerance=self._asked.tolerance * (AS_STRICT if glance else 1.0),
            intent=Intent.DRAWN if glance else self._asked.intent,
        )


def _explained(doodles: Sequence[Doodle], recognizers: Mapping[str, Recognizer]) -> Explained:
    """Return what is recognised in doodles."""
    phrases, certainty, explained, moved = 0, 0.0, 0.0, 0.0
    for doodle in doodles:
        try:
            motion = smooth(doodle)
        except DoodleError:
            continue
        recognizer = recognizers[doodle.device]
        runs = recognizer.runs_of(doodle, motion)
        extent = np.array([run.travel_heights + run.turn_rad for run in runs])
        detections = recognizer.spot_runs(motion, runs, recognizer.intent_of(doodle))
        moved += float(extent.sum())
        explained += sum(
            float(extent[detection.first_run : detection.last_run].sum())
            for detection in detections
        )
        phrases += len(detections)
        certainty += sum(detection.confidence for detection in detections)
    return Explained(phrases, certainty, explained / moved if moved else 0.0)


def _reread(doodle: Doodle, before: Conversion, after: Conversion) -> Doodle:
    """Return a doodle of the same numbers in the file, converted otherwise."""
    position_m, orientation_xyzw = after.poses(
        *before.numbers(doodle.position_m, doodle.orientation_xyzw)
    )
    return replace(doodle, position_m=position_m, orientation_xyzw=orientation_xyzw)


def _size_m(doodle: Doodle) -> float:
    """Return the diagonal of the box around a doodle."""
    return float(np.linalg.norm(np.ptp(doodle.position_m, axis=0)))


def _size_fits(doodles: Iterable[Doodle], figure_height_m: float) -> bool:
    """Tell whether the prop that goes farthest goes as far as one that is played with."""
    largest_m = max(_size_m(doodle) for doodle in doodles)
    return LEAST_HEIGHTS <= largest_m / figure_height_m <= MOST_HEIGHTS


def _moves(doodle: Doodle) -> bool:
    """Tell whether a doodle changes at all, in whatever unit."""
    return len(doodle) > 1 and bool(
        np.ptp(doodle.position_m, axis=0).any() or np.ptp(doodle.orientation_xyzw, axis=0).any()
    )


def busiest(doodles: Iterable[Doodle]) -> Doodle:
    """Return of the largest doodle the `SAMPLE_S` in which the prop goes farthest."""
    doodle = max(doodles, key=_size_m)
    time_s = doodle.time_s
    if doodle.duration_s <= SAMPLE_S:
        return doodle
    steps = np.linalg.norm(np.diff(doodle.position_m, axis=0), axis=1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    firsts = np.arange(len(time_s))[time_s <= time_s[-1] - SAMPLE_S]
    lasts = np.searchsorted(time_s, time_s[firsts] + SAMPLE_S, side="right")
    first = int(np.argmax(way[lasts - 1] - way[firsts]))
    return doodle.selected(slice(first, int(lasts[first])))
