"""Whether a movement is physically possible: its mass centre, its zero moment point, its jumps.

All figures are of joints over time at an even `RATE_HZ`, whatever they come from. The body's mass
is that of Winter's segments (`actions_library.authoring.mass`), the hands' included; the path of
its centre is low-passed at `LOWPASS_HZ`, as in gait laboratories [1]_.

The zero moment point is where the ground's force would have to act so that the body neither tips
over nor turns over [2]_: below the mass centre, moved against its acceleration. A real one is
within the hull of the soles that bear; how far it is outside is by how much a body cheats.
Who lies, sits or flies has none.

References
----------
.. [1] D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed., chapters 2 and 4.
.. [2] M. Vukobratović, B. Borovac, "Zero-Moment Point: Thirty Five Years of Its Life",
   International Journal of Humanoid Robotics 1, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from actions_library.authoring.mass import SEGMENTS, SIDES
from smd.acting.flight import GRAVITY_M_S2
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.roles import LimbPlan, body_plan
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.runs import runs_of_true

RATE_HZ, LOWPASS_HZ, ORDER = 24.0, 6.0, 2
"""Of a Butterworth filter that runs forth and back, so that it delays nothing."""

BEARS_M, CLEAR_M = 0.03, 0.06
"""Height of a heel's or a toe's joint over its own lowest (5th percentile) up to which it bears,
and from which it is clear of the ground; a body flies when all are clear."""

HEEL_M, TIP_M, HALF_WIDTH_M = 0.06, 0.07, 0.045
"""How far a sole reaches behind the ankle, beyond the toes' joint, and to both sides."""

LEAST_LOAD_M_S2 = 1.0
"""Least upward force on the feet, a unit of mass, for which the zero moment point is taken: it
flies to infinity where nothing presses on the ground."""

EDGE = 3
"""Frames at both ends that have no zero moment point: the filter knows too little there."""

LEAST_FRAMES = 20
"""A shorter movement is not measured."""

LEAST_FLIGHT = 4
"""Frames that tell how fast a body falls; a shorter flight is not measured."""

UPRIGHT = 0.4
"""Height of the pelvis, in leg lengths, from which a body is on its feet: below, it sits, lies or
rolls, and rests on more. A deep crouch is at 0.5."""


@dataclass(frozen=True, slots=True)
class Anatomy:
    """Which joints of a skeleton carry its mass and touch the ground.

    Attributes
    ----------
    joint : index, by the names that `SEGMENTS` uses.
    root : what carries it over the ground.
    trunk : pelvis, hips, chest, shoulders and head: these show where the body as a whole is.
    """

    joint: dict[str, int]
    root: int
    trunk: tuple[int, ...]


def anatomy_of(skeleton: Skeleton) -> Anatomy | None:
    """Return the anatomy of a two-legged skeleton with arms and a head, found by its roles."""
    _, place = forward_kinematics(
        skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m
    )
    plan = body_plan(skeleton.joints, skeleton.parents.tolist(), place)
    limbs = {(limb.kind, limb.side): limb for limb in plan.limbs}
    if len(limbs) != 4 or len(plan.limbs) != 4 or plan.head is None:
        return None
    neck = plan.spine[plan.spine.index(plan.chest) + 1]
    joint = {"hips": plan.pelvis, "upper_chest": plan.chest, "neck": neck, "head": plan.head}
    for (kind, side), limb in limbs.items():
        ends = ("foot", "toes") if kind == "leg" else ("hand", "middle_proximal")
        names = (f"upper_{kind}", f"lower_{kind}", *ends)
        joints = (limb.upper, limb.middle, limb.end, _beyond(limb))
        joint.update((f"{side}_{name}", j) for name, j in zip(names, joints, strict=True))
    upper = [joint[f"{side}_upper_{kind}"] for side in SIDES for kind in ("leg", "arm")]
    return Anatomy(joint, plan.root[0], (plan.pelvis, plan.chest, plan.head, *upper))


def _beyond(limb: LimbPlan) -> int:
    """Return the joint after a limb's end, or the end where that is the tip."""
    at = limb.chain.index(limb.end) + 1
    return limb.chain[min(at, len(limb.chain) - 1)]


def leg_length_m(anatomy: Anatomy, position_m: FloatArray) -> float:
    """Return how long thigh and shin are together, the mean of both legs, of joints ``(j, 3)``."""
    ways = [[f"{side}_{of}" for of in ("upper_leg", "lower_leg", "foot")] for side in SIDES]
    places = [position_m[[anatomy.joint[name] for name in way]] for way in ways]
    return float(np.mean([np.linalg.norm(np.diff(p, axis=0), axis=-1).sum() for p in places]))


def centre_of_mass(position_m: FloatArray, anatomy: Anatomy) -> FloatArray:
    """Return the body's centre of mass ``(n, 3)``, of joints ``(n, j, 3)``."""
    total, mass = np.zeros((len(position_m), 3)), 0.0
    for start, end, share, along in SEGMENTS:
        for side in SIDES if "{side}" in start + end else SIDES[:1]:
            a, b = (position_m[:, anatomy.joint[j.format(side=side)]] for j in (start, end))
            total += share * (a + along * (b - a))
            mass += share
    return total / mass


@dataclass(frozen=True, slots=True, eq=False)
class Mechanics:
    """A movement's figures in each of its frames, `RATE_HZ` a second.

    Attributes
    ----------
    time_s : (n,) from that of the first pose.
    centre_m : (n, 3) mass centre; acceleration_m_s2 : its acceleration, low-passed.
    outside_m : (n,) distance of the zero moment point from the hull of the soles that bear; NaN
        where none does, and at the ends.
    flies : (n,) whether both feet are clear of the ground, and the mass centre higher than legs are
        long: who sits or lies down lifts feet too.
    upright : (n,) whether the pelvis is as high as that of a body on its feet.
    carried_m_s2 : (n,) the root's acceleration over the ground, low-passed alike: what the body has
        of its way alone.
    root_m_s : (n - 1,) speed of the root over the ground from frame to frame.
    pop_m : (n,) how far the trunk's joints are on the way of a frame off what the frames before
        and after it say (`pops_m`).
    """

    time_s: FloatArray
    centre_m: FloatArray
    acceleration_m_s2: FloatArray
    outside_m: FloatArray
    flies: BoolArray
    upright: BoolArray
    carried_m_s2: FloatArray
    root_m_s: FloatArray
    pop_m: FloatArray

    @property
    def level_m_s2(self) -> FloatArray:
        """The mass centre's acceleration over the ground ``(n,)``."""
        return np.hypot(self.acceleration_m_s2[:, 0], self.acceleration_m_s2[:, 2])

    def falls_g(self, frames: BoolArray) -> FloatArray:
        """Return how fast the body falls in each flight among some frames, 1 being free fall.

        It is the parabola's through the mass centre's heights, as they are: a low-pass would
        flatten a short flight.
        """
        found = []
        for first, end in runs_of_true(self.flies & frames):
            if end - first >= LEAST_FLIGHT:
                bend = np.polyfit(self.time_s[first:end], self.centre_m[first:end, 1], 2)[0]
                found.append(-2.0 * bend / GRAVITY_M_S2)
        return np.array(found)


def mechanics(
    skeleton: Skeleton, poses: Poses, rate_hz: float, anatomy: Anatomy
) -> Mechanics | None:
    """Return the figures of poses in the world, on level ground at height 0; None of too few."""
    _, position_m = forward_kinematics(skeleton, *poses)
    return mechanics_of(position_m, np.arange(len(position_m)) / rate_hz, anatomy)


def mechanics_of(position_m: FloatArray, time_s: FloatArray, anatomy: Anatomy) -> Mechanics | None:
    """Return the figures of joints in the world ``(n, j, 3)``; None where they are too few.

    Parameters
    ----------
    position_m
        The ground is level, at height 0.
    time_s
        ``(n,)`` increasing.
    """
    # - 1e-6: the last frame is left out, also where rounding would let it in.
    even_s = np.arange(time_s[0], time_s[-1] - 1e-6, 1.0 / RATE_HZ)
    if len(even_s) < LEAST_FRAMES:
        return None
    centre = _resampled(centre_of_mass(position_m, anatomy), time_s, even_s)
    smooth, acceleration = _accelerated(centre)
    corners, height = _soles(position_m, anatomy)
    corners = _resampled(corners, time_s, even_s)
    height = _resampled(height, time_s, even_s)
    bears = np.repeat(height < BEARS_M, 2, axis=1)
    outside = np.full(len(even_s), np.nan)
    rows = np.flatnonzero(bears.any(axis=1))
    rows = rows[(rows >= EDGE) & (rows < len(even_s) - EDGE)]
    point = zero_moment_point_m(smooth[rows], acceleration[rows])
    outside[rows] = outside_m(point, corners[rows][..., [0, 2]], bears[rows])
    legs_m = leg_length_m(anatomy, position_m[0])
    pelvis = _resampled(position_m[:, anatomy.joint["hips"]], time_s, even_s)
    root = _resampled(position_m[:, anatomy.root], time_s, even_s)[:, [0, 2]]
    return Mechanics(
        time_s=even_s,
        centre_m=centre,
        acceleration_m_s2=acceleration,
        outside_m=outside,
        flies=(height > CLEAR_M).all(axis=1) & (centre[:, 1] > legs_m),
        upright=pelvis[:, 1] > UPRIGHT * legs_m,
        carried_m_s2=np.linalg.norm(_accelerated(root)[1], axis=-1),
        root_m_s=np.linalg.norm(np.diff(root, axis=0), axis=-1) * RATE_HZ,
        pop_m=pops_m(_resampled(position_m[:, anatomy.trunk], time_s, even_s)),
    )


def _accelerated(place_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return places ``(n, c)`` low-passed, and their acceleration."""
    from scipy.signal import butter, filtfilt

    b, a = butter(ORDER, LOWPASS_HZ / (0.5 * RATE_HZ))
    smooth = filtfilt(b, a, place_m, axis=0)
    velocity = np.gradient(smooth, 1.0 / RATE_HZ, axis=0)
    return smooth, np.gradient(velocity, 1.0 / RATE_HZ, axis=0)


def zero_moment_point_m(centre_m: FloatArray, acceleration_m_s2: FloatArray) -> FloatArray:
    """Return x and z of the zero moment point ``(…, 2)`` on the ground at height 0."""
    load = np.maximum(acceleration_m_s2[..., 1] + GRAVITY_M_S2, LEAST_LOAD_M_S2)
    lever_s2 = (centre_m[..., 1] / load)[..., None]
    return np.asarray(centre_m[..., [0, 2]] - lever_s2 * acceleration_m_s2[..., [0, 2]])


def pops_m(position_m: FloatArray) -> FloatArray:
    """Return by how much each frame's way differs from what the frames about it say, ``(n,)``.

    Of each joint's way from one frame to the next, the mean of the ways before and after it is
    taken away; the rest's length, averaged over the joints, is the pop. What flows leaves nothing:
    constant speed and constant acceleration give 0, and a body that is put elsewhere in between
    two frames gives the distance. A sudden change of speed gives half of what it makes in a frame.

    Parameters
    ----------
    position_m
        ``(n, j, 3)`` in the world, at an even rate.
    """
    ways = np.diff(position_m, axis=0)
    off = ways[1:-1] - 0.5 * (ways[:-2] + ways[2:])
    found = np.zeros(len(position_m))
    found[2:-1] = np.linalg.norm(off, axis=-1).mean(axis=-1)
    return found


def _soles(position_m: FloatArray, anatomy: Anatomy) -> tuple[FloatArray, FloatArray]:
    """Return corners of the soles and heights of what they are under.

    Returns
    -------
    corners_m
        ``(n, 8, 3)``: of each foot two behind the ankle, then two beyond the toes.
    height_m
        ``(n, 4)`` of each ankle and toes' joint over its own lowest.
    """
    corners, heights = [], []
    for side in SIDES:
        ankle, toes = (position_m[:, anatomy.joint[f"{side}_{j}"]] for j in ("foot", "toes"))
        ahead = (toes - ankle) * [1.0, 0.0, 1.0]
        ahead = ahead / np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-6)
        aside = HALF_WIDTH_M * np.cross(ahead, [0.0, 1.0, 0.0])
        for joint, end in ((ankle, ankle - HEEL_M * ahead), (toes, toes + TIP_M * ahead)):
            corners += [end + aside, end - aside]
            heights.append(joint[:, 1] - np.percentile(joint[:, 1], 5.0))
    return np.stack(corners, axis=1), np.stack(heights, axis=1)


def outside_m(point_m: FloatArray, corners_m: FloatArray, bears: BoolArray) -> FloatArray:
    """Return how far points are outside the hull of corners that bear; 0 inside.

    The hull's edges are among the lines between its corners, and no other of these is nearer.

    Parameters
    ----------
    point_m
        ``(n, 2)``.
    corners_m
        ``(n, k, 2)``, at least one of which bears.
    bears
        ``(n, k)``.
    """
    first = np.argmax(bears, axis=1)
    stand_in = np.take_along_axis(corners_m, first[:, None, None], axis=1)
    to = np.where(bears[..., None], corners_m, stand_in) - point_m[:, None]
    nearest = np.linalg.norm(to, axis=-1).min(axis=1)
    for i, j in combinations(range(to.shape[1]), 2):
        along = to[:, j] - to[:, i]
        share = -np.sum(to[:, i] * along, axis=-1) / np.maximum(np.sum(along**2, axis=-1), 1e-12)
        at = to[:, i] + np.clip(share, 0.0, 1.0)[:, None] * along
        nearest = np.minimum(nearest, np.linalg.norm(at, axis=-1))
    return np.where(_surrounded(to), 0.0, nearest)


def _surrounded(to: FloatArray) -> BoolArray:
    """Return whether the origin is inside the hull of points ``(n, k, 2)``: no gap of half a turn.

    A point on the hull's edge may come out either way: its distance is 0.
    """
    angle = np.sort(np.arctan2(to[..., 1], to[..., 0]), axis=1)
    around = np.concatenate([angle, angle[:, :1] + 2.0 * np.pi], axis=1)
    return np.asarray(np.diff(around, axis=1).max(axis=1) < np.pi)


def _resampled(value: FloatArray, time_s: FloatArray, even_s: FloatArray) -> FloatArray:
    """Return values ``(n, …)`` at other times, in between linearly."""
    at = np.interp(even_s, time_s, np.arange(len(time_s), dtype=np.float64))
    before = np.minimum(at.astype(np.int64), len(time_s) - 2)
    share = (at - before).reshape(-1, *(1,) * (value.ndim - 1))
    return np.asarray((1.0 - share) * value[before] + share * value[before + 1])
