"""Could a body do it: what a clip asks of the ground, its flights, the order of a blow's parts.

`python -m benchmarks.clips` prints these figures. A body is taken as its mass centre. The ground
pushes where the line of its force meets it, in the zero moment point, and that should be under
the soles. Paths are read at 24 Hz and low-passed at 6 Hz, as captured movement is.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from actions_library.authoring.mass import GRAVITY_M_S2, centre_of_mass, zero_moment_point
from actions_library.authoring.soles import on_more_than_soles, soles_in_world
from actions_library.authoring.support import support_of
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import inverse, multiply, rotate, rotvec_from_quaternion

READ_HZ, CUTOFF_HZ = 24.0, 6.0
FAR_OUTSIDE_M = 0.20
SHORTEST_FLIGHT_S = 0.10
_SURELY = 9
"""Frames, at 60 Hz, about one in which the soles carry: the low-pass smears take-offs."""

_EDGE = 3
"""Readings at either end of a capture that the low-pass cannot see beyond."""

_STILL_M = 1e-5
"""By how much a mass centre that sinks no more may sink in a frame."""

STANDS_S = 1.0
"""How long a clip that is no cycle is preceded and followed by its first and last pose."""

BLOWS = {
    "punch": ("hips", "upper_chest", "right_upper_arm", "right_lower_arm"),
    "slash": ("hips", "upper_chest", "right_upper_arm", "right_lower_arm"),
    "throw": ("hips", "upper_chest", "right_upper_arm", "right_lower_arm"),
    "kick": ("hips", "right_lower_leg"),
}
"""Parts of a blow, in the order in which each is fastest in a person's [1]_. A kick's thigh is
fastest when the knee comes up, before the execution.

References
----------
.. [1] C. A. Putnam, "Sequential motions of body segments in striking and throwing skills",
   J. Biomechanics 26, supplement 1, 1993.
"""

_LIMBS = {
    "right_upper_arm": ("upper_chest", "right_lower_arm"),
    "right_lower_arm": ("right_upper_arm", "right_hand"),
    "right_lower_leg": ("right_upper_leg", "right_foot"),
}
"""What carries a limb's bone, and the joint at its end."""


@dataclass(frozen=True, slots=True)
class FlightFigures:
    """A time in which nothing touches the ground.

    Attributes
    ----------
    gravity : acceleration of its fall, 1 being that of the earth.
    crouch_m : how far the mass centre rises from its lowest place before to the take-off.
    landing_s : from touching down until the mass centre sinks no more.
    landing_knee_deg : bend of the knees there, of the more bent one.
    """

    gravity: float
    crouch_m: float
    landing_s: float
    landing_knee_deg: float


@dataclass(frozen=True, slots=True)
class ClipWeight:
    """One clip's figures.

    Attributes
    ----------
    acceleration_p99_m_s2, acceleration_max_m_s2 : of the mass centre, over the ground.
    least_load : of the weight, what the ground carries at least while the body is on it; below 0
        it would have to pull. None where soles never carry for long.
    outside_p95_m : of the zero moment point, from the soles; None where soles alone never carry.
    outside_share : of the frames on soles alone, where that is more than `FAR_OUTSIDE_M`.
    flights : in the order of time.
    chain_s : when each of a blow's parts is fastest, before its execution ends; empty for others.
    """

    acceleration_p99_m_s2: float
    acceleration_max_m_s2: float
    least_load: float | None
    outside_p95_m: float | None
    outside_share: float | None
    flights: tuple[FlightFigures, ...]
    chain_s: tuple[float, ...]

    @property
    def in_order(self) -> bool:
        """Whether each part of a blow is fastest after the one that carries it."""
        return all(a > b for a, b in pairwise(self.chain_s))


def weigh(clip: Clip) -> ClipWeight:
    """Return a clip's figures."""
    from scipy.ndimage import minimum_filter1d

    rotation, position = forward_kinematics(clip.skeleton, *_played(clip))
    skeleton, rate_hz = clip.skeleton, clip.rate_hz
    centre = centre_of_mass(skeleton, position)
    soles = soles_in_world(skeleton, rotation, position)
    propped = on_more_than_soles(skeleton, position)
    carried = support_of(soles).carries

    read = np.arange(0.0, (len(centre) - 1) / rate_hz, 1.0 / READ_HZ)
    near = np.round(read * rate_hz).astype(int)
    at = _low_passed(centre, rate_hz, read)
    acceleration = _second_derivative(at, READ_HZ)
    told = _told(clip, read)
    level = np.hypot(acceleration[told, 0], acceleration[told, 2])
    moment = zero_moment_point(at, acceleration)
    outside = np.linalg.norm(support_of(soles[near]).nearest_m(moment) - moment, axis=1)
    standing = told & (minimum_filter1d(carried.astype(int), _SURELY)[near] > 0)
    load = 1.0 + acceleration[standing, 1] / GRAVITY_M_S2
    outside = outside[told & carried[near] & ~propped[near]]
    return ClipWeight(
        acceleration_p99_m_s2=float(np.percentile(level, 99)),
        acceleration_max_m_s2=float(level.max()),
        least_load=float(load.min()) if len(load) else None,
        outside_p95_m=float(np.percentile(outside, 95)) if len(outside) else None,
        outside_share=float(np.mean(outside > FAR_OUTSIDE_M)) if len(outside) else None,
        flights=_flights(clip, position, centre, carried | propped),
        chain_s=_chain_s(clip),
    )


def over_ground_m_s2(centre_m: FloatArray, rate_hz: float) -> FloatArray:
    """Return a mass centre's acceleration over the ground, read as a clip's, ``(k,)``."""
    read = np.arange(0.0, (len(centre_m) - 1) / rate_hz, 1.0 / READ_HZ)
    acceleration = _second_derivative(_low_passed(centre_m, rate_hz, read), READ_HZ)
    return np.hypot(acceleration[:, 0], acceleration[:, 2])[_EDGE:-_EDGE]


def _played(clip: Clip) -> tuple[FloatArray, FloatArray]:
    """Return poses of a cycle three times, or of another clip between two times of standing."""
    rotation, translation = clip.rotation_xyzw, clip.translation_m
    if not clip.cyclic:
        still = round(STANDS_S * clip.rate_hz)
        ends = np.r_[np.zeros(still, int), np.arange(len(clip)), np.full(still, len(clip) - 1)]
        return rotation[ends], translation[ends]
    rotations = np.concatenate([rotation[:-1], rotation[:-1], rotation])
    travel = translation[-1, 0] - translation[0, 0]
    parts = [translation[:-1].copy(), translation[:-1].copy(), translation.copy()]
    for i, part in enumerate(parts):
        part[:, 0] += i * travel
    return rotations, np.concatenate(parts)


def _told(clip: Clip, read_s: FloatArray) -> BoolArray:
    """Return which times are the clip's own: of three cycles the one in the middle."""
    length = (len(clip) - 1) / clip.rate_hz
    start = length if clip.cyclic else STANDS_S
    return np.asarray((read_s >= start) & (read_s <= start + length))


def _low_passed(path_m: FloatArray, rate_hz: float, read_s: FloatArray) -> FloatArray:
    from scipy.signal import butter, filtfilt

    time_s = np.arange(len(path_m)) / rate_hz
    read = np.stack([np.interp(read_s, time_s, column) for column in path_m.T], axis=1)
    b, a = butter(2, CUTOFF_HZ / (READ_HZ / 2.0))
    return np.asarray(filtfilt(b, a, read, axis=0))


def _second_derivative(path: FloatArray, rate_hz: float) -> FloatArray:
    return np.asarray(np.gradient(np.gradient(path, 1 / rate_hz, axis=0), 1 / rate_hz, axis=0))


def _flights(
    clip: Clip, position: FloatArray, centre: FloatArray, grounded: BoolArray
) -> tuple[FlightFigures, ...]:
    """Return the flights that begin in the clip's own time."""
    first = len(clip) - 1 if clip.cyclic else round(STANDS_S * clip.rate_hz)
    edges = np.diff(grounded.astype(int))
    knees = _knee_deg(clip, position)
    flights = []
    for last in np.flatnonzero(edges == -1):  # the last frame on the ground
        landings = np.flatnonzero(edges[last:] == 1)
        if not first <= last < first + len(clip) - 1 or not len(landings):
            continue
        land = int(last + landings[0] + 1)
        if land - last - 1 < SHORTEST_FLIGHT_S * clip.rate_hz:
            continue
        height = centre[:, 1]
        air = np.arange(last + 1, land)
        bend = np.polyfit(air / clip.rate_hz, height[air], 2)[0]
        ends = np.flatnonzero(np.diff(height[land - 1 :]) > -_STILL_M)
        deep = land - 1 + (int(ends[0]) if len(ends) else 0)
        rises = np.flatnonzero(np.diff(height[: last + 1][::-1]) > 0.0)
        low = last - (int(rises[0]) if len(rises) else last)
        flights.append(
            FlightFigures(
                gravity=float(-2.0 * bend / GRAVITY_M_S2),
                crouch_m=float(height[last] - height[low]),
                landing_s=(deep - land + 1) / clip.rate_hz,
                landing_knee_deg=float(knees[deep]),
            )
        )
    return tuple(flights)


def _knee_deg(clip: Clip, position: FloatArray) -> FloatArray:
    bends = []
    for side in ("left", "right"):
        hip, knee, ankle = (
            position[:, clip.skeleton.index(f"{side}_{j}")]
            for j in ("upper_leg", "lower_leg", "foot")
        )
        a, b = knee - hip, ankle - knee
        cosine = np.sum(a * b, axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
        bends.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.asarray(np.maximum(*bends))


def _chain_s(clip: Clip) -> tuple[float, ...]:
    """Return when in its execution each part of a blow turns fastest, before the strike."""
    _, start, strike, _, _ = clip.stage_end_frames
    fastest = (
        start + int(np.argmax(turning_rad_s(clip, part)[start:strike]))
        for part in BLOWS.get(clip.name, ())
    )
    return tuple((strike - frame - 0.5) / clip.rate_hz for frame in fastest)


def turning_rad_s(clip: Clip, part: str) -> FloatArray:
    """Return how fast a part turns between frames: trunk in the world, a limb from what carries it.

    A limb turns as the direction of its bone: that it twists about itself moves nothing.
    """
    rotation, position = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    joint = clip.skeleton.index
    own = rotation[:, joint(part)]
    if part not in _LIMBS:
        turn = rotvec_from_quaternion(multiply(own[1:], inverse(own[:-1])))
        return np.asarray(np.linalg.norm(turn, axis=-1) * clip.rate_hz)
    carrier, end = _LIMBS[part]
    bone = position[:, joint(end)] - position[:, joint(part)]
    way = rotate(inverse(rotation[:, joint(carrier)]), bone)
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    return np.asarray(np.linalg.norm(np.diff(way, axis=0), axis=-1) * clip.rate_hz)


HEADER = """\
clip               a p99  a max load  outside    far  flights: fall, crouch, landing, knee; fastest
                    m/s2   m/s2    g   cm p95         g, cm, s, deg; ms before the strike"""


def columns(weight: ClipWeight) -> str:
    """Return a clip's figures as columns."""
    text = f"{weight.acceleration_p99_m_s2:6.1f} {weight.acceleration_max_m_s2:6.1f}"
    text += 5 * " " if weight.least_load is None else f" {weight.least_load:4.1f}"
    if weight.outside_p95_m is None or weight.outside_share is None:
        text += 15 * " "
    else:
        text += f" {100 * weight.outside_p95_m:8.1f} {100 * weight.outside_share:5.1f}%"
    for flight in weight.flights:
        text += f"  {flight.gravity:.2f} {100 * flight.crouch_m:.0f} {flight.landing_s:.2f}"
        text += f" {flight.landing_knee_deg:.0f}"
    if weight.chain_s:
        text += "  " + " ".join(f"{1e3 * -t:.0f}" for t in weight.chain_s)
        text += " ms in order" if weight.in_order else " ms"
    return text
