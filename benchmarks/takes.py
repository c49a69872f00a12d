"""Long recordings to measure on."""

from __future__ import annotations

import numpy as np

from smd.doodle import Doodle, Recording
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take


def long_recording(
    *, duration_s: float, rate_hz: float, devices: int = 2, seed: int = 0
) -> Recording:
    """Return a play of every action in turn, again and again, by one simulated hand a device."""
    doodles = []
    for index in range(devices):
        rng = np.random.default_rng([seed, index])
        take = Take(simulated_person(rng), rng, start_m=(0.6 * index, 0.0, 0.0))
        while take.now_s < duration_s:
            for action in rng.permutation(list(GESTURES)):
                take.play(str(action)).pause(float(rng.uniform(0.4, 1.2)))
        whole = take.doodle(f"prop{index + 1}", rate_hz=rate_hz)
        n = int(np.searchsorted(whole.time_s, duration_s))
        doodles.append(
            Doodle(whole.time_s[:n], whole.position_m[:n], whole.orientation_xyzw[:n], whole.device)
        )
    return Recording(tuple(doodles), source=f"simulated, {duration_s:g} s")
