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
    Loft,
    Point,
    RoundCone,
    Shape,
    built,
)
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import matrix_from_quaternion, normalized, quaternion_from_euler

BOX_LOW_M = (0.0, -0.02, -0.20)
BOX_HIGH_M = (0.76, 1.79, 0.24)
"""What the grid spans."""

DOWN_45: Point = (2**-0.5, -(2**-0.5), 0.0)
FORWARD: Point = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class BodyFields:
    """The body's distance field and those of its parts, all on one grid.

    Attributes
    ----------
    whole : the left half of the body.
    trunk : hips, torso, neck and head alone.
    arm : the left arm with its hand alone.
    leg : the left leg with its foot alone.
    """

    whole: Field
    trunk: Field
    arm: Field
    leg: Field


def body_fields(step_m: float) -> BodyFields:
    """Return the fields of the figure on a grid with nodes ``step_m`` apart."""
    grid = Field(BOX_LOW_M, BOX_HIGH_M, step_m)
    trunk, arm, leg = built(grid, _trunk()), built(grid, _arm()), built(grid, _leg())
    arm.merge(built(grid, _hand()), 0.020)
    foot = built(grid, _foot())
    foot.carve(Ellipsoid((0.062, -0.004, 0.030), (0.020, 0.016, 0.045)), 0.012)
    leg.merge(foot, 0.035)
    head = built(grid, _head())
    for socket in _eye_sockets():
        head.carve(socket, 0.018)
    for shape, reach_m in _face():
        head.add(shape, reach_m)
    trunk.merge(head, 0.030)
    whole = grid.like()
    whole.merge(trunk, 0.0)
    whole.merge(leg, 0.045)
    whole.merge(arm, 0.045)
    return BodyFields(whole, trunk, arm, leg)


def _trunk() -> list[tuple[Shape, float]]:
    """Return pelvis, waist, chest, the shoulders' slope and the neck."""
    # height, front, back, outer, inner, centre's shift to the front and outwards
    rows = [
        (0.855, 0.088, 0.092, 0.140, 0.140, 0.000, 0.0),
        (0.900, 0.094, 0.104, 0.158, 0.158, 0.000, 0.0),
        (0.950, 0.097, 0.104, 0.161, 0.161, 0.000, 0.0),
        (1.000, 0.096, 0.094, 0.150, 0.150, 0.000, 0.0),
        (1.060, 0.094, 0.084, 0.134, 0.134, 0.000, 0.0),
        (1.110, 0.096, 0.082, 0.130, 0.130, 0.000, 0.0),
        (1.170, 0.104, 0.090, 0.137, 0.137, 0.000, 0.0),
        (1.240, 0.112, 0.104, 0.152, 0.152, 0.000, 0.0),
        (1.310, 0.112, 0.114, 0.161, 0.161, -0.002, 0.0),
        (1.370, 0.096, 0.110, 0.156, 0.156, -0.006, 0.0),
        (1.415, 0.074, 0.090, 0.130, 0.130, -0.012, 0.0),
        (1.450, 0.054, 0.064, 0.080, 0.080, -0.016, 0.0),
    ]
    neck = [
        (0.000, 0.056, 0.060, 0.060, 0.060, 0.0, 0.0),
        (0.050, 0.053, 0.057, 0.056, 0.056, 0.0, 0.0),
        (0.130, 0.052, 0.055, 0.054, 0.054, 0.0, 0.0),
    ]
    return [
        (Loft((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), FORWARD, rows, (0.04, 0.03), 2.25), 0.0),
        (Loft((0.0, 1.430, -0.026), (0.0, 0.97, 0.24), FORWARD, neck, (0.02, 0.02)), 0.045),
        (RoundCone((0.020, 1.480, -0.040), (0.155, 1.412, -0.018), 0.030, 0.034), 0.05),
        (Ellipsoid((0.074, 1.318, 0.066), (0.078, 0.056, 0.044)), 0.05),
        (Ellipsoid((0.082, 1.335, -0.082), (0.066, 0.085, 0.036)), 0.05),
        (Ellipsoid((0.078, 0.885, -0.066), (0.076, 0.082, 0.062)), 0.05),
    ]


def _head() -> list[tuple[Shape, float]]:
    """Return the skull and the jaw."""
    return [
        (Ellipsoid((0.0, 1.655, -0.002), (0.080, 0.095, 0.098)), 0.0),
        (Ellipsoid((0.0, 1.605, 0.040), (0.064, 0.080, 0.064)), 0.05),
        (RoundCone((0.0, 1.552, 0.070), (0.0, 1.552, 0.071), 0.034, 0.034), 0.05),
        (RoundCone((0.058, 1.590, 0.010), (0.020, 1.548, 0.066), 0.016, 0.020), 0.05),
    ]


def _eye_sockets() -> list[Shape]:
    """Return what is taken from the skull for the eyes."""
    return [Ellipsoid((0.034, 1.640, 0.112), (0.024, 0.016, 0.020))]


def _face() -> list[tuple[Shape, float]]:
    """Return brow, nose, cheek and ear."""
    ear = matrix_from_quaternion(quaternion_from_euler("XYZ", [-0.25, -0.35, 0.12]))
    return [
        (RoundCone((0.012, 1.662, 0.091), (0.050, 1.664, 0.074), 0.011, 0.009), 0.02),
        (RoundCone((0.0, 1.652, 0.092), (0.0, 1.606, 0.112), 0.009, 0.0125), 0.016),
        (RoundCone((0.010, 1.602, 0.102), (0.0105, 1.602, 0.103), 0.009, 0.009), 0.012),
        (Ellipsoid((0.044, 1.610, 0.070), (0.022, 0.020, 0.018)), 0.03),
        (Ellipsoid((0.080, 1.628, -0.002), (0.009, 0.034, 0.020), ear), 0.010),
    ]


def _arm() -> list[tuple[Shape, float]]:
    """Return deltoid, upper arm and forearm."""
    upper = [
        (0.000, 0.056, 0.056, 0.054, 0.052, 0.0, 0.0),
        (0.050, 0.054, 0.055, 0.054, 0.048, 0.0, 0.0),
        (0.110, 0.049, 0.050, 0.046, 0.043, 0.002, 0.0),
        (0.170, 0.046, 0.046, 0.041, 0.040, 0.002, 0.0),
        (0.230, 0.039, 0.041, 0.037, 0.036, 0.0, 0.0),
        (0.283, 0.034, 0.036, 0.037, 0.036, 0.0, 0.0),
    ]
    fore = [
        (0.000, 0.034, 0.036, 0.036, 0.035, 0.0, 0.0),
        (0.045, 0.041, 0.037, 0.042, 0.038, 0.0, 0.0),
        (0.085, 0.042, 0.036, 0.042, 0.037, 0.0, 0.0),
        (0.160, 0.035, 0.031, 0.033, 0.029, 0.0, 0.0),
        (0.220, 0.029, 0.027, 0.023, 0.022, 0.0, 0.0),
        (0.255, 0.029, 0.027, 0.021, 0.020, 0.0, 0.0),
    ]
    shoulder, elbow, wrist = (
        np.array(p) for p in ((0.175, 1.405, -0.010), (0.375, 1.205, -0.020), (0.553, 1.027, 0.0))
    )
    return [
        (Loft(_t(shoulder), _t(elbow - shoulder), FORWARD, upper, (0.05, 0.02), mirrored=True), 0),
        (Loft(_t(elbow), _t(wrist - elbow), FORWARD, fore, (0.02, 0.02), mirrored=True), 0.03),
        (Ellipsoid((0.184, 1.398, -0.008), (0.058, 0.060, 0.060)), 0.03),
        (RoundCone((0.374, 1.206, -0.036), (0.380, 1.200, -0.036), 0.018, 0.018), 0.03),
    ]


def _hand_point(along: float, front: float, outer: float) -> Point:
    """Return a point of the left hand: from the wrist, to the thumb's side, to the back."""
    wrist, axis = np.array([0.553, 1.027, 0.0]), np.array(DOWN_45)
    return _t(
        wrist
        + along * axis
        + front * np.array(FORWARD)
        + outer * np.array([-axis[1], axis[0], 0.0])
    )


def _t(p: FloatArray) -> Point:
    """Return a point as a tuple."""
    return (float(p[0]), float(p[1]), float(p[2]))


def _thumb() -> list[RoundCone]:
    """Return the thumb's bones from its root to its tip."""
    places = [(0.018, 0.020, -0.006), (0.040, 0.040, -0.008), (0.070, 0.056, -0.013)]
    places.append((0.094, 0.062, -0.017))
    radii = (0.015, 0.0125, 0.011, 0.0088)
    return [
        RoundCone(_hand_point(*places[k]), _hand_point(*places[k + 1]), radii[k], radii[k + 1])
        for k in range(3)
    ]


def thumb_distance(points: FloatArray) -> FloatArray:
    """Return how far points ``(p, 3)`` lie from the left thumb, in metres."""
    every = [bone.distance(*points.T) for bone in _thumb()[1:]]
    return np.asarray(np.min(every, axis=0))


def _hand() -> list[tuple[Shape, float]]:
    """Return palm, thumb and fingers, a little curled."""
    palm = [
        (0.000, 0.027, 0.025, 0.018, 0.017, 0.000, 0.0),
        (0.035, 0.034, 0.032, 0.016, 0.018, 0.001, 0.0),
        (0.070, 0.041, 0.037, 0.014, 0.015, 0.001, 0.0),
        (0.090, 0.041, 0.037, 0.012, 0.012, 0.001, 0.0),
    ]
    shapes: list[tuple[Shape, float]] = [
        (Loft(_hand_point(0, 0, 0), DOWN_45, FORWARD, palm, (0.02, 0.008), 2.4, mirrored=True), 0),
    ]
    shapes += [(bone, 0.012) for bone in _thumb()]
    # knuckle (along, front, outer), spread, curl of each phalanx, lengths, radius
    rows = [
        ((0.088, 0.0325, 0.000), 0.13, (0.22, 0.48, 0.72), (0.043, 0.026, 0.019), 0.0092),
        ((0.092, 0.0115, 0.002), 0.04, (0.25, 0.53, 0.78), (0.047, 0.029, 0.020), 0.0094),
        ((0.089, -0.0095, 0.001), -0.05, (0.28, 0.58, 0.84), (0.043, 0.027, 0.019), 0.0090),
        ((0.081, -0.0290, -0.002), -0.15, (0.31, 0.63, 0.90), (0.034, 0.021, 0.017), 0.0080),
    ]
    for knuckle, spread, curls, lengths, radius in rows:
        at = np.array(knuckle)
        for k, (curl, length) in enumerate(zip(curls, lengths, strict=True)):
            way = normalized(
                [np.cos(curl) * np.cos(spread), np.cos(curl) * np.sin(spread), -np.sin(curl)]
            )
            to = at + length * way
            taper = radius * np.array([1.0, 0.92, 0.84, 0.72])
            shapes.append(
                (RoundCone(_hand_point(*at), _hand_point(*to), taper[k], taper[k + 1]), 0.006)
            )
            at = to
    return shapes


def _leg() -> list[tuple[Shape, float]]:
    """Return thigh, knee and calf."""
    thigh = [
        (0.000, 0.084, 0.086, 0.074, 0.078, 0.0, 0.0),
        (0.080, 0.084, 0.086, 0.076, 0.076, 0.0, 0.0),
        (0.170, 0.080, 0.078, 0.072, 0.069, 0.002, 0.0),
        (0.270, 0.069, 0.066, 0.063, 0.060, 0.003, 0.0),
        (0.350, 0.057, 0.056, 0.054, 0.055, 0.001, 0.0),
        (0.413, 0.051, 0.050, 0.050, 0.051, 0.0, 0.0),
    ]
    calf = [
        (0.000, 0.050, 0.049, 0.050, 0.050, 0.0, 0.0),
        (0.050, 0.045, 0.055, 0.051, 0.050, 0.0, 0.0),
        (0.120, 0.043, 0.067, 0.055, 0.054, 0.0, 0.0),
        (0.200, 0.041, 0.060, 0.049, 0.049, 0.0, 0.0),
        (0.290, 0.036, 0.042, 0.037, 0.037, 0.0, 0.0),
        (0.360, 0.033, 0.036, 0.032, 0.032, 0.0, 0.0),
        (0.408, 0.036, 0.038, 0.036, 0.034, 0.0, 0.0),
    ]
    hip, knee, ankle = (
        np.array(p) for p in ((0.092, 0.905, 0.0), (0.094, 0.492, 0.008), (0.096, 0.085, -0.020))
    )
    return [
        (Loft(_t(hip), _t(knee - hip), FORWARD, thigh, (0.05, 0.03)), 0.0),
        (Loft(_t(knee), _t(ankle - knee), FORWARD, calf, (0.03, 0.02)), 0.04),
        (Ellipsoid((0.094, 0.497, 0.044), (0.030, 0.036, 0.020)), 0.035),
    ]


def _foot() -> list[tuple[Shape, float]]:
    """Return heel, instep and toes on a flat sole."""
    # place along the foot, up, down, outer, inner, the centre's lift, the centre's shift outwards
    rows = [
        (0.000, 0.030, 0.026, 0.027, 0.027, 0.026, 0.000),
        (0.030, 0.048, 0.030, 0.034, 0.032, 0.030, 0.000),
        (0.070, 0.060, 0.030, 0.037, 0.034, 0.030, 0.001),
        (0.110, 0.050, 0.026, 0.039, 0.036, 0.026, 0.002),
        (0.150, 0.040, 0.022, 0.043, 0.041, 0.022, 0.003),
        (0.190, 0.028, 0.019, 0.046, 0.045, 0.019, 0.003),
        (0.225, 0.020, 0.016, 0.043, 0.041, 0.016, 0.001),
        (0.250, 0.015, 0.013, 0.034, 0.032, 0.013, -0.003),
    ]
    return [
        (
            Loft(
                (0.094, 0.0, -0.078),
                (0.03, 0.0, 1.0),
                (0.0, 1.0, 0.0),
                rows,
                (0.014, 0.018),
                2.6,
                mirrored=True,
            ),
            0,
        ),
    ]
