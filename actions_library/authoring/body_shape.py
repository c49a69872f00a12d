"""The shape of the shipped humanoid: which solids it is made of, part by part.

Only the left half is described (x from 0 up); the right one is its mirror image. Parts that
neighbour each other on the skeleton melt together, others never do: an arm joins the torso at the
shoulder alone, and the legs do not know of each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.body_field import (
    Ellipsoid,
    Field,
    HalfSpace,
    Loft,
    Point,
    RoundCone,
    Shape,
    united,
)
from actions_library.authoring.hand_shape import DOWN_45, WRIST, Finger, left_fingers
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import matrix_from_quaternion, quaternion_from_euler

Parts = list[tuple[Shape, float]]
"""Shapes in the order in which they are united, each with the reach of its blend."""

BODY_BOX = ((0.0, -0.03, -0.21), (0.76, 1.80, 0.24))
TRUNK_BOX = ((0.0, 0.70, -0.21), (0.34, 1.80, 0.20))
ARM_BOX = ((0.03, 0.70, -0.16), (0.76, 1.56, 0.16))
LEG_BOX = ((0.0, -0.03, -0.20), (0.27, 1.08, 0.24))
"""What the grids span; each leaves room for its part and the blends around it."""

FORWARD: Point = (0.0, 0.0, 1.0)
UP: Point = (0.0, 1.0, 0.0)
DOWN: Point = (0.0, -1.0, 0.0)

# Where the left side's joints stand in the bind pose (authoring.humanoid).
SHOULDER, ELBOW = (0.175, 1.405, -0.010), (0.375, 1.205, -0.020)
HIP, KNEE, ANKLE = (0.092, 0.905, 0.000), (0.094, 0.492, 0.008), (0.096, 0.085, -0.020)

SOLE_M = 0.0015
"""Height of the bare sole: what shoes leave."""

TUCK_M = 0.010
"""How much slimmer the body is below its clothes."""


@dataclass(frozen=True)
class BodyFields:
    """The body's distance field and those of its parts.

    Attributes
    ----------
    whole : the left half of the body, as clothes are measured on it.
    skin : the same, slimmer below the clothes.
    trunk : hips, torso, neck and head alone.
    head : the head alone, without neck.
    arm : the left arm with its hand alone.
    leg : the left leg with its foot alone.
    """

    whole: Field
    skin: Field
    trunk: Field
    head: Field
    arm: Field
    leg: Field


def body_fields(step_m: float) -> BodyFields:
    """Return the fields of the figure on grids with nodes ``step_m`` apart."""
    arm = united(ARM_BOX, step_m, _arm())
    arm.merge(united(ARM_BOX, step_m, _hand()), 0.020)
    foot = united(LEG_BOX, step_m, _foot())
    foot.carve(Ellipsoid((0.058, -0.004, 0.030), (0.020, 0.014, 0.045)), 0.012)
    foot.keep(HalfSpace((0.0, SOLE_M, 0.0), DOWN), 0.006)
    leg = united(LEG_BOX, step_m, _leg())
    leg.merge(foot, 0.035)
    head = with_features(united(TRUNK_BOX, step_m, skull()))
    upright = united(TRUNK_BOX, step_m, trunk())
    upright.merge(head, 0.030)
    whole = Field(BODY_BOX, step_m)
    whole.merge(upright, 0.0)
    whole.merge(leg, 0.045)
    whole.merge(arm, 0.045)
    skin = whole.grown(0.0)
    skin.shrink(_tuck)
    return BodyFields(whole, skin, upright, head, arm, leg)


def _tuck(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """Return how much slimmer the skin is where clothes cover it: bent cloth must not show it.

    Most of all between the legs, where cloth and skin fold apart in a deep squat.
    """
    covered = np.clip((y - 0.13) / 0.05, 0, 1) * np.clip((1.36 - y) / 0.10, 0, 1)
    covered = covered * np.clip((0.26 - x) / 0.06, 0, 1)
    crotch = np.clip((0.08 - np.hypot(x, 0.6 * (y - 0.82))) / 0.05, 0, 1)
    return TUCK_M * (covered + 1.5 * crotch) + 0.0 * z


def between(start: Point, end: Point) -> Point:
    """Return the vector from one point to another."""
    return as_point(np.subtract(end, start))


def as_point(p: FloatArray) -> Point:
    """Return three numbers as a tuple."""
    return (float(p[0]), float(p[1]), float(p[2]))


def trunk() -> Parts:
    """Return pelvis, waist, chest, the shoulders' slope and the neck."""
    # height, front, back, outer, inner, the centre's shift to the front and outwards
    rows = [
        (0.845, 0.080, 0.086, 0.134, 0.134, 0.000, 0.0),
        (0.880, 0.087, 0.098, 0.151, 0.151, 0.000, 0.0),
        (0.920, 0.092, 0.103, 0.157, 0.157, 0.000, 0.0),
        (0.960, 0.094, 0.101, 0.156, 0.156, 0.000, 0.0),
        (1.000, 0.094, 0.093, 0.149, 0.149, 0.000, 0.0),
        (1.060, 0.094, 0.084, 0.138, 0.138, 0.000, 0.0),
        (1.110, 0.096, 0.082, 0.135, 0.135, 0.000, 0.0),
        (1.170, 0.102, 0.089, 0.140, 0.140, 0.000, 0.0),
        (1.240, 0.109, 0.102, 0.152, 0.152, 0.000, 0.0),
        (1.310, 0.111, 0.112, 0.162, 0.162, -0.002, 0.0),
        (1.370, 0.096, 0.107, 0.160, 0.160, -0.006, 0.0),
        (1.415, 0.074, 0.088, 0.138, 0.138, -0.012, 0.0),
        (1.450, 0.054, 0.064, 0.084, 0.084, -0.016, 0.0),
    ]
    neck = [
        (0.000, 0.054, 0.060, 0.060, 0.060, 0.0, 0.0),
        (0.050, 0.049, 0.055, 0.052, 0.052, 0.0, 0.0),
        (0.130, 0.046, 0.054, 0.049, 0.049, 0.0, 0.0),
    ]
    return [
        (Loft((0.0, 0.0, 0.0), UP, FORWARD, rows, (0.04, 0.03), 2.25), 0.0),
        (Loft((0.0, 1.430, -0.026), (0.0, 0.97, 0.24), FORWARD, neck), 0.045),
        (RoundCone((0.020, 1.478, -0.040), (0.170, 1.420, -0.016), 0.030, 0.032), 0.05),
        (Ellipsoid((0.072, 1.322, 0.062), (0.080, 0.060, 0.042)), 0.06),
        (Ellipsoid((0.082, 1.335, -0.078), (0.068, 0.090, 0.036)), 0.06),
        (Ellipsoid((0.076, 0.888, -0.062), (0.074, 0.080, 0.060)), 0.05),
    ]


def skull() -> Parts:
    """Return the skull and the face from the brow to the chin."""
    # way down from the brow, front, back, outer, inner, the centre's shift to the front
    face = [
        (0.000, 0.082, 0.060, 0.075, 0.075, 0.010, 0.0),
        (0.035, 0.083, 0.056, 0.077, 0.077, 0.010, 0.0),
        (0.065, 0.082, 0.052, 0.075, 0.075, 0.010, 0.0),
        (0.090, 0.079, 0.050, 0.068, 0.068, 0.010, 0.0),
        (0.112, 0.072, 0.046, 0.054, 0.054, 0.011, 0.0),
    ]
    return [
        (Ellipsoid((0.0, 1.642, -0.004), (0.080, 0.098, 0.099)), 0.0),
        (Loft((0.0, 1.655, 0.0), DOWN, FORWARD, face, (0.05, 0.028), 2.0), 0.03),
        (RoundCone((0.0, 1.537, 0.070), (0.008, 1.538, 0.068), 0.023, 0.022), 0.03),
    ]


def with_features(head: Field) -> Field:
    """Return a skull with sockets, brow, nose, cheeks and ears added to it."""
    for shape, reach_m in _eye_sockets():
        head.carve(shape, reach_m)
    for shape, reach_m in _face():
        head.add(shape, reach_m)
    return head


def _eye_sockets() -> Parts:
    """Return what is taken from the skull for the eyes."""
    return [(Ellipsoid((0.034, 1.624, 0.106), (0.026, 0.017, 0.022)), 0.024)]


def _face() -> Parts:
    """Return brow, nose, nostril and ear."""
    ear = matrix_from_quaternion(quaternion_from_euler("XYZ", [-0.22, -0.42, 0.10]))
    return [
        (RoundCone((0.014, 1.650, 0.086), (0.050, 1.652, 0.070), 0.009, 0.007), 0.024),
        (RoundCone((0.0, 1.634, 0.088), (0.0, 1.597, 0.105), 0.008, 0.0105), 0.018),
        (RoundCone((0.008, 1.594, 0.098), (0.0085, 1.594, 0.098), 0.008, 0.008), 0.012),
        (Ellipsoid((0.081, 1.612, -0.008), (0.008, 0.032, 0.019), ear), 0.010),
    ]


def _arm() -> Parts:
    """Return deltoid, upper arm and forearm."""
    upper = [
        (0.000, 0.053, 0.053, 0.050, 0.050, 0.0, 0.0),
        (0.050, 0.053, 0.054, 0.052, 0.048, 0.0, 0.0),
        (0.110, 0.050, 0.051, 0.047, 0.045, 0.002, 0.0),
        (0.170, 0.047, 0.048, 0.043, 0.042, 0.002, 0.0),
        (0.230, 0.041, 0.042, 0.039, 0.038, 0.0, 0.0),
        (0.283, 0.035, 0.036, 0.036, 0.035, 0.0, 0.0),
    ]
    fore = [
        (0.000, 0.034, 0.036, 0.036, 0.035, 0.0, 0.0),
        (0.045, 0.041, 0.038, 0.041, 0.038, 0.0, 0.0),
        (0.085, 0.042, 0.037, 0.042, 0.038, 0.0, 0.0),
        (0.160, 0.036, 0.032, 0.034, 0.031, 0.0, 0.0),
        (0.220, 0.030, 0.028, 0.024, 0.023, 0.0, 0.0),
        (0.252, 0.029, 0.027, 0.020, 0.019, 0.0, 0.0),
    ]
    return [
        (Loft(SHOULDER, between(SHOULDER, ELBOW), FORWARD, upper, (0.05, 0.015), mirrored=True), 0),
        (Loft(ELBOW, between(ELBOW, WRIST), FORWARD, fore, (0.015, 0.02), mirrored=True), 0.016),
        (Ellipsoid((0.188, 1.390, -0.008), (0.050, 0.056, 0.056)), 0.04),
        (RoundCone((0.374, 1.206, -0.036), (0.378, 1.202, -0.036), 0.015, 0.015), 0.03),
    ]


def _hand() -> Parts:
    """Return palm, thumb and fingers, a little curled."""
    palm = [
        (0.000, 0.027, 0.025, 0.018, 0.017, 0.000, 0.0),
        (0.035, 0.034, 0.032, 0.017, 0.019, 0.001, 0.0),
        (0.070, 0.041, 0.037, 0.015, 0.016, 0.001, 0.0),
        (0.090, 0.042, 0.038, 0.012, 0.013, 0.001, 0.0),
    ]
    parts: Parts = [(Loft(WRIST, DOWN_45, FORWARD, palm, (0.02, 0.008), 2.4, mirrored=True), 0.0)]
    for finger in left_fingers():
        reach_m = 0.014 if finger.name == "thumb" else 0.006
        parts += [(bone, reach_m) for bone in finger_bones(finger)]
    return parts


def finger_bones(finger: Finger) -> list[RoundCone]:
    """Return a finger's bones with their flesh, from the hand to the tip."""
    places, radii = [as_point(p) for p in finger.places], finger.radii.tolist()
    return [RoundCone(places[k], places[k + 1], radii[k], radii[k + 1]) for k in range(3)]


def _leg() -> Parts:
    """Return thigh, knee and calf."""
    thigh = [
        (0.020, 0.072, 0.076, 0.058, 0.076, 0.0, 0.0),
        (0.090, 0.082, 0.086, 0.072, 0.076, 0.0, 0.0),
        (0.170, 0.080, 0.079, 0.073, 0.070, 0.003, 0.0),
        (0.270, 0.070, 0.068, 0.065, 0.062, 0.004, 0.0),
        (0.350, 0.058, 0.057, 0.055, 0.055, 0.002, 0.0),
        (0.413, 0.050, 0.048, 0.049, 0.050, 0.0, 0.0),
    ]
    calf = [
        (0.000, 0.049, 0.048, 0.049, 0.049, 0.0, 0.0),
        (0.050, 0.044, 0.054, 0.049, 0.048, 0.0, 0.0),
        (0.120, 0.043, 0.066, 0.055, 0.053, 0.0, 0.0),
        (0.200, 0.041, 0.060, 0.049, 0.049, 0.0, 0.0),
        (0.290, 0.036, 0.043, 0.037, 0.038, 0.0, 0.0),
        (0.360, 0.034, 0.037, 0.033, 0.033, 0.0, 0.0),
        (0.408, 0.036, 0.038, 0.036, 0.034, 0.0, 0.0),
    ]
    return [
        (Loft(HIP, between(HIP, KNEE), FORWARD, thigh, (0.05, 0.02)), 0.0),
        (Loft(KNEE, between(KNEE, ANKLE), FORWARD, calf, (0.02, 0.02)), 0.016),
        (Ellipsoid((0.094, 0.500, 0.044), (0.026, 0.034, 0.014)), 0.035),
    ]


def _foot() -> Parts:
    """Return heel, instep and toes."""
    # way forward, up, down, outer, inner, the centre's lift, its shift outwards
    rows = [
        (0.000, 0.030, 0.026, 0.027, 0.027, 0.024, 0.000),
        (0.030, 0.048, 0.030, 0.034, 0.032, 0.028, 0.000),
        (0.070, 0.060, 0.030, 0.037, 0.034, 0.028, 0.001),
        (0.110, 0.050, 0.026, 0.039, 0.036, 0.024, 0.002),
        (0.150, 0.040, 0.022, 0.043, 0.041, 0.020, 0.003),
        (0.190, 0.028, 0.019, 0.046, 0.045, 0.017, 0.003),
        (0.225, 0.020, 0.016, 0.043, 0.041, 0.014, 0.001),
        (0.250, 0.015, 0.013, 0.034, 0.032, 0.012, -0.003),
    ]
    heel, forward = (0.094, 0.0, -0.078), (0.03, 0.0, 1.0)
    return [(Loft(heel, forward, UP, rows, (0.014, 0.018), 2.6, mirrored=True), 0.0)]
