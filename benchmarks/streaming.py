"""What a stream says beside the offline pass, and how soon: ``python -m benchmarks.streaming``.

Simulated people play all shipped gestures in a row. Budget: a span is final 0.5 s after its end.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from actions_library.folder import load_library
from laban import RigidMotion
from smd.doodle import Doodle
from smd.recognition import Recognizer
from smd.recognition.bank import compile_library
from smd.recognition.detection import Detection
from smd.recognition.streaming import HORIZON_S, RecognitionStream, Spotter
from smd.recognition.token_spotter import TokenSpotter
from smd.recognition.tokenizer import tokenize
from smd.smoothing import smooth
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

PEOPLE, SEED = 20, 2028


def rows() -> list[Doodle]:
    """Return all gestures in random order by each person, pauses of 0.4 to 1.2 s."""
    played = []
    for index in range(PEOPLE):
        rng = np.random.default_rng([SEED, 1, index])
        take = Take(simulated_person(rng), rng).pause(0.6)
        for action in rng.permutation(list(GESTURES)):
            take.play(str(action)).pause(float(rng.uniform(0.4, 1.2)))
        played.append(take.doodle())
    return played


def streamed(
    doodle: Doodle, spotter: Spotter, horizon_s: float
) -> tuple[list[Detection], list[float], list[float]]:
    """Return the spans, how long after its end each became final (but the last ones), and costs.

    These are processor time in ms a sample, averaged over a second of samples each.
    """
    stream = RecognitionStream(spotter, horizon_s=horizon_s)
    spans: list[Detection] = []
    late_s: list[float] = []
    spent: list[float] = []
    samples = zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, strict=True)
    for time_s, position, orientation in samples:
        started = time.thread_time()
        final = stream.push(float(time_s), position, orientation)
        spent.append(1e3 * (time.thread_time() - started))
        spans += final
        late_s += [float(time_s) - span.end_s for span in final]
    rate = round((len(doodle) - 1) / doodle.duration_s)
    whole = np.array(spent[: len(spent) // rate * rate]).reshape(-1, rate)
    return spans + stream.finish(), late_s, whole.mean(axis=1).tolist()


def spans_of(spotter: Spotter, motion: RigidMotion) -> list[Detection]:
    """Return what the offline pass finds in a whole doodle."""
    runs = tokenize(motion)
    return list(spotter.named(motion, runs, spotter.chosen(motion, runs)))


def names(spans: Sequence[Detection]) -> list[str]:
    """Return the spans' actions."""
    return [span.action for span in spans]


def alike(spans: Sequence[Detection], others: Sequence[Detection]) -> int:
    """Return how many of others are among spans: the same action, over most of its time."""
    count = 0
    for other in others:
        count += any(
            span.action == other.action
            and min(span.end_s, other.end_s) - max(span.start_s, other.start_s)
            > 0.5 * (other.end_s - other.start_s)
            for span in spans
        )
    return count


def main() -> None:
    """Print every figure."""
    library = load_library()
    patterns = {action.name: action.pattern for action in library.actions if action.pattern}
    bank = compile_library(patterns)
    ways: tuple[tuple[str, Spotter], ...] = (
        ("tokens alone", TokenSpotter(bank)),
        ("with verification", Recognizer(library)),
    )
    played = rows()
    motions = [smooth(row) for row in played]
    for name, spotter in ways:
        offline = [spans_of(spotter, motion) for motion in motions]
        for horizon_s in (HORIZON_S, 2.0 * HORIZON_S):
            found = [streamed(row, spotter, horizon_s) for row in played]
            same = sum(names(a) == names(b) for (a, _, _), b in zip(found, offline, strict=True))
            told = [alike(a, b) for (a, _, _), b in zip(found, offline, strict=True)]
            share = 100.0 * sum(told) / sum(map(len, offline))
            late_s = np.array([late for _, each, _ in found for late in each])
            cost = np.percentile([ms for *_, each in found for ms in each], [50, 99])
            print(
                f"{name}, horizon {horizon_s:g} s: {same} of {len(played)} rows of "
                f"{len(GESTURES)} as offline, {share:.1f} % of their spans; "
                f"final after {np.median(late_s):.2f} s, "
                f"{100.0 * np.mean(late_s > horizon_s):.1f} % later than the horizon, "
                f"at most {late_s.max():.2f} s; "
                f"{cost[0]:.2f} ms a sample, in the busiest of 100 seconds {cost[1]:.2f} ms"
            )


if __name__ == "__main__":
    main()
