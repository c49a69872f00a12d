"""Eyes for any face: a ball with iris, pupil and glint, and lids that close over it.

An eye's own directions are outward, up and ahead; it may look out to the side. Lids are shells
around the ball, whose margins go up and down on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.displacement import Motion
from actions_library.authoring.rigging import Point
from actions_library.authoring.solids import Solid, cap_grid, on_both_sides_of, solid_mesh
from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized

IRIS, PUPIL, GLINT = 1.008, 1.014, 1.020
LID_INSIDE, LID_OUTSIDE = 1.070, 1.130
"""Radii of what lies on the ball, as shares of the ball's."""

LID_END_RAD = np.radians(112.0)
"""How far up and down lids reach, into the flesh."""

MEET = 0.22
"""Where lids meet, as a share of the way from the lower margin to the upper."""

WHITE_RGB, BLACK_RGB = (0.86, 0.84, 0.80), (0.01, 0.01, 0.012)

_MARGIN_SLACK = 0.15
"""How much farther out a closed lid is, for each radian that its points have gone: on the straight
way there they would cut into the ball."""


@dataclass(frozen=True, slots=True)
class Eye:
    """The left eye.

    Attributes
    ----------
    centre, radius : of the ball (m).
    out_deg : how far it looks out to the side at rest.
    iris_deg, pupil_deg : how large they are, as angles from their middle.
    slit : width of the pupil as a share of its height.
    upper_deg, lower_deg : elevation of the open lids' margins in the middle.
    corner : how far out the corners are, as a share of the radius.
    """

    centre: Point
    radius: float
    out_deg: float = 0.0
    iris_deg: float = 31.0
    pupil_deg: float = 15.0
    slit: float = 1.0
    upper_deg: float = 34.0
    lower_deg: float = -30.0
    corner: float = 0.95

    @property
    def axes(self) -> FloatArray:
        """Directions outward, up and ahead in the world, as columns."""
        out = np.radians(self.out_deg)
        sine, cosine = np.sin(out), np.cos(out)
        return np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])

    def margins(self, outward: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the open margins' elevations (rad), over the share of the radius outward."""
        bow = np.maximum(1.0 - (outward / self.corner) ** 2, 0.0)
        return np.radians(self.upper_deg) * bow, np.radians(self.lower_deg) * bow

    def meeting(self, outward: FloatArray) -> FloatArray:
        """Return the elevation at which closed lids meet (rad)."""
        upper, lower = self.margins(outward)
        return lower + MEET * (upper - lower)


def eye_meshes(
    eye: Eye, skeleton: Skeleton, joint: str, iris_rgb: tuple[float, float, float]
) -> tuple[Mesh, ...]:
    """Return both eyes, which the joints of that name on either side turn."""

    def lid(radius: float, polar_deg: float, at: FloatArray, width: float = 1.0) -> Solid:
        directions, triangles = cap_grid(np.radians(polar_deg), 12 if polar_deg > 90 else 5, 32)
        frame = _facing(at)
        flat = directions * [width, 1.0, 1.0]
        points = normalized(flat) @ frame @ eye.axes.T * (radius * eye.radius)
        return Solid(joint, np.array(eye.centre) + points, triangles)

    ahead = np.array([0.0, 0.0, 1.0])
    parts = (
        ("eyes", lid(1.0, 180.0, ahead), WHITE_RGB),
        ("irises", lid(IRIS, eye.iris_deg, ahead), iris_rgb),
        ("pupils", lid(PUPIL, eye.pupil_deg, ahead, eye.slit), BLACK_RGB),
        ("glints", lid(GLINT, 5.5, np.array([-0.17, 0.22, 1.0])), (1.0, 1.0, 1.0)),
    )
    return tuple(
        solid_mesh(name, skeleton, on_both_sides_of([solid]), rgb) for name, solid, rgb in parts
    )


def lid_mesh(
    eye: Eye, skeleton: Skeleton, joint: str, color_rgb: tuple[float, float, float]
) -> Mesh:
    """Return the lids of both eyes, open, upper and lower, on the joint that carries the eyes."""
    solids = [Solid(joint, *_lid(eye, upper=upper)) for upper in (True, False)]
    return solid_mesh("lids", skeleton, on_both_sides_of(solids), color_rgb)


def lids_moved(eye: Eye, upper_share: float, lower_share: float) -> Motion:
    """Return the motion of the left lids by a share of their way to where they meet.

    1 closes, below 0 opens wider.
    """

    def motion(points: FloatArray) -> FloatArray:
        x, y, z = ((points - np.array(eye.centre)) @ eye.axes).T
        away = np.sqrt(x**2 + y**2 + z**2)
        around = np.hypot(y, z)
        elevation = np.arctan2(y, z)
        outward = x / np.maximum(away, 1e-9)
        upper, lower = eye.margins(outward)
        meet = eye.meeting(outward)
        up = elevation > meet
        margin, end = np.where(up, upper, lower), np.where(up, LID_END_RAD, -LID_END_RAD)
        to = margin + np.where(up, upper_share, lower_share) * (meet - margin)
        share = np.clip((end - elevation) / (end - margin), 0.0, 1.05)
        turned = elevation + share * (to - margin)
        grown = 1.0 + _MARGIN_SLACK * np.abs(turned - elevation) ** 2
        moved = np.column_stack(
            [grown * x, grown * around * np.sin(turned), grown * around * np.cos(turned)]
        )
        offset = (moved - np.column_stack([x, y, z])) @ eye.axes.T
        return np.where((away < 1.3 * eye.radius)[:, None], offset, 0.0)

    return motion


def pupils_scaled(eye: Eye, by: float) -> Motion:
    """Return the motion of the left pupil's points away from its middle."""

    def motion(points: FloatArray) -> FloatArray:
        local = (points - np.array(eye.centre)) @ eye.axes
        around = local * [1.0, 1.0, 0.0]
        length = np.linalg.norm(local, axis=1, keepdims=True)
        to = normalized(local + (by - 1.0) * around) * length
        offset = (to - local) @ eye.axes.T
        return np.where(length < 1.3 * eye.radius, offset, 0.0)

    return motion


def _facing(at: FloatArray) -> FloatArray:
    """Return a frame whose rows are across, up and the direction given."""
    ahead = normalized(at)
    across = normalized(np.cross([0.0, 1.0, 0.0], ahead))
    return np.stack([across, np.cross(ahead, across), ahead])


def _lid(eye: Eye, *, upper: bool) -> tuple[FloatArray, IntArray]:
    """Return a shell: from its end in the flesh down its outside, round its margin and back."""
    columns, rows = 23, 8
    turn = np.linspace(-1.0, 1.0, columns) * np.radians(84.0)
    outward = np.sin(turn)
    margin = eye.margins(outward)[0 if upper else 1]
    end = LID_END_RAD if upper else -LID_END_RAD
    share = 1.0 - (1.0 - np.linspace(0.0, 1.0, rows)) ** 1.5
    way = np.concatenate([share, share[::-1]])
    radius = np.concatenate([np.full(rows, LID_OUTSIDE), np.full(rows, LID_INSIDE)])
    elevation = end + way[:, None] * (margin - end)
    level = np.cos(turn)
    points = np.stack(
        [
            np.broadcast_to(outward, elevation.shape),
            level * np.sin(elevation),
            level * np.cos(elevation),
        ],
        axis=-1,
    )
    points = points * (radius[:, None, None] * eye.radius)
    k = (np.arange(2 * rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    faces = np.concatenate(
        [
            np.column_stack([k, k + columns, k + 1]),
            np.column_stack([k + 1, k + columns, k + columns + 1]),
        ]
    )
    if not upper:
        faces = faces[:, ::-1]
    return np.array(eye.centre) + points.reshape(-1, 3) @ eye.axes.T, faces
