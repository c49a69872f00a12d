"""Walking and running: cyclic clips of two steps."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import Plant, Via, other_foot, repeated
from actions_library.authoring.keys import Arm, Key, Place, Turn, both_sides
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import steady_travel
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def walk(skeleton: Skeleton) -> Clip:
    """Two steps: heel strike, roll over the ball, toes off; the four classic poses per step."""
    duration, stride = 64 / 60, 1.40
    half = [
        Key(  # contact: the left heel strikes
            0.0,
            place=Place(left=-0.004, up=-0.038),
            hips=Turn(yaw=-6.0, lean=3.0, tilt=0.5),
            chest=Turn(yaw=6.0, lean=3.0, tilt=0.0),
            head=Turn(yaw=1.0, lean=3.0, tilt=0.0),
            left_arm=Arm(to=(0.25, -1.0, -0.42), bend=12.0, flex=10.0),
            right_arm=Arm(to=(0.13, -1.0, 0.44), bend=34.0, flex=2.0),
        ),
        Key(  # down: the weight arrives
            0.11,
            place=Place(left=0.014, up=-0.041),
            hips=Turn(yaw=-4.5, lean=4.0, tilt=3.5),
            chest=Turn(yaw=5.0, lean=4.0, tilt=-1.5),
            head=Turn(yaw=0.5, lean=5.0, tilt=0.0),
        ),
        Key(  # passing
            0.27,
            place=Place(left=0.030, up=-0.017),
            hips=Turn(yaw=0.5, lean=3.0, tilt=2.0),
            chest=Turn(yaw=0.0, lean=2.5, tilt=-1.5),
            head=Turn(yaw=0.0, lean=3.0, tilt=0.0),
        ),
        Key(  # up: rolling over the ball
            0.39,
            place=Place(left=0.018, up=-0.024),
            hips=Turn(yaw=4.5, lean=2.5, tilt=0.5),
            chest=Turn(yaw=-4.5, lean=2.0, tilt=-0.5),
            head=Turn(yaw=-0.5, lean=2.0, tilt=0.0),
        ),
    ]
    step = Plant(
        land=0.0,
        leave=0.61 * duration,
        left=0.070,
        ahead=0.305,
        yaw=6.0,
        land_pitch=-20.0,
        flat=0.10,
        leave_pitch=66.0,
        roll=0.36,
        swing=(
            Via(0.20, 0.130, along=0.24, pitch=56.0, toes=24.0),
            Via(0.46, 0.105, along=0.53, pitch=24.0),
            Via(0.80, 0.040, along=0.90, pitch=-16.0),
        ),
    )
    return _travelling(skeleton, "walk", duration, both_sides(half), step, ahead=stride)


def run(skeleton: Skeleton) -> Clip:
    """Two strides with a flight after each."""
    duration, stride = 42 / 60, 2.40
    half = [
        Key(  # the left foot lands
            0.0,
            place=Place(left=0.0, up=-0.036),
            hips=Turn(yaw=-7.0, lean=10.0, tilt=0.0),
            chest=Turn(yaw=9.0, lean=13.0, tilt=0.0),
            head=Turn(yaw=1.0, lean=6.0),
            left_arm=Arm(
                to=(0.34, -1.0, -0.12), bend=88.0, elbow=(0.35, 0.0, -1.0), twist=5.0, curl=115.0
            ),
            right_arm=Arm(
                to=(-0.20, -0.25, 1.0), bend=104.0, elbow=(0.5, -1.0, -0.2), twist=5.0, curl=115.0
            ),
        ),
        Key(
            0.12,
            place=Place(left=0.012, up=-0.068),
            hips=Turn(yaw=-3.0, lean=11.0, tilt=4.0),
            chest=Turn(yaw=4.0, lean=15.0, tilt=-1.5),
            head=Turn(yaw=0.5, lean=8.0),
        ),
        Key(
            0.21,
            left_arm=Arm(
                to=(0.02, -1.0, 0.45), bend=92.0, elbow=(0.5, -0.4, -1.0), twist=5.0, curl=115.0
            ),
            right_arm=Arm(
                to=(0.02, -1.0, 0.45), bend=92.0, elbow=(0.5, -0.4, -1.0), twist=5.0, curl=115.0
            ),
        ),
        Key(  # toes off
            0.29,
            place=Place(left=0.010, up=-0.030),
            hips=Turn(yaw=6.0, lean=10.0, tilt=1.0),
            chest=Turn(yaw=-6.0, lean=12.5, tilt=-1.0),
            head=Turn(yaw=-0.5, lean=6.0),
        ),
        Key(0.40, place=Place(left=0.004, up=-0.006)),
    ]
    step = Plant(
        land=0.0,
        leave=0.29 * duration,
        left=0.055,
        ahead=0.21,
        yaw=4.0,
        land_pitch=-8.0,
        flat=0.045,
        leave_pitch=68.0,
        roll=0.135,
        swing=(
            Via(0.34, 0.42, along=0.30, pitch=92.0),
            Via(0.68, 0.30, along=0.76, pitch=30.0),
        ),
    )
    return _travelling(skeleton, "run", duration, both_sides(half), step, ahead=stride)


def _travelling(
    skeleton: Skeleton,
    name: str,
    duration: float,
    keys: tuple[Key, ...],
    step: Plant,
    *,
    ahead: float,
) -> Clip:
    """Return a gait from the left foot's plant; the right foot's comes half a cycle later."""
    other = other_foot(
        replace(step, land=step.land + duration / 2, leave=step.leave + duration / 2)
    )
    other = replace(other, ahead=step.ahead + ahead / 2)
    return make_clip(
        skeleton,
        name,
        keys,
        steady_travel(duration, ahead=ahead),
        left_foot=repeated([step], duration, left=0.0, ahead=ahead),
        right_foot=repeated([other], duration, left=0.0, ahead=ahead),
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )
