"""Posing the shipped humanoid: `OMP_NUM_THREADS=1 python -m benchmarks.skinning`.

Budget: kinematics and skinning of 1000 frames take at most 0.5 s on one core.
"""

from __future__ import annotations

import numpy as np

from actions_library.folder import load_library
from benchmarks.adoption import seconds
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from tests.naive.skinning import skinned

FRAMES = 1000
PLAIN_FRAMES = 50
"""Of the plain version only: it is linear in the frames, and slow."""


def main() -> None:
    """Print what posing costs, how many times faster than plainly, and how far apart both are."""
    library = load_library()
    clip, meshes = library.clip("walk"), library.character.meshes
    rows = np.arange(FRAMES) % len(clip)
    rotation, translation = clip.rotation_xyzw[rows], clip.translation_m[rows]
    q, p = forward_kinematics(clip.skeleton, rotation, translation)

    def fast() -> None:
        turned, placed = forward_kinematics(clip.skeleton, rotation, translation)
        for mesh in meshes:
            skin_points(mesh, clip.skeleton, turned, placed)

    def plain() -> None:
        for frame in range(PLAIN_FRAMES):
            for mesh in meshes:
                skinned(mesh, clip.skeleton, q[frame], p[frame])

    kinematics = seconds(lambda: forward_kinematics(clip.skeleton, rotation, translation))
    whole, slow = seconds(fast), seconds(plain) * FRAMES / PLAIN_FRAMES
    apart = max(
        np.abs(
            skin_points(m, clip.skeleton, q[f], p[f]) - skinned(m, clip.skeleton, q[f], p[f])
        ).max()
        for m in meshes
        for f in range(0, len(clip), 8)
    )
    points = sum(len(mesh.points_m) for mesh in meshes)
    print(f"{FRAMES} poses of {points} points: {whole:.2f} s, of it kinematics {kinematics:.3f} s")
    print(f"plainly: {slow:.1f} s (from {PLAIN_FRAMES} poses), {slow / whole:.0f} times as long")
    print(f"greatest difference of a coordinate: {1e6 * apart:.2f} µm")


if __name__ == "__main__":
    main()
