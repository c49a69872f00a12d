"""How well the shipped clips are made: `python -m benchmarks.clips`.

Budgets: planted feet move at most 0.02 m/s, no sole is more than 2 mm under the ground, cyclic
clips close to 1e-6, knees and elbows bend between 0 and 150 degrees.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.clips import humanoid_clips
from actions_library.authoring.feet import FootShape
from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.posing import foot_shape
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import rotate

TOE_LENGTH_M = 0.070
SIDES = ("left", "right")


@dataclass(frozen=True, slots=True)
class Quality:
    """One clip's figures; see the columns of the printed table."""

    slide_m_s: float
    lowest_sole_m: float
    pose_gap_rad: float
    speed_gap_rad_s: float
    feet_travel_m: float
    knee_deg: tuple[float, float]
    elbow_deg: tuple[float, float]
    hand_log_jerk: float
    off_balance_m: float


def measure(clip: Clip) -> Quality:
    """Return a clip's figures."""
    rotation, position = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    return Quality(
        slide_m_s=contact_speed_m_s(clip, position),
        lowest_sole_m=lowest_sole_m(clip, rotation, position),
        pose_gap_rad=pose_gap_rad(clip),
        speed_gap_rad_s=speed_gap_rad_s(clip),
        feet_travel_m=feet_travel_m(clip, position),
        knee_deg=bend_range_deg(clip, position, "upper_leg", "lower_leg", "foot"),
        elbow_deg=bend_range_deg(clip, position, "upper_arm", "lower_arm", "hand"),
        hand_log_jerk=max(
            log_dimensionless_jerk(
                position[:, clip.skeleton.index(f"{side}_hand")] - position[:, 0], clip.rate_hz
            )
            for side in SIDES
        ),
        off_balance_m=0.0,
    )


def contact_speed_m_s(clip: Clip, position: FloatArray) -> float:
    """Return the greatest speed of a joint between two frames in which it is planted."""
    worst = 0.0
    for column, joint in enumerate(clip.contact_joints):
        path = position[:, clip.skeleton.index(joint)]
        speed = np.linalg.norm(np.diff(path, axis=0), axis=-1) * clip.rate_hz
        planted = clip.contacts[:-1, column] & clip.contacts[1:, column]
        worst = max(worst, float(speed[planted].max(initial=0.0)))
    return worst


def sole_points(shape: FootShape) -> tuple[FloatArray, FloatArray]:
    """Return sole points from the ankle (heel, ball) and from the toes' joint (ball, tip)."""
    ball = np.array([shape.ball[0], -shape.ankle_height, shape.ball[2]])
    toe_height = shape.ankle_height + shape.ball[1]
    tip = np.array([0.0, -toe_height, TOE_LENGTH_M])
    return np.stack([shape.heel, ball]), np.stack([[0.0, -toe_height, 0.0], tip])


def lowest_sole_m(clip: Clip, rotation: FloatArray, position: FloatArray) -> float:
    """Return the least height of any sole point over the clip."""
    lowest = np.inf
    for side in SIDES:
        points = sole_points(foot_shape(clip.skeleton, side))
        for joint, local in zip(("foot", "toes"), points, strict=True):
            j = clip.skeleton.index(f"{side}_{joint}")
            world = position[:, j, None] + rotate(rotation[:, j, None], local)
            lowest = min(lowest, float(world[..., 1].min()))
    return lowest


def pose_gap_rad(clip: Clip) -> float:
    """Return the greatest difference of a joint's local turn between first and last frame."""
    dots = np.abs(np.sum(clip.rotation_xyzw[0, 1:] * clip.rotation_xyzw[-1, 1:], axis=-1))
    return float(2.0 * np.arccos(np.clip(dots, -1.0, 1.0)).max())


def speed_gap_rad_s(clip: Clip) -> float:
    """Return the greatest jump of a joint's angular speed over the seam, less its usual change."""
    q = np.concatenate([clip.rotation_xyzw[-3:-1, 1:], clip.rotation_xyzw[:3, 1:]])
    q = q * np.sign(np.sum(q * q[2], axis=-1, keepdims=True))
    velocity = 2.0 * np.diff(q, axis=0) * clip.rate_hz
    jumps = np.linalg.norm(np.diff(velocity, axis=0), axis=-1)
    return float((jumps[1] - np.maximum(jumps[0], jumps[2])).max())


def feet_travel_m(clip: Clip, position: FloatArray) -> float:
    """Return how far the feet carry the body from the first to the last frame."""
    feet = [clip.skeleton.index(f"{side}_foot") for side in SIDES]
    step = (position[-1, feet] - position[0, feet]).mean(axis=0)
    return float(np.hypot(step[0], step[2]))


def bend_range_deg(
    clip: Clip, position: FloatArray, upper: str, middle: str, end: str
) -> tuple[float, float]:
    """Return the least and the greatest bend of both sides' joint."""
    bends = []
    for side in SIDES:
        u, m, e = (position[:, clip.skeleton.index(f"{side}_{j}")] for j in (upper, middle, end))
        a, b = m - u, e - m
        cosine = np.sum(a * b, axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
        bends.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return float(np.min(bends)), float(np.max(bends))


def log_dimensionless_jerk(path_m: FloatArray, rate_hz: float) -> float:
    """Return a path's smoothness: nearer 0 is smoother [1]_.

    References
    ----------
    .. [1] S. Balasubramanian, A. Melendez-Calderon, E. Burdet, "A Robust and Sensitive Metric
       for Quantifying Movement Smoothness", IEEE Trans. Biomed. Eng. 59, 2012.
    """
    velocity = np.gradient(path_m, 1.0 / rate_hz, axis=0)
    jerk = np.gradient(np.gradient(velocity, 1.0 / rate_hz, axis=0), 1.0 / rate_hz, axis=0)
    peak = np.linalg.norm(velocity, axis=-1).max()
    duration = (len(path_m) - 1) / rate_hz
    return float(-np.log(duration**3 / peak**2 * np.sum(jerk**2) / rate_hz))


def main() -> None:
    """Print the table."""
    print("clip             frames  slide  lowest    pose   speed  travel    feet", end="")
    print("        knee       elbow  hand")
    print("                           m/s      mm     rad   rad/s       m       m", end="")
    print("         deg         deg   LDJ")
    for clip in humanoid_clips(humanoid_skeleton()):
        q = measure(clip)
        closure = f"{q.pose_gap_rad:7.4f} {q.speed_gap_rad_s:7.2f}" if clip.cyclic else 15 * " "
        print(
            f"{clip.name:16s} {len(clip):6d} {q.slide_m_s:6.3f} {1e3 * q.lowest_sole_m:7.1f}"
            f" {closure} {clip.travel_m:7.2f} {q.feet_travel_m:7.2f}"
            f" {q.knee_deg[0]:5.0f}-{q.knee_deg[1]:5.0f}"
            f" {q.elbow_deg[0]:5.0f}-{q.elbow_deg[1]:5.0f}"
            f" {q.hand_log_jerk:5.1f}"
        )


if __name__ == "__main__":
    main()
