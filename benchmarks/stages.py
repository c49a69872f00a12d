"""Stages and contacts found in clips, beside the authored: `python -m benchmarks.stages`.

The goal was nine ends in ten within 3 frames, and is not met. So the table is followed by what any
choice among the slowest frames could reach, by the paper's rule, and by what the constants of ours
find in a clip that had no part in choosing them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from actions_library.folder import load_library
from smd.character import stages
from smd.character.clip import STAGES, Clip
from smd.character.contacts import contacts
from smd.character.kinematics import forward_kinematics
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import inverse, multiply, rotvec_from_quaternion

LEG_M = 0.87
NEAR_FRAMES = 3
SLOW = (0.1, 0.2, 0.3, 0.45, 0.6, 0.8)
"""Shares of the top speed below which the paper's rule may take a frame for still."""

CHOICES = {
    "LEAST_SWEEP": (0.01, 0.03, 0.06, 0.1),
    "LIVELY": (0.3, 0.5, 0.7, 0.85),
    "ARRIVED": (0.1, 0.2, 0.3, 0.45),
    "DEPARTED": (0.02, 0.05, 0.1, 0.2),
}
"""Constants of our rule, and what they might have been."""


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A clip with what the rules look at: joints from the ground root, and the body's speeds."""

    clip: Clip
    position_m: FloatArray
    speed_m_s: FloatArray
    turning_rad_s: FloatArray


def motion_of(clip: Clip) -> Motion:
    """Return a clip's motion; both speeds are norms over all joints."""
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    place = place - place[:, :1]
    velocity = np.gradient(place, 1.0 / clip.rate_hz, axis=0)
    q = clip.rotation_xyzw
    turns = rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:])) * clip.rate_hz
    turning = np.linalg.norm(turns, axis=(1, 2))
    return Motion(
        clip, place, np.linalg.norm(velocity, axis=(1, 2)), np.append(turning, turning[-1])
    )


def minima(speed: FloatArray) -> IntArray:
    """Return the frames that are as slow as both neighbours, and the first and last one."""
    inner = (speed[1:-1] <= speed[:-2]) & (speed[1:-1] <= speed[2:])
    return np.concatenate([[0], np.flatnonzero(inner) + 1, [len(speed) - 1]])


def found(motion: Motion) -> IntArray:
    """Return the ends of our rule."""
    clip = motion.clip
    return stages.stage_end_frames(
        motion.position_m, clip.rate_hz, cyclic=clip.cyclic, touches=clip.contacts
    )


def of_the_paper(motion: Motion, slow: float) -> IntArray:
    """Return the ends of section 6.1: still frames part the clip, the liveliest part executes."""
    speed = motion.speed_m_s
    lows = minima(speed).tolist()
    still = [0, *(i for i in lows[1:-1] if speed[i] < slow * speed.max()), len(speed) - 1]
    lively = [speed[a:b].max() * speed[a:b].sum() for a, b in pairwise(still)]
    main = next(i for i, value in enumerate(lively) if value >= stages.LIVELY * max(lively))
    last = len(still) - 1
    return np.array(still)[[max(main - 1, 0), main, main + 1, min(main + 2, last), last]]


def nearest(motion: Motion, frames: IntArray) -> IntArray:
    """Return of some frames the one nearest to each authored end: no rule chooses better."""
    apart = np.abs(frames[:, None] - motion.clip.stage_end_frames)
    return frames[apart.argmin(axis=0)]


def near(motion: Motion, ends: IntArray) -> FloatArray:
    """Return which of the first four ends are near the authored ones; the fifth is the last."""
    return (np.abs(ends - motion.clip.stage_end_frames)[:4] <= NEAR_FRAMES).astype(np.float64)


def share(motions: list[Motion], rule: Callable[[Motion], IntArray]) -> float:
    """Return the share of ends, in percent, that a rule finds."""
    return 100.0 * float(np.mean([near(motion, rule(motion)) for motion in motions]))


def left_out(motions: list[Motion]) -> tuple[float, float]:
    """Return the best share of any constants, and that in clips left out of choosing them."""
    kept = {name: getattr(stages, name) for name in CHOICES}
    shares = []
    try:
        for values in product(*CHOICES.values()):
            for name, value in zip(CHOICES, values, strict=True):
                setattr(stages, name, value)
            shares.append([near(motion, found(motion)).mean() for motion in motions])
    finally:
        for name, value in kept.items():
            setattr(stages, name, value)
    table = 100.0 * np.array(shares)
    others = (table.sum(axis=1, keepdims=True) - table).argmax(axis=0)
    return float(table.mean(axis=1).max()), float(table[others, np.arange(len(motions))].mean())


def contact_counts(clip: Clip) -> tuple[int, int, int]:
    """Return how many contacts of feet are rightly found, found, and authored."""
    feet = [j for j in clip.contact_joints if "foot" in j or "toes" in j]
    if not feet:
        return 0, 0, 0
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    at = [clip.skeleton.index(joint) for joint in feet]
    rest = clip.skeleton.world_from_bind[at, 1, 3].tolist()
    said = contacts(place[:, at], rest, clip.rate_hz, LEG_M)
    authored = clip.contacts[:, [clip.contact_joints.index(joint) for joint in feet]]
    return int((said & authored).sum()), int(said.sum()), int(authored.sum())


def print_stages(motions: list[Motion]) -> None:
    """Print found and authored ends, and how near they are."""
    print(f"stages: found/authored ends; near is within {NEAR_FRAMES} frames")
    once = [motion for motion in motions if not motion.clip.cyclic]
    for motion in once:
        pairs = zip(found(motion)[:4], motion.clip.stage_end_frames, strict=False)
        shown = " ".join(f"{f'{a}/{b}':>8}" for a, b in pairs)
        print(
            f"  {motion.clip.name:12} {shown}   near {near(motion, found(motion)).sum():.0f} of 4"
        )
    each = 100.0 * np.mean([near(motion, found(motion)) for motion in once], axis=0)
    print("  " + ", ".join(f"{n} {s:.1f} %" for n, s in zip(STAGES, each, strict=False)))
    print(f"ours: {share(once, found):.1f} % of {4 * len(once)} ends")
    cyclic = [motion for motion in motions if motion.clip.cyclic]
    print(f"with {len(cyclic)} cycles, told to be all execution: {share(motions, found):.1f} %")
    papers = {slow: share(once, lambda m, s=slow: of_the_paper(m, s)) for slow in SLOW}
    print("the paper's: " + ", ".join(f"still below {s:.0%} {v:.1f} %" for s, v in papers.items()))
    best, out = left_out(once)
    print(f"ours with the best constants: {best:.1f} %, in clips left out: {out:.1f} %")
    print(
        "the best choice among minima of speed:"
        f" {share(once, lambda m: nearest(m, minima(m.speed_m_s))):.1f} %, of turning:"
        f" {share(once, lambda m: nearest(m, minima(m.turning_rad_s))):.1f} %"
    )


def print_contacts(clips: list[Clip]) -> None:
    """Print how found contacts of feet agree with the authored ones."""
    print("contacts of feet: precision, recall")
    counts = {clip.name: contact_counts(clip) for clip in clips}
    counts["all"] = tuple(sum(column) for column in zip(*counts.values(), strict=True))
    for name, (right, said, authored) in counts.items():
        if said and authored:
            print(f"  {name:16} {right / said:.3f} {right / authored:.3f}")


def main() -> None:
    """Print every figure."""
    clips = list(load_library().clips.values())
    print_stages([motion_of(clip) for clip in clips])
    print_contacts(clips)


if __name__ == "__main__":
    main()
