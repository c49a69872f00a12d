"""Advice: which mistakes in how a recording is read are told, and whether free play is left alone.

What is suggested, and what that costs, comes first.

Run ``python -m benchmarks.advice``. Shipped stories are read with a mistake that one option mends.
Real recordings hold no gesture of the library: nothing should be advised. Of those, the A-Frame
sessions dance and grabLeft and the first nine idle hands (in name order) were looked at when the
thresholds of `smd.advice` were chosen; the others were not.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import smd
from benchmarks.gestures import DATA as SHARED_DATA
from smd.advice import (
    LEAST_PHRASES,
    Asked,
    Trials,
    better_reading,
    busiest,
    otherwise,
)
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle, Recording
from smd.formats.frame import SourceFrame
from smd.formats.reading import format_frame
from smd.recognition import Recognizer
from smd.recognition.suggestions import Understood, suggestions
from smd.smoothing import smooth

RECORDINGS = Path(__file__).parents[1] / "recordings"
MISTAKES: tuple[Mapping[str, str], ...] = (
    {"mount": "yaw=180"},
    {"mount": "yaw=90"},
    {"mount": "roll=180"},
    {"mount": "pitch=90"},
    {"mount": "yaw=180,roll=90"},
    {"up": "-y"},
    {"up": "z"},
    {"unit": "cm"},
    {"unit": "mm"},
)
SHORTEST = 20
"""Samples of a doodle that is long enough to be smoothed."""

CHOSEN_SESSIONS, CHOSEN_IDLE = ("dance", "grabLeft"), 9


def stories() -> None:
    """Print how many mistakes in reading stories are mended by what is advised."""
    cast = smd.Cast(smd.load_library())
    mended, costs = 0, []
    paths = sorted(RECORDINGS.glob("*.csv"))
    for path in paths:
        meant = smd.read_score(path.with_suffix(".score.json"))
        wanted = [[p.action for p in part.phrases] for part in meant.performers]
        for mistake in MISTAKES:
            better, cost = advised(path, cast, mistake)
            costs.append(cost)
            if better is None:
                print(f"  {path.name} {dict(mistake)}: nothing")
                continue
            options = {**mistake, **dict(better.options)}
            again = smd.read_recording(path, SourceFrame.from_options(**options))
            found = [[p.action for p in part.phrases] for part in smd.parse(again, cast).performers]
            mended += found == wanted
            if found != wanted:
                print(f"  {path.name} {dict(mistake)}: {better}")
    print(f"stories: {mended} of {len(paths) * len(MISTAKES)} mistakes mended; {_took(costs)}")


def free_play(name: str, paths: list[Path]) -> None:
    """Print whether anything is advised on recordings without gestures, and how near it was."""
    cast = smd.Cast(smd.load_library())
    told, shares, costs = 0, [0.0], []
    for path in paths:
        better, cost = advised(path, cast, {})
        costs.append(cost)
        told += better is not None
        if better is not None:
            print(f"  {path.name}: {better}")
        shares += shares_in_any_reading(path, cast)
    print(
        f"{name}: {told} of {len(paths)} recordings get advice; with {LEAST_PHRASES} phrases or "
        f"more, a reading explains at most {max(shares):.2f} of the movement; {_took(costs)}"
    )


def advised(path: Path, cast: smd.Cast, options: Mapping[str, str]):  # type: ignore[no-untyped-def]
    """Return what is advised, and what that costs in parsings of the recording."""
    recording = smd.read_recording(path, SourceFrame.from_options(**options))
    asked = Asked(options, format_frame(path), DEFAULT_FIGURE_HEIGHT_M)
    begun = time.process_time()
    score = smd.parse(recording, cast)
    parsed = time.process_time()
    better = better_reading(recording, score, cast, asked)
    return better, (parsed - begun, time.process_time() - parsed)


def shares_in_any_reading(path: Path, cast: smd.Cast) -> Iterator[float]:
    """Yield the share of movement that readings explain which give phrases enough."""
    recording: Recording = smd.read_recording(path)
    asked = Asked({}, format_frame(path), DEFAULT_FIGURE_HEIGHT_M)
    devices = [part.device for part in smd.parse(recording, cast).performers]
    doodles = [doodle for device in devices for doodle in recording.of(device)]
    sample = [busiest(doodles)]
    trials = Trials(cast, asked)
    for options in otherwise(doodles, asked):
        found = trials.glance(sample, options)
        if found.phrases >= LEAST_PHRASES:
            yield found.share


def _took(costs: list[tuple[float, float]]) -> str:
    parses, advices = ([cost[i] for cost in costs] for i in (0, 1))
    return (
        f"{sum(advices) / len(advices):.2f} s of processor time on average (most "
        f"{max(advices):.2f}), parsing {sum(parses) / len(parses):.2f} s"
    )


def suggesting(name: str, paths: list[Path]) -> None:
    """Print how much is suggested on recordings, and what that costs beside recognition."""
    library = smd.load_library()
    recognizer = Recognizer(library)
    spotted_s, suggested_s, count, seconds = 0.0, 0.0, 0, 0.0
    for path in paths:
        recording = smd.read_recording(path)
        for device in recording.devices:
            begun = time.process_time()
            understood = [
                _understood(doodle, recognizer)
                for doodle in recording.of(device)
                if len(doodle) > SHORTEST
            ]
            spotted = time.process_time()
            count += len(suggestions(recognizer, library.actions, understood))
            spotted_s += spotted - begun
            suggested_s += time.process_time() - spotted
            seconds += sum(doodle.duration_s for doodle in recording.of(device))
    print(
        f"{name}: {60.0 * count / seconds:.1f} suggestions a minute of {seconds / 60.0:.1f}; "
        f"recognising took {spotted_s:.2f} s, suggesting {suggested_s:.2f} s"
    )


def _understood(doodle: Doodle, recognizer: Recognizer) -> Understood:
    motion = smooth(doodle)
    runs = recognizer.runs_of(doodle, motion)
    return Understood(motion, runs, recognizer.spot_runs(motion, runs))


def main() -> None:
    """Print all of it."""
    suggesting("stories", sorted(RECORDINGS.glob("*.csv")))
    stories()
    if not SHARED_DATA.is_dir():
        print(f"real recordings: skipped, {SHARED_DATA} is absent")
        return
    sessions = sorted((SHARED_DATA / "controllers" / "aframe" / "raw").glob("*.json"))
    idle = sorted((SHARED_DATA / "idle").glob("*.csv"))
    chosen = [path for path in sessions if path.stem in CHOSEN_SESSIONS]
    suggesting("A-Frame sessions", sessions)
    suggesting("idle hands", idle)
    free_play("chosen on", chosen + idle[:CHOSEN_IDLE])
    others = [path for path in sessions if path.stem not in CHOSEN_SESSIONS]
    free_play("not looked at", others + idle[CHOSEN_IDLE:])


if __name__ == "__main__":
    main()
