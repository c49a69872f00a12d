"""Clips that travel: walk, run, side-steps, flight and the leap."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import Plant, Via, other_foot, repeated
from actions_library.authoring.keys import (
    Arm,
    Key,
    Leg,
    Place,
    Turn,
    at,
    both_sides,
    carried,
    mirrored,
)
from actions_library.authoring.posing import RATE_HZ, make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    moved_in_one_go,
    steady_travel,
)
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


def side_step_left(skeleton: Skeleton) -> Clip:
    """Return the side-step: the left foot goes, the right foot closes."""
    return _side_step(skeleton, "side_step_left", 1.0)


def side_step_right(skeleton: Skeleton) -> Clip:
    """Return the side-step's mirror image."""
    return _side_step(skeleton, "side_step_right", -1.0)


def _side_step(skeleton: Skeleton, name: str, to: float) -> Clip:
    duration, stride = 54 / 60, 0.60
    near = Arm(to=(0.28, -1.0, 0.28), bend=46.0, elbow=(0.7, 0.0, -1.0))
    wide = Arm(to=(0.66, -1.0, 0.16), bend=26.0, elbow=(0.8, 0.2, -1.0))
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


def fly(skeleton: Skeleton) -> Clip:
    """Return flight: lying on the air behind one fist, banking a little."""
    duration = 72 / 60
    fist = Arm(
        to=(0.10, 1.0, 0.16), bend=8.0, elbow=(1.0, 0.0, 0.3), twist=60.0, flex=0.0, curl=150.0
    )
    swept = Arm(to=(0.42, -1.0, -0.10), bend=14.0, elbow=(0.6, 0.0, -1.0), flex=-8.0, curl=15.0)
    straight = Leg(to=(0.06, -1.0, -0.02), bend=6.0, point=48.0)
    bent = Leg(to=(0.04, -1.0, 0.06), bend=38.0, point=52.0)
    keys = [
        Key(
            0.0,
            place=Place(left=0.02, up=0.105),
            hips=Turn(yaw=2.0, lean=85.0, tilt=7.0),
            chest=Turn(yaw=1.0, lean=74.0, tilt=4.0),
            head=Turn(lean=20.0, tilt=2.0),
            left_arm=swept,
            right_arm=fist,
            left_leg=straight,
            right_leg=bent,
        ),
        Key(
            0.25,
            place=Place(left=0.045, up=0.140),
            hips=Turn(lean=83.0),
            chest=Turn(lean=71.0),
            head=Turn(lean=17.0),
        ),
        Key(
            0.5,
            place=Place(left=0.02, up=0.115),
            hips=Turn(yaw=-2.0, lean=86.0, tilt=-7.0),
            chest=Turn(yaw=-1.0, lean=75.0, tilt=-5.0),
            head=Turn(lean=20.0, tilt=-2.0),
            left_arm=replace(swept, to=(0.55, -1.0, -0.02), bend=20.0),
            right_arm=replace(fist, to=(0.04, 1.0, 0.10), bend=5.0),
            left_leg=replace(straight, to=(0.06, -1.0, -0.10), bend=10.0),
            right_leg=replace(bent, to=(0.04, -1.0, 0.10), bend=50.0),
        ),
        Key(
            0.75,
            place=Place(left=-0.01, up=0.080),
            hips=Turn(lean=88.0),
            chest=Turn(lean=78.0),
            head=Turn(lean=23.0),
        ),
    ]
    return make_clip(
        skeleton,
        "fly",
        keys,
        steady_travel(duration, ahead=3.0),
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )


def jump(skeleton: Skeleton) -> Clip:
    """Return a standing long jump: crouch, swing, flight, landing."""
    duration, far = 1.90, 1.20
    crouched, off, landed = 32 / 60, 44 / 60, 73 / 60
    back = Arm(to=(0.35, -0.75, -1.0), bend=12.0, elbow=(0.6, 0.4, -1.0), curl=45.0)
    up = Arm(to=(0.28, 1.0, 0.70), bend=18.0, elbow=(0.8, -0.6, -0.2), curl=30.0)
    down = Arm(to=(0.34, -0.55, 1.0), bend=30.0, elbow=(0.9, -0.4, -0.4), curl=30.0)
    take_off = Place(up=-0.005, ahead=0.31)
    touch_down = Place(up=-0.130, ahead=far - 0.16)
    keys = [
        STAND,
        Key(  # preparation: tall, arms coming forward
            0.20,
            place=Place(left=0.004, up=-0.005, ahead=0.012),
            hips=Turn(lean=1.0),
            chest=Turn(lean=-2.0),
            head=Turn(lean=4.0),
            left_arm=Arm(to=(0.22, -1.0, 0.42), bend=24.0),
            right_arm=Arm(to=(0.22, -1.0, 0.46), bend=26.0),
        ),
        Key(  # anticipation: deep, arms behind
            crouched - 0.01,
            place=Place(up=-0.275, ahead=-0.065),
            hips=Turn(lean=42.0),
            chest=Turn(lean=52.0),
            head=Turn(lean=14.0),
            left_arm=back,
            right_arm=replace(back, to=(0.40, -0.80, -1.0), bend=16.0),
        ),
        Key(  # the arms swing through
            0.62,
            place=Place(up=-0.225, ahead=0.06),
            left_arm=Arm(to=(0.25, -1.0, 0.30), bend=20.0, elbow=(0.6, 0.0, -1.0)),
            right_arm=Arm(to=(0.25, -1.0, 0.30), bend=22.0, elbow=(0.6, 0.0, -1.0)),
        ),
        Key(  # toes off, the body one line
            off,
            place=take_off,
            hips=Turn(lean=26.0),
            chest=Turn(lean=22.0),
            head=Turn(lean=4.0),
        ),
        Key(0.80, left_arm=up, right_arm=replace(up, to=(0.25, 0.92, 0.8))),
        Key(  # knees up
            1.00,
            hips=Turn(lean=14.0),
            chest=Turn(lean=22.0),
            head=Turn(lean=10.0),
            left_arm=replace(up, to=(0.45, 0.80, 0.9)),
            right_arm=replace(up, to=(0.45, 0.65, 0.9)),
        ),
        Key(
            landed,
            place=touch_down,
            hips=Turn(lean=16.0),
            chest=Turn(lean=34.0),
            head=Turn(lean=16.0),
            left_arm=down,
            right_arm=replace(down, to=(0.38, -0.48, 1.0)),
        ),
        Key(  # absorbed
            1.42,
            place=Place(up=-0.32, ahead=far - 0.085),
            hips=Turn(lean=38.0),
            chest=Turn(lean=48.0),
            head=Turn(lean=18.0),
            left_arm=Arm(to=(0.45, -0.9, 0.62), bend=30.0),
            right_arm=Arm(to=(0.45, -0.9, 0.70), bend=34.0),
        ),
        Key(
            1.68,
            place=Place(left=0.005, up=-0.045, ahead=far + 0.01),
            hips=Turn(lean=7.0),
            chest=Turn(lean=7.0),
            head=Turn(lean=5.0),
            left_arm=Arm(to=(0.20, -1.0, 0.02), bend=16.0),
            right_arm=Arm(to=(0.20, -1.0, 0.04), bend=18.0),
        ),
        at(duration, carried(STAND, ahead=far)),
        *_ballistic(off, take_off, landed, touch_down),
    ]
    left, right = (
        [
            replace(stance, leave=off, leave_pitch=62.0, roll=0.19),
            replace(
                stance,
                land=landed + delay,
                ahead=stance.ahead + far,
                land_pitch=-16.0,
                flat=0.07,
                swing=(
                    Via(0.34, 0.46, along=0.34, pitch=50.0),
                    Via(0.70, 0.36, along=0.80, pitch=-4.0),
                ),
            ),
        ]
        for stance, delay in ((LEFT_STANCE, 0.0), (RIGHT_STANCE, 0.016))
    )
    return make_clip(
        skeleton,
        "jump",
        keys,
        moved_in_one_go(duration, crouched, landed, ahead=far),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.20, crouched, landed, 1.42, duration),
    )


def _ballistic(off_s: float, off: Place, landed_s: float, landed: Place) -> list[Key]:
    """Return keys of the hips, frame by frame, on the parabola that joins take-off and landing."""
    gravity_m_s2, flight_s = 9.81, landed_s - off_s
    count = round(flight_s * RATE_HZ)
    keys = []
    for i in range(1, count):
        part = i / count
        rise = 0.5 * gravity_m_s2 * part * (1.0 - part) * flight_s**2
        place = Place(
            up=off.up + part * (landed.up - off.up) + rise,
            ahead=off.ahead + part * (landed.ahead - off.ahead),
        )
        keys.append(Key(off_s + part * flight_s, place=place))
    return keys
