"""Side-steps: one foot goes, the other closes."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import Plant, Via, other_foot, repeated
from actions_library.authoring.keys import ArmKey, Key, Place, Turn, mirrored
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import steady_travel
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def side_step_left(skeleton: Skeleton) -> Clip:
    """Return the side-step: the left foot goes, the right foot closes."""
    return _side_step(skeleton, "side_step_left", 1.0)


def side_step_right(skeleton: Skeleton) -> Clip:
    """Return the side-step's mirror image."""
    return _side_step(skeleton, "side_step_right", -1.0)


def _side_step(skeleton: Skeleton, name: str, to: float) -> Clip:
    duration, stride = 54 / 60, 0.60
    near = ArmKey(to=(0.28, -1.0, 0.28), bend=46.0, elbow=(0.7, 0.0, -1.0))
    wide = ArmKey(to=(0.66, -1.0, 0.16), bend=26.0, elbow=(0.8, 0.2, -1.0))
    keys = [
        Key(  # feet together, pushing off the right one
            0.0,
            place=Place(left=-0.015, up=-0.030),
            hips=Turn(yaw=0.0, lean=7.0, tilt=-1.0),
            chest=Turn(yaw=3.0, lean=7.0, tilt=0.0),
            head=Turn(yaw=10.0, lean=3.0, tilt=0.0),
            left_arm=near,
            right_arm=replace(near, to=(0.34, -1.0, 0.30), bend=40.0),
        ),
        Key(
            0.22,
            place=Place(left=0.0, up=-0.046),
            hips=Turn(yaw=2.0, lean=8.0, tilt=3.0),
            chest=Turn(yaw=4.0, lean=8.0, tilt=-4.0),
            head=Turn(yaw=12.0, lean=3.0, tilt=-1.0),
        ),
        Key(  # the left foot lands wide
            0.45,
            place=Place(left=0.012, up=-0.092),
            hips=Turn(yaw=1.0, lean=9.0, tilt=0.0),
            chest=Turn(yaw=4.0, lean=10.0, tilt=1.0),
            head=Turn(yaw=12.0, lean=5.0, tilt=0.0),
            left_arm=wide,
            right_arm=replace(wide, to=(0.54, -1.0, 0.20), bend=32.0),
        ),
        Key(
            0.70,
            place=Place(left=0.018, up=-0.046),
            hips=Turn(yaw=-1.0, lean=7.0, tilt=-4.0),
            chest=Turn(yaw=3.0, lean=7.0, tilt=3.5),
            head=Turn(yaw=10.0, lean=3.0, tilt=1.0),
        ),
    ]
    leading = Plant(
        land=0.44 * duration,
        leave=1.04 * duration,
        left=0.70,
        ahead=0.01,
        yaw=8.0,
        land_pitch=12.0,
        flat=0.07,
        leave_pitch=20.0,
        roll=0.12,
        swing=(Via(0.5, 0.085, pitch=6.0),),
    )
    closing = Plant(
        land=-0.06 * duration,
        leave=0.52 * duration,
        left=-0.10,
        ahead=-0.01,
        yaw=-8.0,
        land_pitch=14.0,
        flat=0.07,
        leave_pitch=34.0,
        roll=0.16,
        swing=(Via(0.5, 0.075, pitch=12.0),),
    )
    if to < 0:
        keys = [mirrored(key) for key in keys]
        leading, closing = other_foot(leading), other_foot(closing)
    feet = [repeated([foot], duration, left=to * stride, ahead=0.0) for foot in (leading, closing)]
    left, right = feet if to > 0 else reversed(feet)
    return make_clip(
        skeleton,
        name,
        keys,
        steady_travel(duration, left=to * stride),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )
