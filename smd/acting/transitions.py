"""Transitions: blending from the end of one move into the next, without a jump.

At the boundary the difference between the two poses, with its velocity, is added to the next move
and decays over its first moments ("inertialisation" [1]_). The move before is unchanged, and no
move has to be played beyond its end.

References
----------
.. [1] D. Bollo, "Inertialization: High-Performance Animation Transitions in 'Gears of War'",
   Game Developers Conference 2018.
"""

from __future__ import annotations

import numpy as np

from smd.character.poses import Poses
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.easing import fading, smootherstep
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_from_rotvec,
    rotvec_from_quaternion,
)

TRANSITION_S = 0.3
"""Time in which a difference decays, where joints are not far apart."""

TURNING_RAD_S = np.radians(240.0)
"""Mean speed of a joint in a longer transition: a raised arm needs longer to come down. The
greatest speed is 1.9 times as much."""


def transition_s(before: Poses, after: Poses, joints: IntArray | None = None) -> float:
    """Return the duration of the transition into a move.

    Parameters
    ----------
    before, after
        The first move's last two poses, and the second one's first two.
    joints
        Those whose turns count (`smd.character.roles.without_digits`); by default all.
    """
    count = slice(None) if joints is None else joints
    same = np.sum(before.rotation_xyzw[1, count] * after.rotation_xyzw[0, count], axis=-1)
    farthest = 2.0 * float(np.arccos(np.clip(np.abs(same).min(), 0.0, 1.0)))
    return max(TRANSITION_S, farthest / TURNING_RAD_S)


def carried_over(
    before: Poses, after: Poses, into: Poses, passed_s: FloatArray, *, over_s: float, step_s: float
) -> Poses:
    """Let the difference between two moves decay over the first poses of the second.

    Parameters
    ----------
    before
        The first move's last two poses, ``step_s`` apart.
    after
        The second move's first two poses, ``step_s`` apart.
    into
        The second move's poses, to be corrected.
    passed_s
        ``(n,)`` time of each pose since the boundary, from 0 to ``over_s``.
    """
    b_q, a_q = before.rotation_xyzw, after.rotation_xyzw
    turn = rotvec_from_quaternion(multiply(inverse(a_q[0]), b_q[1]))
    turning = _turned(b_q) - _turned(a_q)
    b_t, a_t = before.translation_m, after.translation_m
    shift = b_t[1] - a_t[0]
    shifting = (b_t[1] - b_t[0]) - (a_t[1] - a_t[0])

    x = passed_s / over_s
    rest = (1.0 - smootherstep(x))[:, None, None]
    swing = (fading(x) * over_s / step_s)[:, None, None]
    return Poses(
        multiply(into.rotation_xyzw, quaternion_from_rotvec(rest * turn + swing * turning)),
        into.translation_m + rest * shift + swing * shifting,
    )


def _turned(q: FloatArray) -> FloatArray:
    return rotvec_from_quaternion(multiply(inverse(q[0]), q[1]))
