"""Grounding: inverse kinematics brings a character's legs to its foot contacts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smd.acting.balance import balance_shift
from smd.acting.flight import LOWEST
from smd.acting.footing import footing
from smd.acting.legs import Leg, pelvis_of, sole_height, yaw_of
from smd.acting.move import Footwork
from smd.acting.slope import Slope
from smd.acting.stepping import stepping
from smd.character.ik import two_bone_ik
from smd.character.kinematics import joints_in_world
from smd.character.mass import Mass
from smd.character.poses import Poses
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.geometry.rotations import inverse, multiply, quaternion_about, rotate

SOFTNESS = 0.004
"""Last share of a leg's reach, in which it straightens more and more slowly."""

MOST_SINK_M = 0.12
"""Most that the pelvis is lowered so that a standing leg reaches its foot."""

MOST_SINK = 0.15
"""The same as a share of a leg's reach: less where legs are short."""

MOST_BEND_RAD = np.radians(150.0)
"""Of a knee; a contact nearer to the hip than this allows is released."""

MOST_TWIST_RAD = np.radians(70.0)
"""Of a foot from its heading in the poses: a body that turns farther takes it along."""

FREED_S, LOOSE_M = 0.12, 0.15
"""Time in which a foot becomes free after it leaves the ground, and before it lands; and the most
that it is then moved from its position in the poses."""

SINKING_S = 0.12
"""Time in which the pelvis is lowered and raised again."""


def grounded(
    skeleton: Skeleton,
    poses: Poses,
    footwork: Footwork,
    legs: Sequence[Leg],
    rate_hz: float,
    rise: Rise | None = None,
    slope: Slope | None = None,
    mass: Mass | None = None,
) -> Poses:
    """Return poses without foot sliding and without feet in the ground.

    Parameters
    ----------
    poses
        With the ground root at its position.
    footwork
        When each of the legs' feet should stand, and how the clip itself pivots it.
    rise
        How much higher than in the poses body and feet are.
    slope
        What they stand on, where the ground is not level.
    mass
        Where the body's weight is, if it is to be brought over the feet.
    """
    stands, pivot_rad = footwork
    rise = rise or level(len(stands))
    k, weighing = len(legs), [] if mass is None else mass.joints.tolist()
    joints = [*(leg.foot for leg in legs), *(leg.upper for leg in legs), *weighing]
    world_q, place_m = joints_in_world(skeleton, joints, *poses)
    raw = [(world_q[:, i], place_m[:, i]) for i in range(k)]
    own_hips = [place_m[:, k + i] for i in range(k)]
    ridden_m = 0.0 if slope is None else slope.body_m
    higher_m = (rise.body_m + ridden_m)[:, None] * [0.0, 1.0, 0.0]
    hips = [hip_m + higher_m for hip_m in own_hips]
    stands, lift_m = _stepping(legs, raw, stands, pivot_rad, rate_hz)
    pelvis = pelvis_of(skeleton, legs)
    feet = _feet(legs, raw, hips, stands, pivot_rad, lift_m, rise, slope, rate_hz)
    moved_m = np.zeros_like(poses.translation_m[:, 0])
    if mass is not None and pelvis is not None:
        centre_m = mass.mean_m(place_m[:, 2 * k :])
        moved_m[:, [0, 2]] = _balancing(centre_m, mass, feet, rise, rate_hz)
        hips = [hip_m + moved_m for hip_m in hips]
        feet = _feet(legs, raw, hips, stands, pivot_rad, lift_m, rise, slope, rate_hz)
    rotation, translation = poses.rotation_xyzw.copy(), poses.translation_m.copy()
    translation[:, pelvis or 0, 1] += rise.body_m
    translation[:, 0, 1] += ridden_m
    sunk_m = np.zeros_like(translation[:, 0])
    if pelvis is not None:
        short_m, room_m = (np.stack(part) for part in zip(*(f[6:] for f in feet), strict=True))
        sunk_m[:, 1] = _sunk(short_m.max(axis=0), room_m.min(axis=0), rate_hz)
        sunk_m[:, 1] = _straight(sunk_m[:, 1], rise.flies)
        translation[:, pelvis] -= sunk_m
        if mass is not None:
            translation[:, pelvis] += rotate(inverse(rotation[:, 0]), moved_m)
    for i, foot in enumerate(feet):
        free = smootherstep(_frames_to(foot.stands) / (FREED_S * rate_hz))[:, None]
        own_m = raw[i][1] + higher_m - sunk_m + free * moved_m  # the leg's own, with the body
        level_m = foot.ankle_m - foot.laid_m
        ankle_m = own_m + _loosened(level_m - own_m, stands[:, i], rate_hz) + foot.laid_m
        if slope is not None:
            in_ground_m = -slope.sole_height(legs[i], foot.rotation_xyzw, ankle_m)
            ankle_m[:, 1] += np.maximum(in_ground_m, 0.0)
        _bring(skeleton, foot._replace(ankle_m=ankle_m), rotation, translation)
    return Poses(rotation, translation)


class Rise(NamedTuple):
    """How much higher than in the poses a body is, and its feet are.

    Attributes
    ----------
    body_m, feet_m : (n,) in metres.
    flies : (n,) when the body is in free fall.
    """

    body_m: FloatArray
    feet_m: FloatArray
    flies: BoolArray


def level(frames: int) -> Rise:
    """Return the rise of a body that moves as in its poses: zero."""
    return Rise(np.zeros(frames), np.zeros(frames), np.zeros(frames, dtype=bool))


class _Foot(NamedTuple):
    """Where a foot goes: its rotation and ankle in the world.

    ``laid_m`` is how much of it is due to the ground's not being level;
    ``stands`` is when it stands; ``able`` is when the leg can hold it there;
    ``short_m`` is how much too high the hip is for the leg to reach a standing foot, 0 otherwise;
    ``room_m`` how far it may sink before the knee of a standing foot is bent too much.
    """

    leg: Leg
    rotation_xyzw: FloatArray
    ankle_m: FloatArray
    laid_m: FloatArray
    stands: BoolArray
    able: BoolArray
    short_m: FloatArray
    room_m: FloatArray


def _feet(
    legs: Sequence[Leg],
    raw: Sequence[tuple[FloatArray, FloatArray]],
    hips: Sequence[FloatArray],
    stands: BoolArray,
    pivot_rad: FloatArray,
    lift_m: FloatArray,
    rise: Rise,
    slope: Slope | None,
    rate_hz: float,
) -> list[_Foot]:
    """Return where all feet go."""
    feet = []
    for i, leg in enumerate(legs):
        by = (pivot_rad[:, i], lift_m[:, i], rise.feet_m, slope, rate_hz)
        foot = _put(leg, raw[i], hips[i], stands[:, i], *by)
        if not foot.able.all():  # let go of the ground earlier, or take hold of it later
            foot = _put(leg, raw[i], hips[i], stands[:, i] & foot.able, *by)
        feet.append(foot)
    return feet


def _balancing(
    centre_m: FloatArray, mass: Mass, feet: Sequence[_Foot], rise: Rise, rate_hz: float
) -> FloatArray:
    """Return how far over the ground a body is moved ``(n, 2)`` for its weight's sake."""
    centre_m = centre_m + rise.body_m[:, None] * [0.0, 1.0, 0.0]
    soles = [
        [foot.ankle_m + rotate(foot.rotation_xyzw, point) for point in (f.heel_m, f.ball_m)]
        for foot, f in ((foot, foot.leg) for foot in feet)
    ]
    soles_m = np.moveaxis(np.array(soles)[..., [0, 2]], 2, 0)
    stands = np.stack([foot.stands for foot in feet], axis=1)
    return balance_shift(centre_m, soles_m, stands, rise.flies, mass.height_m, rate_hz)


def _put(
    leg: Leg,
    raw: tuple[FloatArray, FloatArray],
    hip_m: FloatArray,
    stands: BoolArray,
    pivot_rad: FloatArray,
    lift_m: FloatArray,
    risen_m: FloatArray,
    slope: Slope | None,
    rate_hz: float,
) -> _Foot:
    """Remove the sliding of a foot, and find whether its leg reaches it."""
    step = footing(leg, *raw, stands, pivot_rad, lift_m, rate_hz)
    about = quaternion_about([0.0, 1.0, 0.0], step.turn_rad)
    foot_q, ankle_m = multiply(about, raw[0]), raw[1] + step.shift_m
    ankle_m[:, 1] += np.maximum(risen_m, (LOWEST - 1.0) * sole_height(leg, foot_q, ankle_m))
    laid_m = np.zeros_like(ankle_m)
    if slope is not None:
        level_m = ankle_m + slope.body_m[:, None] * [0.0, 1.0, 0.0]
        foot_q, ankle_m = slope.laid(leg, foot_q, ankle_m, step.stands, rate_hz)
        laid_m = ankle_m - level_m
    reach_m = leg.limb.reach_m * (1.0 - SOFTNESS)
    aside_m = np.hypot(*(hip_m - ankle_m)[:, [0, 2]].T)
    above_m = hip_m[:, 1] - ankle_m[:, 1]
    highest_m, lowest_m = (
        np.sqrt(np.maximum(span_m**2 - aside_m**2, 0.0))
        for span_m in (reach_m, leg.limb.span_m(MOST_BEND_RAD))
    )
    most_m = min(MOST_SINK_M, MOST_SINK * leg.limb.reach_m)
    short_m = np.where(step.stands, np.maximum(above_m - highest_m, 0.0), 0.0)
    room_m = np.where(step.stands, np.maximum(above_m - lowest_m, 0.0), np.inf)
    able = (short_m <= most_m) & (np.abs(step.turn_rad) <= MOST_TWIST_RAD)
    able &= np.hypot(aside_m, above_m) >= leg.limb.span_m(MOST_BEND_RAD)
    return _Foot(
        leg, foot_q, ankle_m, laid_m, step.stands, able, np.minimum(short_m, most_m), room_m
    )


def _loosened(offset_m: FloatArray, stands: BoolArray, rate_hz: float) -> FloatArray:
    """Return how far a foot is moved from its position in the poses, limited where it is free.

    Between two contacts this offset is interpolated. In a roll or a leap the body moves elsewhere,
    and the leg would be stretched straight, or pulled through the hip, on the way.

    Parameters
    ----------
    offset_m
        ``(n, 3)`` as interpolated.
    stands
        When it should stand, on the ground or just above it.
    """
    free = smootherstep(_frames_to(stands) / (FREED_S * rate_hz))
    share = np.hypot(offset_m[:, 0], offset_m[:, 2]) * free / LOOSE_M
    less = 1.0 / (1.0 + share**4) ** 0.25
    return offset_m * np.stack([less, np.ones_like(less), less], axis=-1)


def _frames_to(true: BoolArray) -> FloatArray:
    """Return each frame's distance in frames to the nearest that is true."""
    frames, at = np.arange(len(true)), np.flatnonzero(true)
    if len(at) == 0:
        return np.full(len(true), float(len(true)))
    after = np.searchsorted(at, frames)
    left, right = at[np.maximum(after - 1, 0)], at[np.minimum(after, len(at) - 1)]
    return np.minimum(np.abs(frames - left), np.abs(frames - right)).astype(np.float64)


def _stepping(
    legs: Sequence[Leg],
    raw: Sequence[tuple[FloatArray, FloatArray]],
    stands: BoolArray,
    pivot_rad: FloatArray,
    rate_hz: float,
) -> tuple[BoolArray, FloatArray]:
    """Return when feet stand, with the necessary steps, and how high these lift them."""
    if not legs:
        return stands, np.zeros(stands.shape)
    # A foot rolls over its ball without getting anywhere.
    balls = [p + rotate(q, leg.ball_m) for leg, (q, p) in zip(legs, raw, strict=True)]
    place = np.stack([ball[:, [0, 2]] for ball in balls], axis=1)
    yaw = np.stack([yaw_of(leg, q) for leg, (q, _) in zip(legs, raw, strict=True)], axis=1)
    return stepping(place, yaw - pivot_rad, stands, np.array([leg.left_m for leg in legs]), rate_hz)


def _sunk(short_m: FloatArray, room_m: FloatArray, rate_hz: float) -> FloatArray:
    """Return how far the pelvis is lowered ``(n,)`` so that every standing foot is in reach.

    Parameters
    ----------
    short_m, room_m
        ``(n,)`` how far it must be, and how far it may be before a knee is bent too much.
    """
    around = int(np.ceil(SINKING_S * rate_hz))

    def eased(value: FloatArray) -> FloatArray:
        padded = np.pad(value, around, mode="edge")
        highest = np.lib.stride_tricks.sliding_window_view(padded, 2 * around + 1).max(axis=-1)
        return gaussian_smoothed(highest, SINKING_S / 3.0 * rate_hz)

    needed = eased(np.minimum(short_m, MOST_SINK_M))
    return np.minimum(needed, -eased(-np.minimum(room_m, MOST_SINK_M)))


def _straight(sunk_m: FloatArray, flies: BoolArray) -> FloatArray:
    """Return how far the pelvis is lowered, linear in flights: free fall stays a parabola."""
    held = np.flatnonzero(~flies)
    return np.interp(np.arange(len(flies)), held, sunk_m[held]) if len(held) else sunk_m


def _bring(skeleton: Skeleton, foot: _Foot, rotation: FloatArray, translation: FloatArray) -> None:
    """Rotate thigh, shin and foot, in place, so that the foot gets its position and rotation.

    The knee keeps pointing where it did.
    """
    leg = foot.leg
    joints = [int(skeleton.parents[leg.upper]), leg.upper]
    world_q, place_m = joints_in_world(skeleton, joints, rotation, translation)
    (parent_q, thigh_q), hip = np.moveaxis(world_q, 1, 0), place_m[:, 1]
    hinge = rotate(thigh_q, leg.limb.upper_hinge)
    pole = np.cross(hinge, hip - foot.ankle_m)
    upper_q, lower_q = two_bone_ik(leg.limb, hip, foot.ankle_m, pole, softness=SOFTNESS)
    rotation[:, leg.upper] = multiply(inverse(parent_q), upper_q)
    rotation[:, leg.lower] = multiply(inverse(upper_q), lower_q)
    rotation[:, leg.foot] = multiply(inverse(lower_q), foot.rotation_xyzw)
