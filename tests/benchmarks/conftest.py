"""Made-up people for what composes and scores sessions."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.gestures import Gestures
from smd.doodle import Doodle
from smd.geometry.rotations import quaternion_from_rotvec

CLASSES, TAKES = 8, 5


def stroke(label: int, seed: int, rate_hz: float = 30.0) -> Doodle:
    """Return a take of a made-up gesture: to a place and back, each class to another one."""
    rng = np.random.default_rng([label, seed])
    count = int(rng.uniform(1.0, 1.4) * rate_hz)
    s = np.arange(count) / (count - 1)
    out = np.sin(np.pi * s ** rng.uniform(0.8, 1.25)) ** 2
    angle = 2.0 * np.pi * label / CLASSES + rng.normal(0.0, 0.1)
    to_m = rng.normal(0.3, 0.05) * np.array(
        [np.cos(angle), np.sin(angle), 0.3 * np.sin(3.0 * angle)]
    )
    start_m = rng.normal(0.0, 0.1, 3)
    turn = quaternion_from_rotvec(out[:, None] * rng.normal(0.4, 0.2, 3))
    return Doodle(np.arange(count) / rate_hz, start_m + out[:, None] * to_m, turn)


def idling(seed: int, duration_s: float = 20.0, rate_hz: float = 72.0) -> Doodle:
    """Return a hand that sways a little."""
    rng = np.random.default_rng([99, seed])
    time_s = np.arange(int(duration_s * rate_hz)) / rate_hz
    phase = rng.uniform(0.0, 2.0 * np.pi, 3)
    position_m = 0.02 * np.sin(time_s[:, None] * [1.0, 1.7, 2.3] + phase)
    turn = quaternion_from_rotvec(0.1 * np.sin(time_s[:, None] * [0.9, 1.3, 0.7] + phase))
    return Doodle(time_s, position_m, turn)


@pytest.fixture(scope="session")
def people() -> Gestures:
    """Two people with five takes of each of eight gestures, and one with a few."""
    of = [(1, label, take) for label in range(1, CLASSES + 1) for take in range(TAKES)]
    of += [(2, label, 10 + take) for label in range(1, CLASSES + 1) for take in range(TAKES)]
    of += [(3, label, 20) for label in range(1, 4)]
    doodles = tuple(stroke(label, take) for _, label, take in of)
    person, label = (np.array([one[i] for one in of]) for i in (0, 1))
    return Gestures(doodles, label, person)


@pytest.fixture(scope="session")
def idle() -> list[Doodle]:
    return [idling(seed) for seed in range(3)]
