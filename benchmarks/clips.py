"""How well the shipped clips are made: `python -m benchmarks.clips`.

Budgets, which the tests defend: planted joints move at most 0.02 m/s, no sole is more than 2 mm
under the ground, cyclic clips close to 1e-6 rad, knees and elbows bend 0 to 150 degrees, nothing
turns faster than 30 rad/s, and a slow body is at most 20 mm off its feet; who sits or lies rests
on more than soles.

Of the weight (`benchmarks/weight.py`): the mass centre has at most 8 m/s² over the ground, the zero
moment point is at most 35 cm outside the soles (95th percentile) and more than 20 cm in at most
8 % of the frames, the soles carry at least a tenth of the weight, flights fall at 0.8 to 1.3 g,
jumps rise 20 cm from their crouch and yield for 0.25 s, the parts of a blow are fastest in turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from actions_library.authoring.clips import humanoid_clips
from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.mass import SIDES, centre_of_mass
from actions_library.authoring.soles import SEATED_M, sole_parts, soles_in_world
from actions_library.folder import load_library
from actions_library.importers import import_file
from actions_library.importers.imported import Imported
from benchmarks.weight import HEADER, columns, over_ground_m_s2, weigh
from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.quality import pose_gap_rad
from smd.character.skinning import skin_points
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    rotate,
    rotvec_from_quaternion,
    sign_continuous,
)

SLOW_M_S = 0.10

LIMITS_DEG = {
    "neck yaw": (-80.0, 80.0),
    "neck lean": (-75.0, 55.0),
    "trunk yaw": (-45.0, 45.0),
    "trunk lean": (-25.0, 50.0),
    "trunk tilt": (-30.0, 30.0),
    "hip flexion": (-55.0, 160.0),
    "hip abduction": (-20.0, 45.0),
    "ankle": (-70.0, 60.0),
}
"""What a supple body reaches: head from chest, chest from pelvis, thigh from pelvis (bent up is
above 0), foot from shin (up is above 0). Between a squat and a split there is the pelvis's own
share, which the bend of the hip includes."""


CMU_JOINTS = {
    "hips": "Hips",
    "upper_chest": "Spine1",
    "neck": "Neck1",
    "head": "Head",
    **{
        f"{side.lower()}_{ours}": f"{side}{theirs}"
        for side in ("Left", "Right")
        for ours, theirs in {
            "upper_arm": "Arm",
            "lower_arm": "ForeArm",
            "hand": "Hand",
            "middle_proximal": "FingerBase",
            "upper_leg": "UpLeg",
            "lower_leg": "Leg",
            "foot": "Foot",
            "toes": "ToeBase",
        }.items()
    },
}
"""Joints that carry mass, as CMU's captures call them."""

CAPTURES = {"cmu_12_01_walk": "a walk", "01_01": "jumps forward and turns"}


@dataclass(frozen=True, slots=True)
class Quality:
    """One clip's figures; see the columns of the printed table."""

    slide_m_s: float
    lowest_sole_m: float
    pose_gap_rad: float
    seam_kink: float
    turn_rad_s: float
    feet_travel_m: float
    knee_deg: tuple[float, float]
    elbow_deg: tuple[float, float]
    hand_log_jerk: float
    off_balance_m: float
    beyond_limits_deg: float


def measure(clip: Clip) -> Quality:
    """Return a clip's figures."""
    rotation, position = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    return Quality(
        slide_m_s=contact_speed_m_s(clip, position),
        lowest_sole_m=lowest_sole_m(clip, rotation, position),
        pose_gap_rad=pose_gap_rad(clip),
        seam_kink=seam_kink(clip),
        turn_rad_s=float(np.linalg.norm(joint_velocity_rad_s(clip), axis=-1).max()),
        feet_travel_m=feet_travel_m(clip, position),
        knee_deg=bend_range_deg(clip, position, "upper_leg", "lower_leg", "foot"),
        elbow_deg=bend_range_deg(clip, position, "upper_arm", "lower_arm", "hand"),
        hand_log_jerk=max(
            log_dimensionless_jerk(
                position[:, clip.skeleton.index(f"{side}_hand")] - position[:, 0], clip.rate_hz
            )
            for side in SIDES
        ),
        off_balance_m=off_balance_m(clip, rotation, position),
        beyond_limits_deg=beyond_limits_deg(clip, rotation, position),
    )


def beyond_limits_deg(clip: Clip, rotation: FloatArray, position: FloatArray) -> float:
    """Return by how much any of `LIMITS_DEG` is exceeded; 0 or below where none is."""
    worst = -np.inf
    for name, angle in angles_deg(clip, rotation, position).items():
        low, high = LIMITS_DEG[name]
        worst = max(worst, float((low - angle).max()), float((angle - high).max()))
    return worst


def angles_deg(clip: Clip, rotation: FloatArray, position: FloatArray) -> dict[str, FloatArray]:
    """Return angles of joints over time, of both sides one after the other."""
    from scipy.spatial.transform import Rotation

    joint = clip.skeleton.index

    def between(above: str, below: str) -> FloatArray:
        local = multiply(inverse(rotation[:, joint(above)]), rotation[:, joint(below)])
        return np.degrees(Rotation.from_quat(local).as_euler("YXZ")).T

    def way(start: str, end: str) -> FloatArray:
        bone = position[:, joint(end)] - position[:, joint(start)]
        return bone / np.linalg.norm(bone, axis=-1, keepdims=True)

    neck, trunk = between("upper_chest", "head"), between("hips", "upper_chest")
    flexion, abduction, ankle = [], [], []
    for side, out in (("left", 1.0), ("right", -1.0)):
        upper, lower, foot, toes = (
            f"{side}_{part}" for part in ("upper_leg", "lower_leg", "foot", "toes")
        )
        thigh = rotate(inverse(rotation[:, joint("hips")]), way(upper, lower))
        flexion.append(np.degrees(np.arctan2(thigh[:, 2], -thigh[:, 1])))
        abduction.append(np.degrees(np.arcsin(np.clip(out * thigh[:, 0], -1.0, 1.0))))
        rest = [clip.skeleton.rest_translation_m[joint(part)] for part in (foot, toes)]
        at_rest = rest[0] @ rest[1] / np.linalg.norm(rest[0]) / np.linalg.norm(rest[1])
        cosine = np.sum(way(lower, foot) * way(foot, toes), axis=-1)
        bend = np.arccos(np.clip(cosine, -1.0, 1.0)) - np.arccos(at_rest)
        ankle.append(np.degrees(bend))
    return {
        "neck yaw": neck[0],
        "neck lean": neck[1],
        "trunk yaw": trunk[0],
        "trunk lean": trunk[1],
        "trunk tilt": trunk[2],
        "hip flexion": np.concatenate(flexion),
        "hip abduction": np.concatenate(abduction),
        "ankle": np.concatenate(ankle),
    }


def contact_speed_m_s(clip: Clip, position: FloatArray) -> float:
    """Return the greatest speed of a joint between two frames in which it is planted."""
    worst = 0.0
    for column, joint in enumerate(clip.contact_joints):
        path = position[:, clip.skeleton.index(joint)]
        speed = np.linalg.norm(np.diff(path, axis=0), axis=-1) * clip.rate_hz
        planted = clip.contacts[:-1, column] & clip.contacts[1:, column]
        worst = max(worst, float(speed[planted].max(initial=0.0)))
    return worst


def lowest_sole_m(clip: Clip, rotation: FloatArray, position: FloatArray) -> float:
    """Return the least height of any sole point over the clip."""
    return float(soles_in_world(clip.skeleton, rotation, position)[..., 1].min())


def joint_velocity_rad_s(clip: Clip) -> FloatArray:
    """Return every joint's angular velocity from frame to frame; a cycle goes round its seam."""
    q = clip.rotation_xyzw
    if clip.cyclic:
        q = sign_continuous(np.concatenate([q[:-1, 1:], q[:2, 1:]]))
    return rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:])) * clip.rate_hz


def seam_kink(clip: Clip) -> float:
    """Return the change of joint speeds over a cycle's seam, 1 being the greatest elsewhere."""
    jumps = np.linalg.norm(np.diff(joint_velocity_rad_s(clip), axis=0), axis=-1)
    return float(jumps[-1].max() / jumps[:-1].max())


def off_balance_m(clip: Clip, rotation: FloatArray, position: FloatArray) -> float:
    """Return how far the centre of mass leaves the planted soles while the body is slow.

    A body whose hips are lower than `SEATED_M` rests on more than its soles, and is left out.
    """
    from scipy.spatial import ConvexHull

    centre = centre_of_mass(clip.skeleton, position)
    speed = np.linalg.norm(np.gradient(centre, 1.0 / clip.rate_hz, axis=0), axis=-1)
    worst = 0.0
    standing = position[:, clip.skeleton.index("hips"), 1] > SEATED_M
    for frame in np.flatnonzero((speed < SLOW_M_S) & standing):
        soles = [
            position[frame, j] + rotate(rotation[frame, j], local)
            for joint, local in sole_parts(clip.skeleton)
            if joint in clip.contact_joints
            and clip.contacts[frame, clip.contact_joints.index(joint)]
            for j in [clip.skeleton.index(joint)]
        ]
        if soles:
            sides = ConvexHull(np.concatenate(soles)[:, [0, 2]]).equations
            beyond = float((sides[:, :2] @ centre[frame, [0, 2]] + sides[:, 2]).max())
            worst = max(worst, beyond)
    return worst


def feet_travel_m(clip: Clip, position: FloatArray) -> float:
    """Return how far the feet carry the body from the first to the last frame.

    A foot that takes off may land where it did not stand: what counts is their middle.
    """
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


def lowest_of_body_m(clip: Clip, character: Character) -> float:
    """Return the least height of the skinned meshes, over every third frame."""
    rotation, position = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    return min(
        float(skin_points(mesh, clip.skeleton, rotation[::3], position[::3])[..., 1].min())
        for mesh in character.meshes
    )


def captured_hand_log_jerk() -> float | None:
    """Return the hands' smoothness in CMU's walk, for comparison; None where it is absent."""
    imported = _captured("cmu_12_01_walk")
    if imported is None:
        return None
    part = imported.part(imported.animations[0], 1.0, 2.1)  # a cycle
    _, position = forward_kinematics(imported.skeleton, part.rotation_xyzw, part.translation_m)
    hips = position[:, 0]
    return max(
        log_dimensionless_jerk(
            position[:, imported.skeleton.index(f"{side}Hand")] - hips, part.rate_hz
        )
        for side in ("Left", "Right")
    )


def captured_acceleration_m_s2(name: str) -> FloatArray | None:
    """Return the mass centre's acceleration over the ground in a capture of CMU's, ``(k,)``."""
    imported = _captured(name)
    if imported is None:
        return None
    skeleton, whole = humanoid_skeleton(), imported.animations[0]
    part = imported.part(whole, 0.0, whole.duration_s)
    _, position = forward_kinematics(imported.skeleton, part.rotation_xyzw, part.translation_m)
    ours = np.zeros((len(position), len(skeleton), 3))
    for joint, theirs in CMU_JOINTS.items():
        ours[:, skeleton.index(joint)] = position[:, imported.skeleton.index(theirs)]
    return over_ground_m_s2(centre_of_mass(skeleton, ours), part.rate_hz)


def _captured(name: str) -> Imported | None:
    path = Path(__file__).parents[2] / "shared" / "data" / "clips" / "bvh" / f"{name}.bvh"
    return import_file(path) if path.is_file() else None


def main() -> None:
    """Print the table."""
    print("clip             frames  slide  lowest    pose    seam    turn  travel    feet", end="")
    print("     knee    elbow balance  hand    body")
    print("                           m/s      mm     rad           rad/s       m       m", end="")
    print("      deg      deg      mm   LDJ  mm low")
    character = load_library().character
    for clip in humanoid_clips(humanoid_skeleton()):
        q = measure(clip)
        closure = f"{q.pose_gap_rad:7.4f} {q.seam_kink:7.2f}" if clip.cyclic else 15 * " "
        print(
            f"{clip.name:16s} {len(clip):6d} {q.slide_m_s:6.3f} {1e3 * q.lowest_sole_m:7.1f}"
            f" {closure} {q.turn_rad_s:7.1f} {clip.travel_m:7.2f} {q.feet_travel_m:7.2f}"
            f" {q.knee_deg[0]:4.0f}-{q.knee_deg[1]:3.0f}"
            f" {q.elbow_deg[0]:4.0f}-{q.elbow_deg[1]:3.0f}"
            f" {1e3 * q.off_balance_m:7.1f} {q.hand_log_jerk:5.1f}"
            f" {1e3 * lowest_of_body_m(clip, character):7.0f}"
        )
    print(f"\n{HEADER}")
    for clip in humanoid_clips(humanoid_skeleton()):
        print(f"{clip.name:16s} {columns(weigh(clip))}")
    for name, shown in CAPTURES.items():
        if (level := captured_acceleration_m_s2(name)) is not None:
            p99 = np.percentile(level, 99)
            print(f"CMU's capture of {shown}: {p99:.1f} m/s2 p99, {level.max():.1f} m/s2 max")
    if (jerk := captured_hand_log_jerk()) is not None:
        print(f"a cycle of CMU's captured walk: hand LDJ {jerk:.1f}")


if __name__ == "__main__":
    main()
