"""Quick steps, for ways that are too fast to be walked: a gallop aside, running backward."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from actions_library.authoring.feet import Plant, Via, other_foot, repeated
from actions_library.authoring.hand_poses import FIST, HOLD
from actions_library.authoring.keys import ArmKey, Key, Place, Turn, both_sides, mirrored
from actions_library.authoring.posing import make_clip
from actions_library.authoring.pushes import Push, driven
from actions_library.authoring.stance import steady_travel
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

_BARELY_S = 0.025
"""Time after landing and before leaving in which a foot hardly bears weight. Without it, softened
keys would blunt flights that are so short."""

_BALL_M = 0.03
"""How much nearer to the body a foot pushes than its ankle is: on the inner edge of its ball."""

_MASS_CENTRE_M = 0.88
"""Its height over the ground, with bent knees."""


def gallop_left(skeleton: Skeleton) -> Clip:
    """Return the gallop: the left foot swings far out, the right one closes to it in the air."""
    return _gallop(skeleton, "gallop_left", 1.0)


def gallop_right(skeleton: Skeleton) -> Clip:
    """Return the gallop's mirror image."""
    return _gallop(skeleton, "gallop_right", -1.0)


def _gallop(skeleton: Skeleton, name: str, to: float) -> Clip:
    duration, stride = 32 / 60, 1.00
    off, landed, gone = 11.0 / 60, 15.0 / 60, 26.0 / 60
    near, far = 0.095, 0.44  # of a foot from the body's middle; nearer, one would step on the other
    guard = ArmKey(
        to=(0.10, -0.42, 0.85), bend=108.0, elbow=(0.6, -1.0, -0.3), twist=-20.0, fingers=FIST
    )
    keys = [
        Key(  # the right foot lands below the body
            0.0,
            hips=Turn(yaw=-2.0, lean=14.0, tilt=0.0),
            chest=Turn(yaw=1.0, lean=12.0, tilt=0.0),
            head=Turn(yaw=4.0, lean=6.0, tilt=0.0),
            left_arm=guard,
            right_arm=guard,
        ),
        Key(  # and pushes, the left one on its way out
            0.20,
            hips=Turn(yaw=0.0, lean=15.0, tilt=2.5),
            chest=Turn(yaw=2.0, lean=13.0, tilt=-2.5),
        ),
        Key(  # wide in the air
            0.42,
            hips=Turn(yaw=1.5, lean=15.0, tilt=0.0),
            chest=Turn(yaw=2.0, lean=13.0, tilt=0.0),
            head=Turn(yaw=4.0, lean=7.0, tilt=0.0),
            left_arm=replace(guard, to=(0.32, -0.50, 0.80), bend=98.0),
            right_arm=replace(guard, to=(0.28, -0.52, 0.80), bend=100.0),
        ),
        Key(  # the left foot bears, the right one closes
            0.65,
            hips=Turn(yaw=-1.0, lean=15.0, tilt=-2.5),
            chest=Turn(yaw=1.0, lean=13.5, tilt=2.0),
        ),
    ]
    closing = Plant(
        land=0.0,
        leave=off,
        left=-near,
        ahead=0.0,
        yaw=-8.0,
        land_pitch=12.0,
        flat=0.05,
        leave_pitch=30.0,
        roll=0.09,
        swing=(Via(0.40, 0.08, along=0.32, pitch=20.0), Via(0.75, 0.07, along=0.78, pitch=16.0)),
    )
    leading = Plant(
        land=landed,
        leave=gone,
        left=landed / duration * stride + far,
        ahead=0.0,
        yaw=8.0,
        land_pitch=6.0,
        flat=0.05,
        leave_pitch=26.0,
        roll=0.09,
        swing=(Via(0.25, 0.08, along=0.20, pitch=20.0), Via(0.60, 0.09, along=0.68, pitch=8.0)),
    )
    pushes = (
        Push(_BARELY_S, off - _BARELY_S, near - _BALL_M, far - _BALL_M),
        Push(landed + _BARELY_S, gone - _BARELY_S, _BALL_M - far, _BALL_M - near),
    )
    up, along = driven(pushes, duration, height_m=_MASS_CENTRE_M)
    keys += _placed(up - 0.130, along, np.full_like(up, -0.02))
    if to < 0:
        keys = [mirrored(key) for key in keys]
        leading, closing = other_foot(leading), other_foot(closing)
    feet = (leading, closing) if to > 0 else (closing, leading)
    return _cycle(skeleton, name, duration, keys, feet, left=to * stride)


def run_backward(skeleton: Skeleton) -> Clip:
    """Two steps of running backward, on the balls of the feet, with a short flight after each."""
    duration, stride = 40 / 60, -1.32
    off = 15.0 / 60
    half = [
        Key(  # the left ball lands behind
            0.0,
            hips=Turn(yaw=6.0, lean=12.0, tilt=0.0),
            chest=Turn(yaw=-5.0, lean=17.0, tilt=0.0),
            head=Turn(yaw=0.0, lean=7.0, tilt=0.0),
            left_arm=ArmKey(
                to=(0.16, -0.80, 0.50), bend=92.0, elbow=(0.5, -0.6, -1.0), fingers=HOLD
            ),
            right_arm=ArmKey(
                to=(0.30, -1.0, 0.02), bend=84.0, elbow=(0.5, 0.0, -1.0), fingers=HOLD
            ),
        ),
        Key(
            0.18,
            hips=Turn(yaw=0.0, lean=13.0, tilt=3.0),
            chest=Turn(yaw=0.0, lean=19.0, tilt=-1.5),
            head=Turn(yaw=0.0, lean=8.0, tilt=0.0),
        ),
    ]
    step = Plant(
        land=0.0,
        leave=off,
        left=0.085,
        ahead=-0.33,
        yaw=6.0,
        land_pitch=26.0,
        flat=0.10,
        leave_pitch=12.0,
        roll=0.07,
        swing=(
            Via(0.16, 0.10, along=0.08, pitch=8.0),
            Via(0.45, 0.20, along=0.46, pitch=30.0),
            Via(0.80, 0.14, along=0.90, pitch=38.0),
        ),
    )
    other = other_foot(replace(step, land=duration / 2, leave=duration / 2 + off))
    other = replace(other, ahead=step.ahead + stride / 2)
    pushes = [
        Push(first + _BARELY_S, first + off - _BARELY_S, -0.30, 0.30)
        for first in (0.0, duration / 2)
    ]
    up, along = driven(pushes, duration, height_m=_MASS_CENTRE_M)
    phase = 2.0 * np.pi * (np.arange(len(up)) / len(up) - 0.5 * off / duration)
    sway = 0.012 * np.cos(phase)  # furthest to the left in the middle of the left foot's stand
    keys = [*both_sides(half), *_placed(up - 0.085, sway, -along)]
    return _cycle(skeleton, "run_backward", duration, keys, (step, other), ahead=stride)


def _placed(up: FloatArray, left: FloatArray, ahead: FloatArray) -> list[Key]:
    """Return keys of the hips at each frame of a cycle."""
    rows = np.stack([left, up, ahead], axis=1).tolist()
    return [Key(i / len(rows), place=Place(*row)) for i, row in enumerate(rows)]


def _cycle(
    skeleton: Skeleton,
    name: str,
    duration: float,
    keys: Sequence[Key],
    feet: tuple[Plant, Plant],
    *,
    left: float = 0.0,
    ahead: float = 0.0,
) -> Clip:
    """Return a gait in which the left foot and the right one stand once a cycle."""
    left_foot, right_foot = (repeated([foot], duration, left=left, ahead=ahead) for foot in feet)
    return make_clip(
        skeleton,
        name,
        keys,
        steady_travel(duration, left=left, ahead=ahead),
        left_foot=left_foot,
        right_foot=right_foot,
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )
