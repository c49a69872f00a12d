"""What aligning two gestures costs beside C alone: ``python -m benchmarks.alignment``.

Budget: the distance of two 6-D courses of 120 samples within 1.5 times what ``dtaidistance`` takes
for it when its C code is called directly, in one run; their path likewise.
"""

from __future__ import annotations

import timeit
from collections.abc import Callable
from statistics import median

import numpy as np
from dtaidistance import dtw_cc

from benchmarks.process import machine
from smd.recognition.alignment import align, distance, distances
from smd.recognition.embedding import embed_poses, sample_poses
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

ROUNDS, CALLS = 15, 40


def microseconds(*jobs: Callable[[], object]) -> list[float]:
    """Return the median time of a call of each job, the jobs taking turns."""
    times = [[timeit.timeit(job, number=CALLS) for job in jobs] for _ in range(ROUNDS)]
    return [1e6 * median(column) / CALLS for column in zip(*times, strict=True)]


def main() -> None:
    print(machine())
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 120, 6)).cumsum(axis=1)
    wide = 120 // 10 + 1
    rows = (
        ("distance", lambda: distance(a, b), lambda: dtw_cc.distance_ndim(a, b)),
        (
            "distance, band of 0.1",
            lambda: distance(a, b, band=0.1),
            lambda: dtw_cc.distance_ndim(a, b, window=wide),
        ),
        (
            "path and distance",
            lambda: align(a, b),
            lambda: dtw_cc.warping_path_ndim(a, b, 6, include_distance=True),
        ),
    )
    print("\ntwo courses of 120 samples, 6-D, microseconds a call")
    for name, ours, theirs in rows:
        mine, bare = microseconds(ours, theirs)
        print(f"{name:24} {mine:7.1f}   C alone {bare:7.1f}   ratio {mine / bare:.2f}")

    courses = [
        embed_poses(sample_poses(Take(simulated_person(rng), rng).play(action).doodle()))
        for action in GESTURES
    ]
    (each,) = microseconds(lambda: distances(courses[0], courses, band=0.1))
    print(f"\none gesture against {len(courses)} others (64 poses, 12-D, band 0.1): {each:.0f} us")


if __name__ == "__main__":
    main()
