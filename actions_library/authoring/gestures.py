"""Clips that stay in place: turns, punch, throw, bow and idle."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Plant, Via, other_foot
from actions_library.authoring.keys import Arm, Key, Place, Turn, at, carried, mirrored
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    moved_in_one_go,
    standing_still,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def idle(skeleton: Skeleton) -> Clip:
    """Return standing: two breaths while the weight goes from one leg to the other and back."""
    duration = 6.0
    keys = [
        STAND,
        Key(
            0.25,
            place=Place(left=0.032, up=-0.012, ahead=0.004),
            hips=Turn(yaw=-4.0, lean=2.0, tilt=3.6),
            chest=Turn(yaw=2.0, lean=-1.6, tilt=-2.6),
            head=Turn(yaw=8.0, lean=1.5, tilt=-1.5),
            left_arm=Arm(to=(0.18, -1.0, 0.06), bend=16.0, shrug=2.5),
            right_arm=Arm(to=(0.18, -1.0, 0.09), bend=23.0, shrug=2.5),
        ),
        Key(
            0.5,
            place=Place(left=-0.008, up=-0.010, ahead=-0.003),
            hips=Turn(yaw=-0.5, lean=2.5, tilt=-0.8),
            chest=Turn(yaw=0.5, lean=1.4, tilt=0.8),
            head=Turn(yaw=1.0, lean=4.0, tilt=0.5),
            left_arm=Arm(to=(0.175, -1.0, 0.07), bend=18.0),
            right_arm=Arm(to=(0.165, -1.0, 0.06), bend=18.0),
        ),
        Key(
            0.75,
            place=Place(left=-0.028, up=-0.012, ahead=0.003),
            hips=Turn(yaw=1.0, lean=2.0, tilt=-3.2),
            chest=Turn(yaw=-1.5, lean=-1.4, tilt=2.4),
            head=Turn(yaw=-9.0, lean=1.5, tilt=1.5),
            left_arm=Arm(to=(0.18, -1.0, 0.06), bend=18.0, shrug=2.5),
            right_arm=Arm(to=(0.18, -1.0, 0.07), bend=20.0, shrug=2.5),
        ),
    ]
    return make_clip(
        skeleton,
        "idle",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )


def turn_left(skeleton: Skeleton) -> Clip:
    """Return a quarter turn: eyes, chest and hips in turn, then one foot after the other."""
    return _quarter_turn(skeleton, "turn_left", 1.0)


def turn_right(skeleton: Skeleton) -> Clip:
    """Return the quarter turn to the right."""
    return _quarter_turn(skeleton, "turn_right", -1.0)


def _quarter_turn(skeleton: Skeleton, name: str, to: float) -> Clip:
    """Make the turn to the left; the one to the right is posed as its mirror image."""
    duration = 1.5
    hanging_out = Arm(to=(0.34, -1.0, 0.10), bend=24.0)
    hanging_in = Arm(to=(0.21, -1.0, 0.22), bend=26.0)
    stand = STAND if to > 0 else mirrored(STAND)
    keys = [
        stand,
        Key(  # eyes first, weight onto the right leg
            0.28,
            place=Place(left=-0.105, up=-0.024, ahead=-0.016),
            hips=Turn(yaw=-3.0, lean=3.0, tilt=-3.0),
            chest=Turn(yaw=8.0, lean=2.0, tilt=1.0),
            head=Turn(yaw=38.0, lean=6.0, tilt=-2.0),
            left_arm=Arm(to=(0.22, -1.0, 0.04), bend=20.0),
            right_arm=Arm(to=(0.20, -1.0, 0.12), bend=24.0),
        ),
        Key(
            0.55,
            place=Place(left=-0.075, up=-0.036, ahead=-0.030),
            hips=Turn(yaw=38.0, lean=4.0, tilt=-2.0),
            chest=Turn(yaw=52.0, lean=4.0, tilt=-1.0),
            head=Turn(yaw=78.0, lean=6.0, tilt=-1.0),
            left_arm=hanging_out,
            right_arm=hanging_in,
        ),
        Key(  # weight onto the left leg, which stands the new way
            0.80,
            place=Place(left=0.000, up=-0.032, ahead=-0.108),
            hips=Turn(yaw=66.0, lean=4.0, tilt=3.0),
            chest=Turn(yaw=78.0, lean=4.0, tilt=0.0),
            head=Turn(yaw=90.0, lean=4.0, tilt=0.0),
        ),
        Key(
            1.06,
            place=Place(left=0.008, up=-0.022, ahead=-0.098),
            hips=Turn(yaw=90.0, lean=3.0, tilt=2.5),
            chest=Turn(yaw=93.0, lean=2.0, tilt=-1.0),
            head=Turn(yaw=91.0, lean=3.0, tilt=0.0),
            left_arm=Arm(to=(0.26, -1.0, -0.08), bend=15.0),
            right_arm=Arm(to=(0.26, -1.0, 0.16), bend=26.0),
        ),
        at(duration, carried(stand, yaw=90.0)),
    ]
    inner, outer = (
        (LEFT_STANCE, RIGHT_STANCE)
        if to > 0
        else (other_foot(RIGHT_STANCE), other_foot(LEFT_STANCE))
    )
    inside = [
        replace(inner, leave=0.34, leave_pitch=22.0, roll=0.12),
        replace(
            _around(inner),
            land=0.66,
            land_pitch=10.0,
            flat=0.08,
            swing=(Via(0.5, 0.075, pitch=8.0, out=0.02),),
        ),
    ]
    outside = [
        replace(
            outer,
            leave=0.80,
            leave_pitch=34.0,
            roll=0.20,
            on_ball=(OnBall(0.60, 0.0), OnBall(0.80, 2.0, turn=24.0)),
        ),
        replace(
            _around(outer),
            land=1.14,
            land_pitch=8.0,
            flat=0.08,
            swing=(Via(0.5, 0.075, pitch=10.0, out=0.03),),
        ),
    ]
    if to < 0:
        keys = [mirrored(key) for key in keys]
        inside, outside = (
            [other_foot(plant) for plant in inside],
            [other_foot(plant) for plant in outside],
        )
    left, right = (inside, outside) if to > 0 else (outside, inside)
    return make_clip(
        skeleton,
        name,
        keys,
        moved_in_one_go(duration, 0.28, 1.06, yaw=90.0 * to),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.0, 0.28, 1.06, 1.22, duration),
    )


def _around(plant: Plant) -> Plant:
    """Return the stance after a quarter turn to the left."""
    return replace(plant, left=plant.ahead, ahead=-plant.left, yaw=plant.yaw + 90.0)


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
            left_arm=Arm(to=(0.0, -0.9, 0.7), bend=60.0),
            right_arm=Arm(to=(0.02, -0.9, 0.55), bend=75.0, curl=80.0),
        ),
        Key(  # wound up: the side to the target, the weight on the rear leg
            0.66,
            place=Place(left=-0.095, up=-0.055, ahead=-0.075),
            hips=Turn(yaw=-62.0, lean=0.0, tilt=4.0),
            chest=Turn(yaw=-82.0, lean=-8.0, tilt=8.0),
            head=Turn(yaw=-12.0, lean=4.0, tilt=4.0),
            left_arm=Arm(
                to=(0.10, 0.30, 1.0),
                bend=26.0,
                elbow=(0.6, -1.0, 0.0),
                follow=0.0,
                twist=40.0,
                curl=20.0,
            ),
            right_arm=Arm(
                to=(1.0, -0.35, -0.35), bend=42.0, elbow=(0.2, -0.4, -1.0), twist=20.0, curl=80.0
            ),
        ),
        Key(  # the front foot lands, the hips open, the hand stays behind
            0.90,
            place=Place(left=-0.02, up=-0.090, ahead=0.09),
            hips=Turn(yaw=-22.0, lean=2.0, tilt=2.0),
            chest=Turn(yaw=-48.0, lean=-10.0, tilt=6.0),
            head=Turn(yaw=-4.0, lean=4.0, tilt=2.0),
            left_arm=Arm(
                to=(0.45, 0.10, 1.0),
                bend=30.0,
                elbow=(0.6, -1.0, 0.0),
                follow=0.0,
                twist=40.0,
                curl=20.0,
            ),
            right_arm=Arm(
                to=(0.75, 0.62, -0.55),
                bend=98.0,
                elbow=(1.0, -0.35, 0.1),
                twist=0.0,
                flex=-30.0,
                curl=80.0,
            ),
        ),
        Key(  # release: high, ahead of the head
            1.03,
            place=Place(left=0.045, up=-0.085, ahead=0.22),
            hips=Turn(yaw=14.0, lean=10.0, tilt=-2.0),
            chest=Turn(yaw=24.0, lean=16.0, tilt=-10.0),
            head=Turn(yaw=0.0, lean=8.0, tilt=-4.0),
            left_arm=Arm(to=(0.55, -0.35, 0.35), bend=85.0, elbow=(0.8, -0.3, -1.0), curl=45.0),
            right_arm=Arm(
                to=(0.35, 0.80, 0.75),
                bend=22.0,
                elbow=(1.0, -0.2, 0.2),
                twist=30.0,
                flex=10.0,
                curl=25.0,
            ),
        ),
        Key(  # the arm runs out across the body
            1.24,
            place=Place(left=0.060, up=-0.125, ahead=0.27),
            hips=Turn(yaw=34.0, lean=22.0, tilt=-2.0),
            chest=Turn(yaw=58.0, lean=38.0, tilt=-6.0),
            head=Turn(yaw=8.0, lean=12.0, tilt=-4.0),
            left_arm=Arm(to=(0.50, -0.70, -0.45), bend=72.0, elbow=(0.5, 0.2, -1.0), curl=45.0),
            right_arm=Arm(
                to=(-0.45, -0.80, 0.75),
                bend=18.0,
                elbow=(1.0, 0.1, -0.2),
                twist=55.0,
                flex=22.0,
                curl=25.0,
            ),
        ),
        Key(
            1.48,
            place=Place(left=0.010, up=-0.080, ahead=0.15),
            hips=Turn(yaw=18.0, lean=12.0),
            chest=Turn(yaw=26.0, lean=18.0),
            head=Turn(yaw=3.0, lean=9.0),
            right_arm=Arm(to=(-0.05, -0.80, 0.80), bend=34.0, twist=35.0),
        ),
        Key(  # the weight is back on the rear leg
            1.72,
            place=Place(left=-0.088, up=-0.050, ahead=-0.005),
            hips=Turn(yaw=4.0, lean=4.0, tilt=-2.0),
            chest=Turn(yaw=4.0, lean=5.0, tilt=1.0),
            head=Turn(yaw=0.0, lean=5.0),
            left_arm=Arm(to=(0.26, -1.0, 0.10), bend=32.0),
            right_arm=Arm(to=(0.06, -1.0, 0.28), bend=26.0),
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


def bow(skeleton: Skeleton) -> Clip:
    """Return a formal bow: from the hips, the back straight, the arms along the body."""
    duration = 2.60
    straight = Arm(to=(0.15, -1.0, 0.03), bend=10.0, twist=15.0, flex=2.0, curl=12.0)
    held = replace(straight, to=(0.10, -1.0, 0.16), bend=8.0)
    keys = [
        STAND,
        Key(  # stands up straight
            0.40,
            place=Place(left=0.0, up=-0.006, ahead=0.005),
            hips=Turn(lean=-1.0),
            chest=Turn(lean=-3.0),
            head=Turn(lean=-1.0),
            left_arm=straight,
            right_arm=straight,
        ),
        Key(
            1.10,
            place=Place(left=0.0, up=-0.040, ahead=-0.100),
            hips=Turn(lean=44.0),
            chest=Turn(lean=52.0),
            head=Turn(lean=58.0),
            left_arm=held,
            right_arm=held,
        ),
        Key(
            1.48,
            place=Place(left=0.0, up=-0.041, ahead=-0.103),
            hips=Turn(lean=45.5),
            chest=Turn(lean=54.0),
            head=Turn(lean=61.0),
            left_arm=held,
            right_arm=held,
        ),
        Key(
            2.15,
            place=Place(left=0.0, up=-0.008, ahead=0.004),
            hips=Turn(lean=1.0),
            chest=Turn(lean=-1.5),
            head=Turn(lean=4.0),
            left_arm=straight,
            right_arm=straight,
        ),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "bow",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.40, 1.10, 1.48, duration),
    )
