"""Strikes: what goes out at something and comes back."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Via
from actions_library.authoring.keys import Arm, Key, Place, Turn, at
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, standing_still
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def punch(skeleton: Skeleton) -> Clip:
    """Return a right-hand straight: from the rear foot through hips and shoulder to the fist."""
    duration = 1.50
    fist = Arm(bend=120.0, elbow=(0.4, -1.0, -0.1), twist=25.0, flex=0.0, curl=150.0)
    straight = replace(
        fist, to=(-0.02, 0.05, 1.0), bend=7.0, elbow=(1.0, -0.6, 0.0), follow=0.0, twist=80.0
    )
    keys = [
        STAND,
        Key(
            0.14,
            left_arm=Arm(to=(0.22, -0.9, 0.50), bend=70.0, curl=80.0),
            right_arm=Arm(to=(0.22, -0.9, 0.45), bend=75.0, curl=80.0),
        ),
        Key(  # guard
            0.30,
            place=Place(left=0.015, up=-0.060, ahead=0.05),
            hips=Turn(yaw=-26.0, lean=6.0),
            chest=Turn(yaw=-24.0, lean=10.0),
            head=Turn(yaw=-4.0, lean=9.0),
            left_arm=replace(fist, to=(-0.05, 0.0, 1.0), bend=108.0),
            right_arm=replace(fist, to=(-0.25, -0.02, 0.8), bend=130.0),
        ),
        Key(  # anticipation: the weight goes back, and the fist
            0.54,
            place=Place(left=-0.020, up=-0.070, ahead=-0.010),
            hips=Turn(yaw=-44.0, lean=2.0, tilt=2.0),
            chest=Turn(yaw=-58.0, lean=3.0, tilt=5.0),
            head=Turn(yaw=-8.0, lean=7.0, tilt=3.0),
            left_arm=replace(fist, to=(0.10, 0.0, 1.0), bend=58.0, follow=0.0, twist=40.0),
            right_arm=replace(fist, to=(0.25, -0.50, 0.45), bend=132.0, elbow=(0.5, -0.2, -1.0)),
        ),
        Key(  # the fist arrives
            0.69,
            place=Place(left=0.050, up=-0.095, ahead=0.215),
            hips=Turn(yaw=22.0, lean=10.0),
            chest=Turn(yaw=52.0, lean=14.0, tilt=-4.0),
            head=Turn(yaw=6.0, lean=10.0, tilt=-4.0),
            left_arm=replace(fist, to=(0.05, -0.05, 0.8), bend=132.0, elbow=(0.5, -1.0, -0.5)),
            right_arm=straight,
        ),
        Key(  # and goes on a little
            0.82,
            place=Place(left=0.056, up=-0.100, ahead=0.235),
            hips=Turn(yaw=26.0, lean=11.0),
            chest=Turn(yaw=58.0, lean=15.0, tilt=-4.0),
            head=Turn(yaw=8.0, lean=10.0, tilt=-4.0),
            left_arm=replace(fist, to=(0.08, -0.05, 0.8), bend=134.0, elbow=(0.5, -1.0, -0.6)),
            right_arm=replace(straight, to=(0.03, 0.03, 1.0), bend=10.0),
        ),
        Key(
            1.06,
            place=Place(left=0.020, up=-0.060, ahead=0.08),
            hips=Turn(yaw=-14.0, lean=6.0),
            chest=Turn(yaw=-8.0, lean=8.0),
            head=Turn(yaw=-2.0, lean=8.0),
            left_arm=replace(fist, to=(-0.05, -0.35, 1.0), bend=98.0, curl=100.0),
            right_arm=replace(fist, to=(-0.10, -0.35, 0.9), bend=110.0, curl=100.0),
        ),
        at(duration, STAND),
    ]
    front = replace(LEFT_STANCE, left=0.125, ahead=0.32, yaw=2.0)
    left = [
        replace(LEFT_STANCE, leave=0.06, leave_pitch=18.0, roll=0.06),
        replace(
            front,
            land=0.30,
            leave=1.02,
            land_pitch=-8.0,
            flat=0.06,
            leave_pitch=12.0,
            roll=0.10,
            swing=(Via(0.5, 0.055),),
        ),
        replace(LEFT_STANCE, land=1.28, land_pitch=10.0, flat=0.08, swing=(Via(0.5, 0.05),)),
    ]
    rear = replace(RIGHT_STANCE, left=-0.125, ahead=-0.11, yaw=-32.0)
    right = [
        replace(RIGHT_STANCE, leave=0.17, leave_pitch=14.0, roll=0.08),
        replace(
            rear,
            land=0.38,
            leave=1.14,
            land_pitch=10.0,
            flat=0.06,
            leave_pitch=14.0,
            roll=0.09,
            on_ball=(
                OnBall(0.52, 0.0),
                OnBall(0.70, 44.0, turn=24.0),
                OnBall(0.82, 48.0, turn=26.0),
                OnBall(1.04, 0.0),
            ),
            swing=(Via(0.5, 0.040),),
        ),
        replace(RIGHT_STANCE, land=1.36, land_pitch=10.0, flat=0.08, swing=(Via(0.5, 0.040),)),
    ]
    return make_clip(
        skeleton,
        "punch",
        keys,
        standing_still(duration),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.30, 0.54, 0.69, 0.82, duration),
    )
