"""Handling things: throwing them, picking them up."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Via
from actions_library.authoring.hand_poses import HOLD, LOOSE, POINT, RELAXED
from actions_library.authoring.keys import ArmKey, Hand, Key, Place, Turn, at
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, standing_still
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def throw(skeleton: Skeleton) -> Clip:
    """Return an overhand throw: wind up over the rear leg, step, whip, and let the arm run out."""
    duration = 2.25
    keys = [
        STAND,
        Key(0.13, place=Place(left=0.035, up=-0.014)),
        Key(
            0.28,
            place=Place(left=-0.02, up=-0.030, ahead=-0.01),
            hips=Turn(yaw=-20.0, lean=3.0, tilt=0.0),
            chest=Turn(yaw=-18.0, lean=4.0),
            head=Turn(yaw=-2.0, lean=6.0),
            left_arm=ArmKey(to=(0.0, -0.9, 0.7), bend=60.0),
            right_arm=ArmKey(to=(0.02, -0.9, 0.55), bend=75.0, fingers=HOLD),
        ),
        Key(  # wound up: the side to the target, the weight on the rear leg
            0.66,
            place=Place(left=-0.095, up=-0.055, ahead=-0.075),
            hips=Turn(yaw=-62.0, lean=0.0, tilt=4.0),
            chest=Turn(yaw=-82.0, lean=-8.0, tilt=8.0),
            head=Turn(yaw=-12.0, lean=4.0, tilt=4.0),
            left_arm=ArmKey(
                to=(0.10, 0.30, 1.0),
                bend=26.0,
                elbow=(0.6, -1.0, 0.0),
                follow=0.0,
                twist=40.0,
                fingers=POINT,
            ),
            right_arm=ArmKey(
                to=(1.0, -0.35, -0.35), bend=42.0, elbow=(0.2, -0.4, -1.0), twist=20.0, fingers=HOLD
            ),
        ),
        Key(  # the front foot lands, the hips open, the hand stays behind
            0.90,
            place=Place(left=-0.02, up=-0.090, ahead=0.09),
            hips=Turn(yaw=-22.0, lean=2.0, tilt=2.0),
            chest=Turn(yaw=-48.0, lean=-10.0, tilt=6.0),
            head=Turn(yaw=-4.0, lean=4.0, tilt=2.0),
            left_arm=ArmKey(
                to=(0.45, 0.10, 1.0),
                bend=30.0,
                elbow=(0.6, -1.0, 0.0),
                follow=0.0,
                twist=40.0,
                fingers=RELAXED,
            ),
            right_arm=ArmKey(
                to=(0.75, 0.62, -0.55),
                bend=98.0,
                elbow=(1.0, -0.35, 0.1),
                twist=0.0,
                flex=-30.0,
                fingers=HOLD,
            ),
        ),
        Key(  # the elbow leads
            0.955,
            right_arm=ArmKey(
                to=(0.52, 0.84, 0.36),
                bend=92.0,
                elbow=(1.0, -0.3, 0.2),
                twist=15.0,
                flex=-20.0,
                fingers=HOLD,
            ),
        ),
        Key(  # the hand is released a little after its key
            1.01,
            right_arm=ArmKey(
                to=(0.35, 0.80, 0.75),
                bend=22.0,
                elbow=(1.0, -0.2, 0.2),
                twist=30.0,
                flex=10.0,
                fingers=RELAXED,
            ),
        ),
        Key(  # release: high, ahead of the head
            1.03,
            place=Place(left=0.045, up=-0.085, ahead=0.22),
            hips=Turn(yaw=14.0, lean=10.0, tilt=-2.0),
            chest=Turn(yaw=24.0, lean=16.0, tilt=-10.0),
            head=Turn(yaw=0.0, lean=8.0, tilt=-4.0),
            left_arm=ArmKey(
                to=(0.55, -0.35, 0.35), bend=85.0, elbow=(0.8, -0.3, -1.0), fingers=LOOSE
            ),
        ),
        Key(  # the arm runs out across the body
            1.24,
            place=Place(left=0.060, up=-0.125, ahead=0.27),
            hips=Turn(yaw=34.0, lean=22.0, tilt=-2.0),
            chest=Turn(yaw=58.0, lean=38.0, tilt=-6.0),
            head=Turn(yaw=8.0, lean=12.0, tilt=-4.0),
            left_arm=ArmKey(
                to=(0.50, -0.70, -0.45), bend=72.0, elbow=(0.5, 0.2, -1.0), fingers=LOOSE
            ),
            right_arm=ArmKey(
                to=(-0.45, -0.80, 0.75),
                bend=18.0,
                elbow=(1.0, 0.1, -0.2),
                twist=55.0,
                flex=22.0,
                fingers=RELAXED,
            ),
        ),
        Key(
            1.48,
            place=Place(left=0.010, up=-0.080, ahead=0.15),
            hips=Turn(yaw=18.0, lean=12.0),
            chest=Turn(yaw=26.0, lean=18.0),
            head=Turn(yaw=3.0, lean=9.0),
            right_arm=ArmKey(to=(-0.05, -0.80, 0.80), bend=34.0, twist=35.0),
        ),
        Key(  # the weight is back on the rear leg
            1.72,
            place=Place(left=-0.088, up=-0.050, ahead=-0.005),
            hips=Turn(yaw=4.0, lean=4.0, tilt=-2.0),
            chest=Turn(yaw=4.0, lean=5.0, tilt=1.0),
            head=Turn(yaw=0.0, lean=5.0),
            left_arm=ArmKey(to=(0.26, -1.0, 0.10), bend=32.0),
            right_arm=ArmKey(to=(0.06, -1.0, 0.28), bend=26.0),
        ),
        at(duration, STAND),
    ]
    left = [
        replace(LEFT_STANCE, leave=0.46, leave_pitch=26.0, roll=0.14),
        replace(
            LEFT_STANCE,
            land=0.88,
            leave=1.62,
            left=0.095,
            ahead=0.34,
            yaw=2.0,
            land_pitch=-12.0,
            flat=0.07,
            leave_pitch=14.0,
            roll=0.12,
            swing=(Via(0.45, 0.17, along=0.40, pitch=14.0),),
        ),
        replace(LEFT_STANCE, land=1.98, land_pitch=8.0, flat=0.08, swing=(Via(0.5, 0.06),)),
    ]
    turned = replace(RIGHT_STANCE, yaw=-58.0, left=-0.10, ahead=-0.06)
    right = [
        replace(RIGHT_STANCE, leave=0.14, leave_pitch=14.0, roll=0.10),
        replace(
            turned,
            land=0.36,
            leave=1.10,
            land_pitch=8.0,
            flat=0.06,
            leave_pitch=58.0,
            roll=0.26,
            on_ball=(OnBall(0.84, 0.0), OnBall(1.10, 4.0, turn=44.0)),
            swing=(Via(0.5, 0.03),),
        ),
        replace(
            RIGHT_STANCE,
            land=1.40,
            land_pitch=18.0,
            flat=0.10,
            swing=(Via(0.30, 0.16, along=0.25, pitch=52.0, toes=30.0), Via(0.65, 0.10, pitch=24.0)),
        ),
    ]
    return make_clip(
        skeleton,
        "throw",
        keys,
        standing_still(duration),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.28, 0.66, 1.03, 1.24, duration),
    )


def pick_up(skeleton: Skeleton) -> Clip:
    """Bend the knees, take something from the ground with the right hand, and lift it."""
    duration = 2.90
    arm = ArmKey(to=(0.02, -0.9, 0.7), bend=30.0, elbow=(0.9, 0.1, -1.0), fingers=RELAXED)
    held = replace(arm, to=(0.05, -0.62, 0.75), bend=84.0, fingers=HOLD)
    on_knee = ArmKey(to=(0.20, -0.80, 0.75), bend=44.0, elbow=(1.0, 0.0, -0.8), fingers=RELAXED)
    grasp = Hand((0.06, 0.190, 0.29), fingers=(-0.05, -0.9, 0.5), palm=(-0.6, -0.35, -0.6))
    keys = [
        STAND,
        Key(  # looks down at it
            0.34,
            place=Place(left=0.012, up=-0.020, ahead=0.005),
            hips=Turn(lean=4.0),
            chest=Turn(lean=6.0),
            head=Turn(yaw=-3.0, lean=32.0),
            right_hand=replace(grasp, place=(0.12, 0.75, 0.32), hold=0.0),
        ),
        Key(0.58, right_hand=replace(grasp, place=(0.12, 0.60, 0.34), hold=0.1)),
        Key(
            0.80,
            place=Place(left=0.0, up=-0.300, ahead=-0.055),
            hips=Turn(yaw=4.0, lean=38.0),
            chest=Turn(yaw=10.0, lean=52.0, tilt=3.0),
            head=Turn(yaw=-2.0, lean=60.0),
            left_arm=on_knee,
            right_arm=arm,
            right_hand=replace(grasp, place=(0.08, 0.40, 0.38), hold=0.9),
        ),
        Key(  # there
            1.12,
            place=Place(left=0.0, up=-0.460, ahead=-0.055),
            hips=Turn(yaw=6.0, lean=48.0),
            chest=Turn(yaw=14.0, lean=76.0, tilt=4.0),
            head=Turn(yaw=-2.0, lean=66.0),
            left_arm=on_knee,
            right_arm=arm,
            right_hand=grasp,
        ),
        Key(  # the fingers close
            1.36,
            place=Place(left=0.0, up=-0.462, ahead=-0.055),
            hips=Turn(yaw=6.0, lean=48.0),
            chest=Turn(yaw=14.0, lean=76.0, tilt=4.0),
            head=Turn(yaw=-2.0, lean=66.0),
            right_arm=replace(arm, fingers=HOLD),
            right_hand=grasp,
        ),
        Key(1.62, right_hand=replace(grasp, place=(0.08, 0.44, 0.37), hold=0.9)),
        Key(  # lifted
            2.02,
            place=Place(left=0.006, up=-0.045, ahead=-0.005),
            hips=Turn(yaw=-1.0, lean=8.0),
            chest=Turn(yaw=2.0, lean=9.0),
            head=Turn(yaw=-3.0, lean=24.0),
            left_arm=ArmKey(to=(0.20, -1.0, 0.12), bend=22.0),
            right_arm=held,
            right_hand=replace(grasp, place=(0.14, 1.02, 0.34), hold=0.0),
        ),
        Key(
            2.36,
            place=Place(left=0.010, up=-0.012, ahead=0.0),
            hips=Turn(yaw=-2.0, lean=2.0),
            chest=Turn(yaw=1.0, lean=1.0),
            head=Turn(yaw=-2.0, lean=14.0),
            left_arm=ArmKey(to=(0.18, -1.0, 0.06), bend=16.0),
            right_arm=replace(held, to=(0.08, -0.70, 0.68), bend=80.0),
        ),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "pick_up",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.34, 1.12, 1.36, duration),
    )
