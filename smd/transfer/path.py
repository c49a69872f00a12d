"""GroundPath: where a device's doodles go over the ground, and which way its prop faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from laban.frozen import Frozen
from smd.doodle import Doodle
from smd.errors import DoodleError, TransferError
from smd.geometry.arrays import FloatArray, frozen_array
from smd.geometry.easing import gaussian_smoothed
from smd.geometry.rotations import rotate
from smd.smoothing import RATE_HZ, smooth
from smd.transfer.scene import SceneScale

PATH_SIGMA_S = 0.06
"""Smoothing of the place beyond `smd.smoothing`'s: the scene shows a hand's tremor ten times as
large. At a walk's 1.3 m/s a bend of 1 m radius is cut by v² σ² / 2r = 3 mm."""

HEADING_SIGMA_S = 0.15
"""Smoothing of the heading: a body turns less briskly than a wrist."""


@dataclass(frozen=True, slots=True, eq=False)
class GroundPath(Frozen):
    """A path over the ground.

    Attributes
    ----------
    time_s : (n,) increasing, on the recording's clock.
    position_m : (n, 2) x and z in the scene, without the jumps between doodles.
    heading_rad : (n,) the angle about +Y from +Z to the prop's front, without jumps of a whole
        turn.
    """

    time_s: FloatArray
    position_m: FloatArray
    heading_rad: FloatArray

    def __post_init__(self) -> None:
        n = len(self.time_s)
        for name, shape in (("time_s", (n,)), ("position_m", (n, 2)), ("heading_rad", (n,))):
            value = frozen_array(name, getattr(self, name), shape, TransferError)
            object.__setattr__(self, name, value)

    def at(self, time_s: FloatArray | float) -> FloatArray:
        """Return the place ``(…, 2)`` at some times; the ends are held outside."""
        axes = [np.interp(time_s, self.time_s, self.position_m[:, axis]) for axis in (0, 1)]
        return np.stack(axes, axis=-1)

    def heading_at(self, time_s: FloatArray | float) -> FloatArray:
        """Return the heading at some times; the ends are held outside."""
        return np.asarray(np.interp(time_s, self.time_s, self.heading_rad))


def ground_path(doodles: Sequence[Doodle], scene: SceneScale) -> GroundPath:
    """Project a device's doodles to the ground.

    Where tracking was lost between two doodles, the path stays where it was and goes on from
    there: nobody saw how the prop came to its new place.
    """
    times, places, fronts = [], [], []
    here = None
    for doodle in doodles:
        time_s, position_m, front = _smoothed(doodle, scene)
        jump = 0.0 if here is None else here - position_m[0]
        places.append(position_m + jump)
        here = places[-1][-1]
        times.append(time_s)
        fronts.append(np.unwrap(np.arctan2(front[:, 0], front[:, 1])))
    for before, after in pairwise(fronts):
        after += 2.0 * np.pi * np.round((before[-1] - after[0]) / (2.0 * np.pi))
    return GroundPath(np.concatenate(times), np.concatenate(places), np.concatenate(fronts))


def _smoothed(doodle: Doodle, scene: SceneScale) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return a doodle's times, places (x, z) and fronts over the ground (x, z)."""
    try:
        motion = smooth(doodle)
        time_s, position, orientation = motion.time_s, motion.position_m, motion.orientation_xyzw
    except DoodleError:  # too short to smooth: it holds no phrase, but a place to stand
        time_s, position, orientation = (
            doodle.time_s,
            doodle.position_m,
            doodle.orientation_xyzw,
        )
    over_ground = scene.placed(position)[:, [0, 2]]
    return (
        time_s,
        gaussian_smoothed(over_ground, PATH_SIGMA_S * RATE_HZ),
        gaussian_smoothed(front_over_ground(orientation), HEADING_SIGMA_S * RATE_HZ),
    )


def front_over_ground(orientation_xyzw: FloatArray) -> FloatArray:
    """Return which way a prop faces over the ground: x and z ``(…, 2)``, of any length.

    It is the front's projection as long as the prop is held about level. The steeper its front
    points up or down, the more its underside or its back decides: a figurine that bows faces
    the way its back does, also when it bows beyond the vertical.
    """
    front = rotate(
        orientation_xyzw, np.broadcast_to([0.0, 0.0, 1.0], (*orientation_xyzw.shape[:-1], 3))
    )
    up = rotate(
        orientation_xyzw, np.broadcast_to([0.0, 1.0, 0.0], (*orientation_xyzw.shape[:-1], 3))
    )
    steep = front[..., 1:2] ** 3
    return front[..., [0, 2]] - steep * up[..., [0, 2]]
