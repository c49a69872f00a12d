"""Jumps: off the ground and back to it."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import Plant, Via, repeated
from actions_library.authoring.hand_poses import FLAT, LOOSE, RELAXED
from actions_library.authoring.keys import ArmKey, Key, LegKey, Place, Turn, at, carried
from actions_library.authoring.posing import RATE_HZ, make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    moved_in_one_go,
    standing_still,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def jump(skeleton: Skeleton) -> Clip:
    """Return a standing long jump: crouch, swing, flight, landing."""
    duration, far = 2.10, 1.20
    crouched, off, landed, absorbed = 34 / 60, 51 / 60, 77 / 60, 94 / 60
    back = ArmKey(to=(0.35, -0.75, -1.0), bend=12.0, elbow=(0.6, 0.4, -1.0), fingers=LOOSE)
    up = ArmKey(to=(0.28, 1.0, 0.70), bend=18.0, elbow=(0.8, -0.6, -0.2), fingers=RELAXED)
    down = ArmKey(to=(0.34, -0.55, 1.0), bend=30.0, elbow=(0.9, -0.4, -0.4), fingers=RELAXED)
    take_off = Place(up=-0.005, ahead=0.31)
    touch_down = Place(up=-0.165, ahead=far - 0.15)
    keys = [
        STAND,
        Key(  # preparation: tall, arms coming forward
            0.20,
            place=Place(left=0.004, up=-0.005, ahead=0.012),
            hips=Turn(lean=1.0),
            chest=Turn(lean=-2.0),
            head=Turn(lean=4.0),
            left_arm=ArmKey(to=(0.22, -1.0, 0.42), bend=24.0),
            right_arm=ArmKey(to=(0.22, -1.0, 0.46), bend=26.0),
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
            0.70,
            place=Place(up=-0.235, ahead=0.09),
            left_arm=ArmKey(to=(0.25, -1.0, 0.30), bend=20.0, elbow=(0.6, 0.0, -1.0)),
            right_arm=ArmKey(to=(0.25, -1.0, 0.30), bend=22.0, elbow=(0.6, 0.0, -1.0)),
        ),
        Key(  # toes off, the body one line
            off,
            place=take_off,
            hips=Turn(lean=26.0),
            chest=Turn(lean=22.0),
            head=Turn(lean=4.0),
        ),
        Key(off + 0.06, left_arm=up, right_arm=replace(up, to=(0.25, 0.92, 0.8))),
        Key(  # knees up
            1.08,
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
            absorbed,
            place=Place(up=-0.365, ahead=far - 0.060),
            hips=Turn(lean=42.0),
            chest=Turn(lean=54.0),
            head=Turn(lean=18.0),
            left_arm=ArmKey(to=(0.45, -0.9, 0.62), bend=30.0),
            right_arm=ArmKey(to=(0.45, -0.9, 0.70), bend=34.0),
        ),
        Key(
            1.88,
            place=Place(left=0.005, up=-0.045, ahead=far + 0.01),
            hips=Turn(lean=7.0),
            chest=Turn(lean=7.0),
            head=Turn(lean=5.0),
            left_arm=ArmKey(to=(0.20, -1.0, 0.02), bend=16.0),
            right_arm=ArmKey(to=(0.20, -1.0, 0.04), bend=18.0),
        ),
        at(duration, carried(STAND, ahead=far)),
        *ballistic(off, take_off, landed, touch_down),
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
        stage_ends_s=(0.20, crouched, landed, absorbed, duration),
    )


def hop(skeleton: Skeleton) -> Clip:
    """Hop on the left leg, again and again, the right one drawn up."""
    duration, off, landed = 36 / 60, 10 / 60, 29 / 60
    take_off, touch_down = Place(left=0.085, up=-0.004), Place(left=0.085, up=-0.030)
    wide = ArmKey(to=(0.85, -0.62, 0.30), bend=42.0, elbow=(0.5, -0.6, -0.8), fingers=RELAXED)
    flung = ArmKey(to=(0.95, -0.12, 0.26), bend=36.0, elbow=(0.4, -0.8, -0.6), fingers=RELAXED)
    drawn = LegKey(to=(0.10, -0.86, -0.26), bend=92.0, knee=(0.2, -0.2, 1.0), point=28.0)
    keys = [
        Key(
            0.0,
            place=Place(left=0.085, up=-0.100, ahead=-0.004),
            hips=Turn(yaw=-3.0, lean=9.0, tilt=4.0),
            chest=Turn(yaw=2.0, lean=14.0, tilt=-2.0),
            head=Turn(lean=8.0, tilt=0.0),
            left_arm=wide,
            right_arm=wide,
            right_leg=drawn,
        ),
        Key(
            off / duration,
            place=take_off,
            hips=Turn(yaw=-1.0, lean=4.0, tilt=4.0),
            chest=Turn(yaw=1.0, lean=4.0, tilt=-4.0),
            head=Turn(lean=3.0, tilt=0.0),
            left_arm=flung,
            right_arm=flung,
        ),
        Key(0.53, right_leg=replace(drawn, to=(0.12, -0.80, -0.14), bend=100.0)),
        Key(
            landed / duration,
            place=touch_down,
            hips=Turn(yaw=-2.0, lean=6.0, tilt=4.0),
            chest=Turn(yaw=1.0, lean=8.0, tilt=-3.0),
            head=Turn(lean=6.0, tilt=0.0),
        ),
        *(at(key.at / duration, key) for key in ballistic(off, take_off, landed, touch_down)),
    ]
    stand = Plant(
        land=landed - duration,
        leave=off,
        left=0.085,
        ahead=0.0,
        yaw=6.0,
        land_pitch=24.0,
        flat=0.07,
        leave_pitch=46.0,
        roll=0.10,
        swing=(Via(0.5, 0.235, pitch=38.0),),
    )
    return make_clip(
        skeleton,
        "hop",
        keys,
        standing_still(duration),
        left_foot=repeated([stand], duration, left=0.0, ahead=0.0),
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )


def leap(skeleton: Skeleton) -> Clip:
    """Leap as a dancer does: off the left foot, split in the air, down on the right, a step."""
    duration, far = 2.60, 2.30
    stepped, off, landed, absorbed, caught = 0.44, 52 / 60, 80 / 60, 1.66, 1.90
    take_off = Place(left=0.015, up=-0.020, ahead=0.80)
    touch_down = Place(left=-0.020, up=-0.135, ahead=far - 0.38)
    ahead_leg = LegKey(to=(0.05, -0.42, 1.0), bend=14.0, point=52.0)
    behind_leg = LegKey(to=(0.06, -0.50, -0.95), bend=22.0, knee=(0.25, -0.4, 0.6), point=58.0)
    keys = [
        STAND,
        Key(
            0.24,
            place=Place(left=-0.050, up=-0.040, ahead=0.05),
            hips=Turn(yaw=4.0, lean=3.0),
            chest=Turn(yaw=-3.0, lean=2.0),
            head=Turn(lean=4.0),
            left_arm=ArmKey(to=(0.30, -1.0, -0.20), bend=20.0),
            right_arm=ArmKey(to=(0.30, -1.0, 0.20), bend=24.0),
        ),
        Key(  # deep on the left leg
            0.60,
            place=Place(left=0.030, up=-0.175, ahead=0.42),
            hips=Turn(yaw=-6.0, lean=16.0, tilt=1.0),
            chest=Turn(yaw=8.0, lean=18.0, tilt=0.0),
            head=Turn(lean=6.0),
            left_arm=ArmKey(to=(0.50, -0.75, -0.60), bend=18.0),
            right_arm=ArmKey(to=(0.60, -0.80, -0.40), bend=18.0),
            left_leg=behind_leg,
            right_leg=replace(ahead_leg, to=(0.02, -0.85, -0.36), bend=118.0, point=4.0),
        ),
        Key(
            off,
            place=take_off,
            hips=Turn(yaw=-12.0, lean=8.0),
            chest=Turn(yaw=4.0, lean=5.0),
            head=Turn(lean=0.0),
            left_leg=behind_leg,
            right_leg=replace(ahead_leg, to=(0.02, -0.60, 0.9), bend=76.0, point=4.0),
        ),
        Key(  # split
            1.08,
            hips=Turn(yaw=-16.0, lean=4.0),
            chest=Turn(yaw=6.0, lean=4.0),
            head=Turn(lean=-3.0),
            left_arm=ArmKey(
                to=(0.50, 0.55, 0.85), bend=12.0, elbow=(0.7, -0.7, -0.2), fingers=FLAT
            ),
            right_arm=ArmKey(
                to=(1.0, 0.32, -0.10), bend=12.0, elbow=(0.1, -0.9, -0.6), fingers=FLAT
            ),
            left_leg=behind_leg,
            right_leg=ahead_leg,
        ),
        Key(
            landed,
            place=touch_down,
            hips=Turn(yaw=-10.0, lean=10.0, tilt=-2.0),
            chest=Turn(yaw=4.0, lean=14.0, tilt=1.0),
            head=Turn(lean=6.0),
            left_arm=ArmKey(to=(0.70, -0.10, 0.70), bend=22.0, fingers=RELAXED),
            right_arm=ArmKey(to=(0.95, -0.10, 0.05), bend=22.0, fingers=RELAXED),
            left_leg=replace(behind_leg, to=(0.05, -0.8, -0.55), bend=46.0),
            right_leg=replace(ahead_leg, to=(0.02, -0.9, 0.42), bend=24.0, point=30.0),
        ),
        Key(1.52, left_leg=replace(behind_leg, to=(0.04, -0.80, -0.45), bend=117.0, point=20.0)),
        Key(  # absorbed, over the right leg
            absorbed,
            place=Place(left=-0.050, up=-0.285, ahead=far - 0.14),
            hips=Turn(yaw=-4.0, lean=20.0, tilt=-4.0),
            chest=Turn(yaw=2.0, lean=24.0, tilt=3.0),
            head=Turn(lean=12.0),
            left_arm=ArmKey(to=(0.60, -0.80, 0.30), bend=26.0),
            right_arm=ArmKey(to=(0.60, -0.75, 0.30), bend=26.0),
            left_leg=replace(behind_leg, to=(0.04, -0.86, 0.26), bend=128.0, point=0.0),
        ),
        Key(1.80, left_leg=replace(behind_leg, to=(0.04, -0.84, 0.44), bend=104.0, point=0.0)),
        Key(  # the left foot catches what is left of the way
            caught,
            place=Place(left=0.000, up=-0.120, ahead=far - 0.04),
            hips=Turn(yaw=-1.0, lean=12.0, tilt=0.0),
            chest=Turn(yaw=1.5, lean=13.0, tilt=0.0),
            head=Turn(lean=8.0),
            left_leg=replace(behind_leg, to=(0.04, -0.90, 0.34), bend=66.0, point=0.0),
        ),
        Key(
            2.20,
            place=Place(left=0.045, up=-0.034, ahead=far),
            hips=Turn(yaw=-1.0, lean=5.0, tilt=1.0),
            chest=Turn(yaw=1.5, lean=4.0),
            head=Turn(lean=5.0),
            left_arm=ArmKey(to=(0.24, -1.0, 0.04), bend=17.0),
            right_arm=ArmKey(to=(0.24, -1.0, 0.08), bend=20.0),
        ),
        at(duration, carried(STAND, ahead=far)),
        *ballistic(off, take_off, landed, touch_down),
    ]
    left = [
        replace(LEFT_STANCE, leave=0.24, leave_pitch=24.0, roll=0.12),
        replace(
            LEFT_STANCE,
            land=stepped,
            leave=off,
            left=0.06,
            ahead=0.52,
            yaw=2.0,
            land_pitch=-14.0,
            flat=0.08,
            leave_pitch=62.0,
            roll=0.20,
            swing=(Via(0.45, 0.10, pitch=16.0),),
        ),
        replace(
            LEFT_STANCE,
            land=caught,
            ahead=LEFT_STANCE.ahead + far,
            land_pitch=10.0,
            flat=0.09,
            swing=None,
        ),
    ]
    right = [
        replace(RIGHT_STANCE, leave=0.62, leave_pitch=50.0, roll=0.24),
        replace(
            RIGHT_STANCE,
            land=landed,
            leave=2.00,
            left=-0.075,
            ahead=far - 0.18,
            yaw=-6.0,
            land_pitch=42.0,
            flat=0.12,
            leave_pitch=30.0,
            roll=0.16,
            swing=None,
        ),
        replace(
            RIGHT_STANCE,
            land=2.28,
            ahead=RIGHT_STANCE.ahead + far,
            land_pitch=8.0,
            flat=0.08,
            swing=(Via(0.5, 0.06),),
        ),
    ]
    return make_clip(
        skeleton,
        "leap",
        keys,
        moved_in_one_go(duration, stepped, landed, ahead=far),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.24, 0.60, landed, absorbed, duration),
    )


def ballistic(off_s: float, off: Place, landed_s: float, landed: Place) -> list[Key]:
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
