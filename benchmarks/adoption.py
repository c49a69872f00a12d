"""Bringing one's own: what is found out about clips, and what it costs.

`python -m benchmarks.adoption`. Stages and contacts are found in the shipped clips and compared
with those that were authored. The three constants of the stages were chosen on these very clips:
the figure is how well one rule can fit them, not how well it does on others.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from actions_library.folder import load_library
from actions_library.importers import import_file
from smd.character.clip import STAGES
from smd.character.contacts import contacts
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.character.stages import stage_end_frames

DATA = Path(__file__).parents[2] / "shared" / "data" / "clips"
LEG_M = 0.87
NEAR_FRAMES = 3
FRAMES, BLOCK = 1000, 50


def print_stages() -> None:
    """Print how near the found ends of stages are to the authored ones."""
    print(f"stages: ends within {NEAR_FRAMES} frames of the authored ones, at 60 Hz")
    near, apart = [], []
    for clip in load_library().clips.values():
        if clip.cyclic:
            continue
        _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
        found = stage_end_frames(place - place[:, :1], clip.rate_hz, cyclic=False)
        off = np.abs(found - clip.stage_end_frames)[:4]
        near.append(off <= NEAR_FRAMES)
        apart.append(off)
        shown = ", ".join(
            f"{a}/{b}" for a, b in zip(found[:4], clip.stage_end_frames, strict=False)
        )
        print(f"  {clip.name:12} found/authored {shown}")
    shares = 100.0 * np.mean(near, axis=0)
    medians = np.median(apart, axis=0)
    for stage, share, median in zip(STAGES, shares, medians, strict=False):
        print(f"  {stage:14} {share:5.1f} %  median {median:.0f} frames off")
    print(f"  all            {np.mean(shares):5.1f} % of {4 * len(near)}")


def print_contacts() -> None:
    """Print how the found contacts of feet agree with the authored ones."""
    right = found = wanted = 0
    for clip in load_library().clips.values():
        feet = [j for j in clip.contact_joints if "foot" in j or "toes" in j]
        if not feet:
            continue
        _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
        at = [clip.skeleton.index(joint) for joint in feet]
        rest = clip.skeleton.world_from_bind[at, 1, 3].tolist()
        said = contacts(place[:, at], rest, clip.rate_hz, LEG_M)
        authored = clip.contacts[:, [clip.contact_joints.index(joint) for joint in feet]]
        right += int((said & authored).sum())
        found += int(said.sum())
        wanted += int(authored.sum())
    print(f"contacts: precision {right / found:.3f}, recall {right / wanted:.3f}")


def seconds(work: Callable[[], object]) -> float:
    """Return the least of three times."""
    times = []
    for _ in range(3):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return min(times)


def print_costs() -> None:
    """Print what loading, importing and skinning cost."""
    print(f"loading the shipped library: {seconds(load_library):.2f} s")
    walk = DATA / "bvh" / "cmu_12_01_walk.bvh"
    if walk.is_file():
        head, _, motion = walk.read_text().partition("MOTION")
        rows = motion.strip().splitlines()[2:]
        rows = (rows * (4500 // len(rows) + 1))[:4500]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "long.bvh")
            text = f"{head}MOTION\nFrames: 4500\nFrame Time: 0.00833333\n" + "\n".join(rows)
            path.write_text(text)
            cost = seconds(lambda: import_file(path))
        print(f"importing a BVH file of 4500 frames and 31 joints: {cost:.2f} s")
    library = load_library()
    clip, character = library.clip("walk"), library.character
    rows_at = np.arange(FRAMES) % len(clip)
    rotation, translation = clip.rotation_xyzw[rows_at], clip.translation_m[rows_at]

    def pose() -> None:
        q, p = forward_kinematics(clip.skeleton, rotation, translation)
        for mesh in character.meshes:
            for start in range(0, FRAMES, BLOCK):
                part = slice(start, start + BLOCK)
                skin_points(mesh, clip.skeleton, q[part], p[part])

    points = sum(len(mesh.points_m) for mesh in character.meshes)
    print(f"kinematics and skinning of {FRAMES} poses, {points} points: {seconds(pose):.2f} s")


def main() -> None:
    """Print every figure."""
    print_stages()
    print_contacts()
    print_costs()


if __name__ == "__main__":
    main()
