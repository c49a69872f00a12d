"""Jumps: off the ground and back to it."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import Via
from actions_library.authoring.keys import Arm, Key, Place, Turn, at, carried
from actions_library.authoring.posing import RATE_HZ, make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, moved_in_one_go
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


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
