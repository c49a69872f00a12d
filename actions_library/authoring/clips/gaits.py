"""Walking and running: cyclic clips of two steps."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import Plant, Via, other_foot, repeated
from actions_library.authoring.hand_poses import FIST, RELAXED
from actions_library.authoring.keys import ArmKey, Key, Place, Turn, both_sides
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
            left_arm=ArmKey(to=(0.25, -1.0, -0.42), bend=12.0, flex=10.0),
            right_arm=ArmKey(to=(0.13, -1.0, 0.44), bend=34.0, flex=2.0),
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
            left_arm=ArmKey(
                to=(0.34, -1.0, -0.12), bend=88.0, elbow=(0.35, 0.0, -1.0), twist=5.0, fingers=FIST
            ),
            right_arm=ArmKey(
                to=(-0.20, -0.25, 1.0), bend=104.0, elbow=(0.5, -1.0, -0.2), twist=5.0, fingers=FIST
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
            left_arm=ArmKey(
                to=(0.02, -1.0, 0.45), bend=92.0, elbow=(0.5, -0.4, -1.0), twist=5.0, fingers=FIST
            ),
            right_arm=ArmKey(
                to=(0.02, -1.0, 0.45), bend=92.0, elbow=(0.5, -0.4, -1.0), twist=5.0, fingers=FIST
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


def sneak(skeleton: Skeleton) -> Clip:
    """Two long, low steps on the toes, knees lifted high, hands held before the chest."""
    duration, stride = 108 / 60, 1.16
    paw = ArmKey(
        to=(0.06, -0.62, 0.9), bend=78.0, elbow=(0.9, -0.3, -0.7), flex=62.0, fingers=RELAXED
    )
    half = [
        Key(  # the left toes touch, the weight still behind
            0.0,
            place=Place(left=-0.020, up=-0.175),
            hips=Turn(yaw=-10.0, lean=22.0, tilt=-2.0),
            chest=Turn(yaw=9.0, lean=40.0, tilt=3.0),
            head=Turn(yaw=14.0, lean=6.0, tilt=3.0),
            left_arm=replace(paw, to=(0.10, -0.66, 0.66)),
            right_arm=replace(paw, to=(0.02, -0.45, 1.0), bend=66.0),
        ),
        Key(  # and sinks onto it
            0.14,
            place=Place(left=0.030, up=-0.215),
            hips=Turn(yaw=-6.0, lean=25.0, tilt=4.0),
            chest=Turn(yaw=7.0, lean=44.0, tilt=-3.0),
            head=Turn(yaw=18.0, lean=9.0, tilt=-3.0),
        ),
        Key(  # rises, the other knee coming up
            0.33,
            place=Place(left=0.055, up=-0.135),
            hips=Turn(yaw=2.0, lean=17.0, tilt=5.0),
            chest=Turn(yaw=0.0, lean=32.0, tilt=-4.0),
            head=Turn(yaw=4.0, lean=4.0, tilt=-1.0),
            left_arm=replace(paw, to=(0.06, -0.50, 0.9), bend=92.0),
            right_arm=replace(paw, to=(0.06, -0.50, 0.9), bend=92.0),
        ),
    ]
    step = Plant(
        land=0.0,
        leave=0.60 * duration,
        left=0.085,
        ahead=0.30,
        yaw=12.0,
        land_pitch=34.0,
        flat=0.24,
        leave_pitch=52.0,
        roll=0.34,
        swing=(
            Via(0.28, 0.24, along=0.22, pitch=58.0, toes=10.0),
            Via(0.58, 0.34, along=0.60, pitch=34.0),
            Via(0.84, 0.14, along=0.95, pitch=30.0),
        ),
    )
    return _travelling(skeleton, "sneak", duration, both_sides(half), step, ahead=stride)


def walk_backward(skeleton: Skeleton) -> Clip:
    """Two steps back: toes first, rolling onto the heel, a look over the shoulder."""
    duration, stride = 72 / 60, -0.92
    half = [
        Key(  # the left toes land behind
            0.0,
            place=Place(left=-0.006, up=-0.046),
            hips=Turn(yaw=8.0, lean=4.0, tilt=0.5),
            chest=Turn(yaw=4.0, lean=6.0, tilt=0.0),
            left_arm=ArmKey(to=(0.24, -1.0, 0.34), bend=36.0),
            right_arm=ArmKey(to=(0.30, -1.0, -0.14), bend=24.0),
        ),
        Key(
            0.13,
            place=Place(left=0.016, up=-0.050),
            hips=Turn(yaw=5.0, lean=5.0, tilt=3.5),
            chest=Turn(yaw=6.0, lean=7.0, tilt=-1.5),
        ),
        Key(
            0.30,
            place=Place(left=0.030, up=-0.024),
            hips=Turn(yaw=-1.0, lean=4.0, tilt=2.0),
            chest=Turn(yaw=9.0, lean=5.5, tilt=-1.0),
        ),
    ]
    looking = (
        Key(0.0, head=Turn(yaw=58.0, lean=7.0, tilt=-2.0)),
        Key(0.5, head=Turn(yaw=66.0, lean=5.0, tilt=2.0)),
    )
    step = Plant(
        land=0.0,
        leave=0.61 * duration,
        left=0.085,
        ahead=-0.36,
        yaw=8.0,
        land_pitch=30.0,
        flat=0.20,
        leave_pitch=-14.0,
        roll=0.20,
        swing=(
            Via(0.30, 0.075, along=0.28, pitch=4.0),
            Via(0.66, 0.125, along=0.74, pitch=30.0),
        ),
    )
    keys = (*both_sides(half), *looking)
    return _travelling(skeleton, "walk_backward", duration, keys, step, ahead=stride)


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
