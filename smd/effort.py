"""Effort of doodles: examples to learn from, and readings of recordings.

`laban` knows rigid motions only; here it meets recordings, manifests and simulated people.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from laban import AXES, Effort, EffortModel, OwnMeasure, RigidMotion
from laban.description import DESCRIPTION_NAMES, describe
from laban.effort import NEUTRAL, POLES, LabanError
from laban.faults import Fault, naming
from laban.model import effort_of, state_of
from laban.own import FEWEST_TAKES, own_measure
from laban.reader import Reader
from laban.stillness import is_readable, movements
from laban.training import AxisReport, Training, check_labels, train
from laban.windows import WINDOW_S
from smd.doodle import Doodle, Recording
from smd.errors import DoodleError, RecordingError
from smd.geometry.arrays import FloatArray
from smd.smoothing import smooth
from smd.synthetic.efforts import (
    SPREAD,
    LabelledTake,
    Spread,
    coarsely_tracked,
    fourfold_takes,
)

SIMULATED_PEOPLE = 48
SIMULATED_REPEATS = 4
SIMULATED_SEED = 20191028
"""The simulated corpus of the shipped model: 48 people, 9 pairs of Efforts, 4 takes of each."""

SHOWN = 8
"""So many of a reader's entries are named, those that weigh most; the model's file has them all."""

ENOUGH_PERFORMERS, GOOD_ENOUGH = 8, 0.8
"""Below either, training says what to record more of."""


@dataclass(frozen=True, slots=True)
class ManifestRow:
    """One labelled take: where it is, what was meant on each axis, and who played it.

    Attributes
    ----------
    path : the recording, found from the manifest's folder.
    meant : for each of `laban.AXES`, -1 or 1 for a pole, 0 for neither, NaN where not labelled.
    performer : who played.
    """

    path: Path
    meant: tuple[float, ...]
    performer: str


@dataclass(frozen=True, slots=True, eq=False)
class TrainingSet:
    """Labelled takes, ready to learn from.

    Attributes
    ----------
    descriptions : (n, 132), as `laban.description.describe` gives.
    meant : (n, 4), as in `ManifestRow`.
    performers : n names.
    """

    descriptions: FloatArray
    meant: FloatArray
    performers: tuple[str, ...]

    def train(self, *, trained_on: str, seed: int | None = None) -> Training:
        """Train every axis that is labelled."""
        return train(
            self.descriptions,
            dict(zip(AXES, self.meant.T, strict=True)),
            self.performers,
            trained_on=trained_on,
            seed=seed,
        )


def simulated_examples(
    *,
    people: int = SIMULATED_PEOPLE,
    repeats: int = SIMULATED_REPEATS,
    seed: int = SIMULATED_SEED,
    spread: Spread = SPREAD,
) -> TrainingSet:
    """Return takes of simulated people (`smd.synthetic.efforts`), all axes labelled."""
    takes = fourfold_takes(people=people, repeats=repeats, seed=seed, spread=spread)
    return _examples((take, smooth(take.doodle)) for take in takes)


def windowed_examples(
    *,
    people: int = SIMULATED_PEOPLE,
    repeats: int = SIMULATED_REPEATS,
    seed: int = SIMULATED_SEED,
) -> TrainingSet:
    """Return `simulated_examples`, every one by two trackers, every other one through a window.

    The second tracker is the coarsest there is: the same movement is to read the same. The window
    lies anywhere in the take (the whole take, where that is shorter), so that Effort over time is
    read by a model that knows what a movement without its beginning looks like.
    """
    rng = np.random.default_rng([seed, 1])

    def seen() -> Iterator[tuple[LabelledTake, RigidMotion]]:
        for i, take in enumerate(fourfold_takes(people=people, repeats=repeats, seed=seed)):
            motions = [smooth(take.doodle), smooth(coarsely_tracked(take.doodle, rng))]
            time_s = motions[0].time_s
            room_s = float(time_s[-1] - time_s[0]) - WINDOW_S
            if i % 2 and room_s > 0.0:
                start_s = float(time_s[0]) + rng.uniform(0.0, room_s)
                windows = [motion.between(start_s, start_s + WINDOW_S) for motion in motions]
                motions = windows if all(map(is_readable, windows)) else motions
            for motion in motions:
                yield take, motion

    return _examples(seen())


def _examples(takes: Iterable[tuple[LabelledTake, RigidMotion]]) -> TrainingSet:
    """Return labelled takes as they are seen, described."""
    described, meant, performers = [], [], []
    for take, motion in takes:
        described.append(describe(motion))
        meant.append([getattr(take.effort, axis) for axis in AXES])
        performers.append(take.player)
    return TrainingSet(np.array(described), np.array(meant, dtype=np.float64), tuple(performers))


def train_simulated() -> Training:
    """Train the shipped model; the same numbers each time."""
    examples = windowed_examples()
    return examples.train(
        trained_on=f"{len(examples.descriptions)} simulated takes of {SIMULATED_PEOPLE} simulated "
        "people (smd.synthetic.efforts)",
        seed=SIMULATED_SEED,
    )


def train_manifest(
    path: Path,
    read: Callable[[Path], Recording],
    *,
    progress: Callable[[list[ManifestRow]], Iterable[ManifestRow]] = iter,
) -> Training:
    """Train on the recordings that a manifest lists.

    Parameters
    ----------
    path
        A CSV as `read_manifest` takes.
    read
        Reads one recording; it holds one doodle.
    progress
        Wraps the rows while they are read, to show how far it is.

    Raises
    ------
    LabanError, RecordingError, DoodleError
        If the manifest or a recording cannot be used; labels are checked before recordings are
        read.
    """
    rows = read_manifest(path)
    meant = np.array([row.meant for row in rows])
    performers = tuple(row.performer for row in rows)
    try:
        check_labels(dict(zip(AXES, meant.T, strict=True)), performers)
    except LabanError as error:
        raise LabanError(f"{path}: {error}") from error
    described = [describe(_only_motion(row.path, read)) for row in progress(rows)]
    examples = TrainingSet(np.array(described), meant, performers)
    people = len(set(performers))
    return examples.train(trained_on=f"{len(rows)} takes of {people} performers ({path.name})")


def _only_motion(path: Path, read: Callable[[Path], Recording]) -> RigidMotion:
    """Return the motion of a recording of one doodle."""
    doodles = read(path).doodles
    if len(doodles) != 1:
        raise RecordingError(f"{path}: expected a take of one doodle, got {len(doodles)}")
    try:
        return smooth(doodles[0])
    except DoodleError as error:
        raise DoodleError(f"{path}: {error}") from error


def read_manifest(path: Path) -> list[ManifestRow]:
    """Read a list of labelled takes: a CSV with the columns file, performer and the axes.

    Files are found from the manifest's folder. An axis has one of its two words (``sustained``,
    ``sudden``; …), ``neutral``, or nothing where it is not labelled; a column that no take needs
    may be absent.

    Raises
    ------
    LabanError
        If it cannot be read, or a row has an unknown word, no performer, or a file that is not
        there; the message names file and row, and every row is checked before it is raised.
    """
    with naming(path, LabanError, joint=" "):
        try:
            text = path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
            raise Fault.saying("", f"expected a manifest, but {reason}") from error
        return _manifest_rows(text, path.parent)


def _manifest_rows(text: str, folder: Path) -> list[ManifestRow]:
    """Return the rows of a manifest's text, each checked."""
    table = csv.DictReader(text.splitlines())
    columns = [name.strip() for name in table.fieldnames or ()]
    table.fieldnames = columns
    if not {"file", "performer"} <= set(columns):
        expected = f"the columns file, {', '.join(AXES)}, performer"
        raise Fault("", expected, ", ".join(columns) or "none")
    rows = [_manifest_row(folder, f"line {table.line_num}", cells) for cells in table]
    if not rows:
        raise Fault("", "at least one take", "none")
    return rows


def _manifest_row(folder: Path, line: str, cells: dict[str, str | None]) -> ManifestRow:
    """Return one row of a manifest, checked."""
    named = {key: (value or "").strip() for key, value in cells.items() if isinstance(key, str)}
    if not named["file"]:
        raise Fault(f"{line}: file", "a recording", "nothing")
    recording = folder / named["file"]
    if not recording.is_file():
        raise Fault(f"{line}: file", "a recording", f"none: {recording}")
    if not named["performer"]:
        raise Fault(f"{line}: performer", "a name", "nothing")
    meant = tuple(_meant(f"{line}: {axis}", axis, named.get(axis, "")) for axis in AXES)
    return ManifestRow(recording, meant, named["performer"])


def _meant(place: str, axis: str, word: str) -> float:
    """Return the value of a word on an axis; NaN of no word."""
    low, high = POLES[axis]
    values = {"": np.nan, low: -1.0, NEUTRAL: 0.0, high: 1.0}
    if word.lower() not in values:
        raise Fault(place, f"{low}, {high}, {NEUTRAL} or nothing", repr(word))
    return values[word.lower()]


@dataclass(frozen=True, slots=True)
class EffortReading:
    """What is read of one movement.

    Attributes
    ----------
    device : that was moved.
    start_s, end_s : of the movement; of the whole doodle, where that is too short or too still.
    effort : of the movement; nothing where it is too short or too still.
    state : words of the joint state of Time and Weight, and its chance; None as well where the
        model knows none.
    """

    device: str
    start_s: float
    end_s: float
    effort: Effort
    state: tuple[str, str, float] | None


def recording_efforts(
    recording: Recording, model: EffortModel, own: OwnMeasure | None = None
) -> Iterator[EffortReading]:
    """Yield what is read of each movement of a recording, which rests part.

    Of a doodle with nothing to read there is one reading, without Effort.
    """
    for doodle in recording.doodles:
        found = _readable_movements(doodle)
        for motion in found:
            described = describe(motion)
            yield EffortReading(
                doodle.device,
                float(motion.time_s[0]),
                float(motion.time_s[-1]),
                effort_of(described, model, own),
                state_of(described, model, own),
            )
        if not found:
            start_s, end_s = float(doodle.time_s[0]), float(doodle.time_s[-1])
            yield EffortReading(doodle.device, start_s, end_s, Effort(), None)


def performers_measure(recordings: Iterable[Recording]) -> OwnMeasure:
    """Return how somebody moves, from takes of theirs; what was meant by them is not asked.

    Raises
    ------
    LabanError
        If fewer than `laban.own.FEWEST_TAKES` movements of them can be read.
    """
    doodles = [doodle for recording in recordings for doodle in recording.doodles]
    found = [motion for doodle in doodles for motion in _readable_movements(doodle)]
    measure = own_measure(found)
    if measure is None:
        raise LabanError(
            f"performer: expected at least {FEWEST_TAKES} takes that move, got {len(found)}"
        )
    return measure


def _readable_movements(doodle: Doodle) -> list[RigidMotion]:
    """Return a doodle's movements; none where it is too short or too still to read."""
    try:
        motion = smooth(doodle)
    except DoodleError:
        return []
    return [each for each in movements(motion) if is_readable(each)]


def report_lines(training: Training) -> list[str]:
    """Return what a training came to, as lines for people."""
    lines: list[str] = []
    model = training.model
    for axis, part in model.axes.items():
        low, high = POLES[axis]
        alone, own = training.alone[axis], training.own[axis]
        lines += [
            f"{axis}: {_share(alone)} right, each judged without its performer "
            f"({part.performers} performers), Brier score {alone.brier_score:.3f}",
            f"  with the performer's other takes: {_share(own)}, Brier score {own.brier_score:.3f}",
            f"  {'meant':>10}  read {low}, {high}, mean",
        ]
        for word, pole in ((low, -1), (NEUTRAL, 0), (high, 1)):
            of = alone.meant == pole
            if of.any():
                told = alone.reading[of]
                lines.append(
                    f"  {word:>10}  {int(np.sum(told <= 0))}, {int(np.sum(told > 0))}, "
                    f"{told.mean():+.2f}"
                )
        for name, reader in (("alone", model.alone), ("with other takes", model.own)):
            members = reader.axes[axis].members.items()
            lines += [
                f"  {name}: {', '.join(f'{member} {share:.2f}' for member, share in members)}",
                f"    weighs most: {', '.join(_heaviest(reader, axis))}",
            ]
        lines += [f"  {advice}" for advice in _advice(alone, part.performers, (low, high))]
    if model.alone.states is not None and model.own.states is not None:
        lines.append(
            f"time and weight together: {100 * model.alone.states.held_out_accuracy:.0f} % of the "
            f"joint states right, {100 * model.own.states.held_out_accuracy:.0f} % with other takes"
        )
    return lines


def _heaviest(reader: Reader, axis: str) -> list[str]:
    """Return the names of the entries and products that weigh most on an axis."""
    entries = [DESCRIPTION_NAMES[column] for column in reader.entries.columns]
    names = [*entries, *(" x ".join(entries[i] for i in pair) for pair in reader.entries.pairs)]
    order = np.argsort(-np.abs(reader.axes[axis].classifier.weight), kind="stable")
    return [names[i] for i in order[:SHOWN]]


def accuracy_interval(right: int, count: int) -> tuple[float, float]:
    """Return Wilson's 95 % interval of a share [1]_.

    References
    ----------
    .. [1] E. B. Wilson, "Probable Inference, the Law of Succession, and Statistical Inference",
       Journal of the American Statistical Association 22, 1927.
    """
    z, share = 1.96, right / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * np.sqrt(share * (1 - share) / count + (z / (2 * count)) ** 2)
    return float(middle - half), float(middle + half)


def _share(report: AxisReport) -> str:
    """Return an accuracy with its interval."""
    count = int(np.sum(report.meant != 0))
    right = round(report.accuracy * count)
    low, high = accuracy_interval(right, count)
    return (
        f"{100 * right / count:.0f} % ({right} of {count}; {100 * low:.0f} to {100 * high:.0f} %)"
    )


def _advice(report: AxisReport, performers: int, words: tuple[str, str]) -> Iterator[str]:
    """Yield what to record more of."""
    if performers < ENOUGH_PERFORMERS:
        yield f"record more performers: {performers} say little about the next one"
    shares = []
    for pole in (-1, 1):
        of = report.meant == pole
        shares.append(float(np.mean((report.reading[of] > 0) == (pole > 0))))
    worse = int(np.argmin(shares))
    if min(shares) < GOOD_ENOUGH:
        yield f"record more {words[worse]} takes: {100 * shares[worse]:.0f} % of them are told"
