"""What a user gets, as digests: Scores and USD of stories, a real session and every action.

For changes that must change nothing: ``python -m benchmarks.digests > before.txt`` on one commit,
``> after.txt`` on the other, and compare the two. A real session is among them where
``../shared/data`` or ``SMD_TEST_DATA`` has one.
"""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

import smd
from actions_library.library import Library
from benchmarks.gestures import DATA
from laban import Effort
from smd.cast import IDLE
from smd.score import Part, Phrase, Score

RECORDINGS = Path(__file__).parents[1] / "recordings"


def written(score: Score, recording: smd.Recording, library: Library, heading: str) -> bytes:
    """Return a performance as a USD file's text."""
    performance = smd.animate(score, recording, library, heading=heading)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "performance.usda")
        smd.write(performance, path)
        return path.read_bytes()


def of_recording(name: str, path: Path, library: Library, unexplained: str) -> Iterator[str]:
    """Yield the digests of a recording's Score, and of how it is acted out."""
    recording = replace(smd.read_recording(path), source=path.name)  # wherever it lies
    score = smd.parse(recording, library, unexplained=unexplained)
    with tempfile.TemporaryDirectory() as folder:
        smd.write_score(score, Path(folder, "score.json"))
        yield line(f"{name} Score", Path(folder, "score.json").read_bytes())
    for heading in ("prop", "path"):
        yield line(f"{name} by {heading}", written(score, recording, library, heading))


def of_actions(library: Library) -> Iterator[str]:
    """Yield the digest of each action, played twice with opposite Efforts on one made-up way."""
    time_s = np.linspace(0.0, 6.0, 361)
    place = np.stack([0.1 * np.sin(time_s), 0.1 + 0.02 * np.sin(3 * time_s), 0.05 * time_s], -1)
    yaw = 0.15 * np.sin(time_s)
    turn = np.stack([0 * yaw, np.sin(yaw), 0 * yaw, np.cos(yaw)], -1)
    recording = smd.Recording((smd.Doodle(time_s, place, turn, "prop"),), "made up")
    one, other = Effort(0.8, -0.6, 0.5, -0.7), Effort(-0.8, 0.9, -1.0, 1.0)
    for action in library.actions:
        if not action.name.startswith(IDLE):
            phrases = Phrase(action.name, 0.5, 2.0, one), Phrase(action.name, 3.0, 5.0, other)
            score = Score((Part("prop", phrases),), "made up")
            yield line(action.name, written(score, recording, library, "prop"))


def line(name: str, data: bytes) -> str:
    """Return a name and the digest of what it names."""
    return f"{name:32s} {hashlib.sha256(data).hexdigest()[:16]}"


def main() -> None:
    """Print a digest a line."""
    library = smd.load_library()
    for path in sorted(RECORDINGS.glob("*.csv")):
        print(*of_recording(path.stem, path, library, "leave"), sep="\n")
    for path in sorted((DATA / "controllers" / "aframe" / "raw").glob("*.json"))[:1]:
        print(*of_recording(path.stem, path, library, "follow"), sep="\n")
    print(*of_actions(library), sep="\n")


if __name__ == "__main__":
    main()
