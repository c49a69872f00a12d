"""Background: the cost of meaningless movement as an action, from synthetic movement.

Some gestures resemble much of what hands do, others nothing else. So the threshold of an action is
relative to the cost of movement that is not meant as anything, as in the cohort normalisation of
speaker verification [1]_.

References
----------
.. [1] R. Auckenthaler, M. Carey, H. Lloyd-Thomas, "Score Normalization for Text-Independent
   Speaker Verification Systems", Digital Signal Processing 10, 2000.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from laban import RigidMotion
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import multiply, quaternion_from_rotvec
from smd.recognition.exemplar import Exemplar
from smd.recognition.traits import Traits, traits_of_parts
from smd.recognition.verification import GLANCE, Verification
from smd.smoothing import smooth

SEED = 20261129
MOVERS, MOVER_S, RATE_HZ = 20, 30.0, 60.0
"""Number of synthetic hands, and how long each moves; ten minutes in all."""

STRETCHES = 240
"""Stretches of each hand's movement that are weighed."""

SHORTEST_S, LONGEST_S = 0.15, 12.0
"""How long they are; the logarithm is uniform."""

OWN_LENGTHS = (0.7, 1.4)
"""Stretches of this range of lengths, relative to an action's duration, are its background."""

QUANTILE = 0.02
"""The share of an action's background that costs less than its `background_of`."""

FEWEST = 100
"""Least number of stretches: for an action longer or shorter than all of the background, its
longest or shortest ones."""


class Background(NamedTuple):
    """Stretches of movement that mean nothing.

    Attributes
    ----------
    traits : of n stretches.
    duration_s : (n,).
    """

    traits: Traits
    duration_s: FloatArray


def weighed(exemplar: Exemplar) -> Exemplar:
    """Return an exemplar that knows its background."""
    return (
        exemplar
        if exemplar.background is not None
        else replace(exemplar, background=background_of(exemplar))
    )


def background_of(exemplar: Exemplar) -> float:
    """Return the log cost of meaningless movement that is weighed as an action.

    That is the `QUANTILE` of the costs of stretches of synthetic movement, about as long as the
    action's examples, compared with these examples, without tokens.
    """
    traits, duration_s = background()
    times = duration_s / exemplar.duration_s
    own = np.flatnonzero((times >= OWN_LENGTHS[0]) & (times <= OWN_LENGTHS[1]))
    if len(own) < FEWEST:
        own = np.argsort(np.abs(np.log(times)), kind="stable")[:FEWEST]
    verification = Verification((exemplar,))
    nearest = int(np.ceil(QUANTILE * (len(own) - 1))) + 1  # of these costs the quantile is one
    likely = np.argsort(verification.measured(traits.measures[own])[:, 0], kind="stable")
    most = np.inf
    costs = np.full(len(own), np.inf)
    for some in (likely[: 4 * nearest], likely[4 * nearest :]):
        terms = verification.terms(
            traits,
            np.zeros(len(some), np.int64),
            own[some],
            wrong=np.zeros(len(some)),
            most=np.full(len(some), most),
            every=GLANCE,
        )
        costs[some] = terms.sum(axis=1)
        most = float(np.partition(costs, nearest - 1)[nearest - 1])
    lowest = np.sort(costs)[:nearest]
    place = QUANTILE * (len(own) - 1)
    return float(np.log(np.interp(place, np.arange(nearest), lowest)))


@cache
def background() -> Background:
    """Return the stretches that every action is compared with; the same each time."""
    rng = np.random.default_rng(SEED)
    parts, durations = [], []
    for _ in range(MOVERS):
        motion = smooth(made_up_movement(rng, duration_s=MOVER_S))
        low, high = np.log([SHORTEST_S, LONGEST_S])
        length_s = np.exp(rng.uniform(low, high, STRETCHES))
        start_s = rng.uniform(motion.time_s[0], motion.time_s[-1] - length_s)
        parts.append(_traits(motion, start_s, length_s))
        durations.append(length_s)
    courses = tuple(
        np.concatenate(each) for each in zip(*(part.courses for part in parts), strict=True)
    )
    measures = np.concatenate([part.measures for part in parts])
    return Background(Traits(courses, measures), np.concatenate(durations))


def _traits(motion: RigidMotion, start_s: FloatArray, length_s: FloatArray) -> Traits:
    """Return the traits of stretches of a motion."""
    spans_s = np.column_stack([start_s, start_s + length_s])
    return traits_of_parts(motion, [(float(a), float(b)) for a, b in spans_s])


def made_up_movement(rng: np.random.Generator, *, duration_s: float) -> Doodle:
    """Return synthetic movement without meaning: a hand reaches somewhere, turns, waits and drifts.

    Strokes follow the minimum-jerk profile to random places. The size and pace of a hand's
    movement are drawn once. All numbers are ours.
    """
    time_s = np.arange(0.0, duration_s, 1.0 / RATE_HZ)
    reach_m, lively = np.exp(rng.normal(np.log(0.12), 0.8)), rng.uniform(0.2, 0.9)
    ends_s, places_m = [0.0], [np.zeros(3)]
    turn_rad, held = [], [quaternion_from_rotvec(rng.normal(0.0, 0.4, 3))]
    while ends_s[-1] < duration_s:
        ends_s.append(ends_s[-1] + float(np.exp(rng.normal(np.log(0.7), 0.45))))
        if rng.random() < lively:
            origin_m = np.zeros(3) if rng.random() < 0.8 else places_m[-1]
            places_m.append(origin_m + rng.normal(0.0, reach_m, 3))
            turn = rng.normal(0.0, 0.35, 3) * rng.uniform(0.2, 1.5)
        else:
            places_m.append(places_m[-1] + rng.normal(0.0, 0.01, 3))
            turn = rng.normal(0.0, 0.05, 3)
        turn_rad.append(turn)
        held.append(multiply(held[-1], quaternion_from_rotvec(turn)))
    stroke = np.searchsorted(ends_s, time_s, side="right") - 1
    u = (time_s - np.array(ends_s)[stroke]) / np.diff(ends_s)[stroke]
    done = (u**3 * (10.0 - 15.0 * u + 6.0 * u * u))[:, None]
    at_m = np.array(places_m)
    drift_m = np.cumsum(rng.normal(0.0, 0.3e-3, (len(time_s), 3)), axis=0)
    return Doodle(
        time_s,
        at_m[stroke] + done * (at_m[stroke + 1] - at_m[stroke]) + drift_m,
        multiply(np.array(held)[stroke], quaternion_from_rotvec(done * np.array(turn_rad)[stroke])),
    )
