"""Posing the shipped humanoid: `OMP_NUM_THREADS=1 python -m benchmarks.skinning`.

Budget: kinematics and skinning of 1000 frames take at most 0.5 s on one core. The first run is
told apart: in it the system hands out the memory of all points, 0.45 GB, which may take longer
than the work. Blocks that fit the cache were tried for both, and were slower.

With all shapes of its face at some weight it takes at most 1.6 times as long, in the same run.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from actions_library.folder import load_library
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.arrays import FloatArray
from tests.naive.skinning import skinned

FRAMES = 1000
PLAIN_FRAMES = 50
"""Of the plain version only: it is linear in the frames, and slow."""

TIMES = 9


def costs(work: Callable[[], object]) -> FloatArray:
    """Return wall and CPU time of each of several runs, ``(TIMES, 2)``, in seconds."""
    return np.array([once(work) for _ in range(TIMES)])


def once(work: Callable[[], object]) -> list[float]:
    """Return wall and CPU time of a run, in seconds."""
    wall, cpu = time.perf_counter(), time.process_time()
    work()
    return [time.perf_counter() - wall, time.process_time() - cpu]


def told(spent: FloatArray) -> str:
    """Return times in words: the first run, then the median and range of the others."""
    first, later = spent[0, 0], spent[1:]
    (wall, cpu), low, high = np.median(later, axis=0), later[:, 0].min(), later[:, 0].max()
    return f"first {first:.3f}, then {wall:.3f} s ({low:.3f} to {high:.3f}), CPU {cpu:.3f} s"


def main() -> None:
    """Print what posing costs, how many times faster than plainly, and how far apart both are."""
    library = load_library()
    clip, meshes = library.clip("walk"), library.character.meshes
    rows = np.arange(FRAMES) % len(clip)
    rotation, translation = clip.rotation_xyzw[rows], clip.translation_m[rows]
    q, p = forward_kinematics(clip.skeleton, rotation, translation)

    rng = np.random.default_rng(0)
    weights = {mesh.name: rng.uniform(size=(FRAMES, len(mesh.shapes))) for mesh in meshes}

    def fast() -> None:
        turned, placed = forward_kinematics(clip.skeleton, rotation, translation)
        for mesh in meshes:
            skin_points(mesh, clip.skeleton, turned, placed)

    def shaped() -> None:
        turned, placed = forward_kinematics(clip.skeleton, rotation, translation)
        for mesh in meshes:
            skin_points(mesh, clip.skeleton, turned, placed, weights[mesh.name])

    def plain() -> None:
        for frame in range(PLAIN_FRAMES):
            for mesh in meshes:
                skinned(mesh, clip.skeleton, q[frame], p[frame])

    kinematics = costs(lambda: forward_kinematics(clip.skeleton, rotation, translation))
    whole, slow = costs(fast), costs(plain) * FRAMES / PLAIN_FRAMES
    # By turns, since the machine may be faster or slower a minute later.
    turns = np.array([[once(fast), once(shaped)] for _ in range(TIMES)])
    face = np.median(turns[1:, 1] / turns[1:, 0], axis=0)
    ratio = np.median(slow[1:], axis=0) / np.median(whole[1:], axis=0)
    apart = max(
        np.abs(
            skin_points(m, clip.skeleton, q[f], p[f]) - skinned(m, clip.skeleton, q[f], p[f])
        ).max()
        for m in meshes
        for f in range(0, len(clip), 8)
    )
    points = sum(len(mesh.points_m) for mesh in meshes)
    print(f"{FRAMES} poses of {points} points: {told(whole)}")
    print(f"of it kinematics: {told(kinematics)}")
    moved = {m.name: {*np.concatenate([s.indices for s in m.shapes])} for m in meshes if m.shapes}
    count, of_points = len(library.character.shapes), sum(map(len, moved.values()))
    print(
        f"with {count} shapes of {of_points} points: {told(turns[:, 1])}\n"
        f"  {face[0]:.2f} times as long as without by the clock, {face[1]:.2f} by CPU time"
    )
    print(f"plainly, from {PLAIN_FRAMES} poses: {told(slow)}")
    print(f"{ratio[0]:.0f} times as fast by the clock, {ratio[1]:.0f} times by CPU time")
    print(f"greatest difference of a coordinate: {1e6 * apart:.2f} µm")


if __name__ == "__main__":
    main()
