"""What a glimpse leaves aside, and what it loses.

Stretches of free movement are looked at with few samples first (`Verification.promising`). Here all
are weighed as closely as those that pass, to see which of them would have been within the limit::

    python -m benchmarks.glimpse
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

import numpy as np

from benchmarks.composed import idle_files, read_idle, sessions_of
from benchmarks.gestures import REPORTED, learned_action, read_gestures
from benchmarks.sessions import FRAME, SEED, TEACHINGS
from benchmarks.takes import long_recording
from smd import load_library
from smd.doodle import Doodle
from smd.recognition import Recognizer
from smd.recognition.acceptance import Intent, accepted_cost
from smd.recognition.action import Action
from smd.recognition.background import weighed
from smd.recognition.costs import DEFAULT_COSTS, run_costs
from smd.recognition.stretches import are_alike_long, dense_stretches
from smd.recognition.traits import traits_of_parts
from smd.recognition.verification import GLANCE, GLIMPSE, Verification
from smd.smoothing import smooth

SESSIONS = 12


def looked_at(actions: Iterable[Action], doodle: Doodle) -> np.ndarray:
    """Return how many pairs of stretch and action there are, pass a glimpse, are within, are lost.

    The last two are told by as many samples as those that pass are looked at with.
    """
    every = [one for one in actions if one.pattern and one.exemplar]
    exemplars = [weighed(one.exemplar) for one in every if one.exemplar]
    verification = Verification(tuple(exemplars))
    most = accepted_cost(
        np.array([one.background for one in exemplars], float),
        np.array([one.own.any() for one in exemplars]),
        Intent.FREE,
    )
    motion = smooth(doodle)
    runs = Recognizer(every).runs_of(doodle, motion)
    durations_s = np.array([one.duration_s for one in exemplars])
    stretches = dense_stretches(runs, run_costs(runs, DEFAULT_COSTS).is_still, durations_s)
    spans_s = [(runs[first].start_s, runs[last - 1].end_s) for first, last in stretches]
    found = np.zeros(4, np.int64)
    for begin in range(0, len(spans_s), 1024):
        some = spans_s[begin : begin + 1024]
        length_s = np.array([end - start for start, end in some])
        gesture, action = np.nonzero(are_alike_long(length_s, durations_s))
        seen = traits_of_parts(motion, some, every=GLIMPSE)
        passes = verification.promising(seen, action, gesture, most[action])
        terms = verification.terms(
            traits_of_parts(motion, some),
            action,
            gesture,
            wrong=np.zeros(len(action)),
            most=most[action],
            every=GLANCE,
        )
        within = terms.sum(axis=1) <= most[action]
        found += [len(passes), passes.sum(), within.sum(), (within & ~passes).sum()]
    return found


def main() -> None:
    """Print every figure."""
    simulated = sum(
        looked_at(load_library().actions, doodle)
        for doodle in long_recording(duration_s=180.0, rate_hz=90.0).doodles
    )
    _, idle = idle_files()
    sessions = sessions_of(read_gestures(REPORTED, FRAME), read_idle(idle), TEACHINGS, seed=SEED)
    real = np.zeros(4, np.int64)
    for session in islice(sessions, SESSIONS):
        actions = [learned_action(name, list(own)) for name, own in session.examples.items()]
        real += looked_at(actions, session.free)
    for name, counted in (("simulated, shipped library", simulated), ("real sessions", real)):
        pairs, passing, within, lost = counted.tolist()
        print(
            f"{name}: {pairs} pairs of stretch and action, {passing / pairs:.1%} pass a glimpse; "
            f"of {within} within the limit {lost} are lost"
        )


if __name__ == "__main__":
    main()
