"""Effort of doodles: examples to learn from, and readings of recordings.

`laban` knows rigid motions only; here it meets recordings, manifests and simulated people.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from laban import AXES, Effort, EffortModel, RigidMotion, effort_features, read_effort
from laban.effort import LabanError
from laban.features import FEATURE_NAMES
from laban.model import NEUTRAL, POLES
from laban.training import Training, check_labels, train
from smd.doodle import Doodle, Recording
from smd.errors import DoodleError, RecordingError
from smd.geometry.arrays import FloatArray
from smd.smoothing import smooth
from smd.synthetic.efforts import labelled_takes

SIMULATED_PEOPLE = 48
SIMULATED_REPEATS = 3
SIMULATED_SEED = 20191028
"""The simulated corpus of the shipped model: 48 people, 9 pairs of Efforts, 3 takes of each."""


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
class Examples:
    """Labelled takes, ready to learn from.

    Attributes
    ----------
    features : (n, 50).
    meant : (n, 4), as in `ManifestRow`.
    performers : n names.
    """

    features: FloatArray
    meant: FloatArray
    performers: tuple[str, ...]

    def train(self, *, trained_on: str, seed: int | None = None) -> Training:
        """Train every axis that is labelled."""
        return train(
            self.features,
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
) -> Examples:
    """Return takes of simulated people (`smd.synthetic.efforts`), Time and Weight labelled."""
    takes = list(labelled_takes(people=people, repeats=repeats, seed=seed))
    meant = [[getattr(take.effort, axis) for axis in AXES] for take in takes]
    return Examples(
        features=np.array([effort_features(smooth(take.doodle)) for take in takes]),
        meant=np.array(meant, dtype=np.float64),  # None, not labelled, becomes NaN
        performers=tuple(take.player for take in takes),
    )


def train_simulated() -> Training:
    """Train the shipped model; the same numbers each time."""
    examples = simulated_examples()
    return examples.train(
        trained_on=f"{len(examples.features)} simulated takes of {SIMULATED_PEOPLE} simulated "
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
    features = [effort_features(_only_motion(row.path, read)) for row in progress(rows)]
    examples = Examples(np.array(features), meant, performers)
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
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise LabanError(f"{path}: expected a manifest, but {reason}") from error
    table = csv.DictReader(text.splitlines())
    columns = [name.strip() for name in table.fieldnames or ()]
    table.fieldnames = columns
    for needed in ("file", "performer"):
        if needed not in columns:
            raise LabanError(
                f"{path}: expected the columns file, {', '.join(AXES)}, performer; "
                f"found {', '.join(columns) or 'none'}"
            )
    rows = [_manifest_row(path, table.line_num, cells) for cells in table]
    if not rows:
        raise LabanError(f"{path}: expected at least one take, found none")
    return rows


def _manifest_row(manifest: Path, line: int, cells: dict[str, str | None]) -> ManifestRow:
    """Return one row of a manifest, checked."""
    where = f"{manifest} line {line}"
    named = {key: (value or "").strip() for key, value in cells.items() if isinstance(key, str)}
    if not named["file"]:
        raise LabanError(f"{where}: file: expected a recording, found nothing")
    recording = manifest.parent / named["file"]
    if not recording.is_file():
        raise LabanError(f"{where}: file: expected a recording, {recording} is not there")
    if not named["performer"]:
        raise LabanError(f"{where}: performer: expected a name, found nothing")
    meant = tuple(_meant(where, axis, named.get(axis, "")) for axis in AXES)
    return ManifestRow(recording, meant, named["performer"])


def _meant(where: str, axis: str, word: str) -> float:
    """Return the value of a word on an axis; NaN of no word."""
    low, high = POLES[axis]
    values = {"": np.nan, low: -1.0, NEUTRAL: 0.0, high: 1.0}
    if word.lower() not in values:
        raise LabanError(
            f"{where}: {axis}: expected {low}, {high}, {NEUTRAL} or nothing, got {word!r}"
        )
    return values[word.lower()]


def recording_efforts(recording: Recording, model: EffortModel) -> Iterator[tuple[Doodle, Effort]]:
    """Yield each doodle of a recording with its Effort; one too short to smooth has none."""
    for doodle in recording.doodles:
        try:
            motion = smooth(doodle)
        except DoodleError:
            yield doodle, Effort()
        else:
            yield doodle, read_effort(motion, model)


def report_lines(training: Training) -> list[str]:
    """Return what a training came to, as lines for people."""
    lines = []
    for axis, report in training.reports.items():
        low, high = POLES[axis]
        part = training.model.axes[axis]
        told, meant = report.reading > 0, report.meant
        right = int(np.sum((told == (meant > 0))[meant != 0]))
        lines.append(
            f"{axis}: {100 * report.accuracy:.0f} % right ({right} of {int(np.sum(meant != 0))} "
            f"takes, each judged without its performer; {part.performers} performers), "
            f"Brier score {report.brier_score:.3f}"
        )
        for word, pole in ((low, -1), (high, 1)):
            of = meant == pole
            lines.append(
                f"  {word}: {int(np.sum(told[of] == (pole > 0)))} of {int(np.sum(of))} right, "
                f"mean reading {report.reading[of].mean():+.2f}"
            )
        if (meant == 0).any():
            lines.append(f"  {NEUTRAL}: mean reading {report.reading[meant == 0].mean():+.2f}")
        names = ", ".join(FEATURE_NAMES[column] for column in part.columns)
        lines.append(f"  {len(part.columns)} features: {names}")
    return lines
