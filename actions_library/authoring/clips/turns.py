"""Turns on the spot."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Plant, Via, other_foot
from actions_library.authoring.hand_poses import RELAXED
from actions_library.authoring.keys import ArmKey, Key, LegKey, Place, Turn, at, carried, mirrored
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, moved_in_one_go
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def turn_left(skeleton: Skeleton) -> Clip:
    """Return a quarter turn: eyes, chest and hips in turn, then one foot after the other."""
    return _quarter_turn(skeleton, "turn_left", 1.0)


def turn_right(skeleton: Skeleton) -> Clip:
    """Return the quarter turn to the right."""
    return _quarter_turn(skeleton, "turn_right", -1.0)


def _quarter_turn(skeleton: Skeleton, name: str, to: float) -> Clip:
    """Make the turn to the left; the one to the right is posed as its mirror image."""
    duration = 1.5
    hanging_out = ArmKey(to=(0.34, -1.0, 0.10), bend=24.0)
    hanging_in = ArmKey(to=(0.21, -1.0, 0.22), bend=26.0)
    stand = STAND if to > 0 else mirrored(STAND)
    keys = [
        stand,
        Key(  # eyes first, weight onto the right leg
            0.28,
            place=Place(left=-0.105, up=-0.024, ahead=-0.016),
            hips=Turn(yaw=-3.0, lean=3.0, tilt=-3.0),
            chest=Turn(yaw=8.0, lean=2.0, tilt=1.0),
            head=Turn(yaw=38.0, lean=6.0, tilt=-2.0),
            left_arm=ArmKey(to=(0.22, -1.0, 0.04), bend=20.0),
            right_arm=ArmKey(to=(0.20, -1.0, 0.12), bend=24.0),
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
            left_arm=ArmKey(to=(0.26, -1.0, -0.08), bend=15.0),
            right_arm=ArmKey(to=(0.26, -1.0, 0.16), bend=26.0),
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


def spin(skeleton: Skeleton) -> Clip:
    """Return a whole turn to the left on the ball of the left foot, the right one at its knee."""
    duration, off, landed = 1.90, 0.52, 1.34
    gathered = ArmKey(to=(-0.10, -0.55, 0.80), bend=84.0, elbow=(1.0, -0.2, 0.1), fingers=RELAXED)
    opened = ArmKey(to=(1.0, -0.22, 0.35), bend=24.0, elbow=(0.2, -0.8, -0.6), fingers=RELAXED)
    drawn = LegKey(to=(0.30, -0.84, 0.14), bend=96.0, knee=(0.8, 0.0, 1.0), point=56.0)
    keys = [
        STAND,
        Key(  # wound up to the right, both knees bent
            0.36,
            place=Place(left=0.030, up=-0.110, ahead=0.010),
            hips=Turn(yaw=-16.0, lean=8.0),
            chest=Turn(yaw=-42.0, lean=8.0),
            head=Turn(yaw=-8.0, lean=6.0),
            left_arm=ArmKey(to=(0.10, -0.50, 1.0), bend=40.0, elbow=(0.9, -0.5, -0.2)),
            right_arm=replace(opened, to=(1.0, -0.30, -0.25)),
            right_leg=drawn,
        ),
        Key(  # off
            off,
            place=Place(left=0.108, up=-0.030, ahead=0.090),
            hips=Turn(yaw=20.0, lean=3.0, tilt=1.0),
            chest=Turn(yaw=24.0, lean=3.0),
            head=Turn(yaw=0.0, lean=4.0),
            left_arm=opened,
            right_arm=opened,
        ),
        Key(0.74, left_arm=gathered, right_arm=gathered),
        Key(  # the head stays behind, then whips round
            0.80,
            place=Place(left=0.122, up=0.036, ahead=0.128),
            hips=Turn(yaw=138.0, lean=1.0, tilt=2.0),
            chest=Turn(yaw=148.0, lean=1.0),
            head=Turn(yaw=82.0, lean=3.0),
            right_leg=drawn,
        ),
        Key(
            1.08,
            place=Place(left=0.122, up=0.036, ahead=0.128),
            hips=Turn(yaw=272.0, lean=1.0, tilt=2.0),
            chest=Turn(yaw=284.0, lean=1.0),
            head=Turn(yaw=346.0, lean=3.0),
            right_leg=drawn,
        ),
        Key(1.16, left_arm=gathered, right_arm=gathered),
        Key(  # caught
            landed + 0.06,
            place=Place(left=0.030, up=-0.070, ahead=0.010),
            hips=Turn(yaw=358.0, lean=6.0),
            chest=Turn(yaw=366.0, lean=6.0),
            head=Turn(yaw=360.0, lean=5.0),
            left_arm=replace(opened, to=(0.85, -0.70, 0.40)),
            right_arm=replace(opened, to=(0.85, -0.70, 0.30)),
            right_leg=drawn,
        ),
        at(duration, carried(STAND, yaw=360.0)),
    ]
    left = [
        replace(
            LEFT_STANCE,
            on_ball=(
                OnBall(0.40, 0.0),
                OnBall(0.56, 44.0, turn=14.0),
                OnBall(0.80, 52.0, turn=134.0),
                OnBall(1.08, 52.0, turn=268.0),
                OnBall(1.34, 16.0, turn=358.0),
                OnBall(1.46, 0.0, turn=360.0),
            ),
        )
    ]
    right = [
        replace(RIGHT_STANCE, leave=off, leave_pitch=36.0, roll=0.14),
        replace(RIGHT_STANCE, land=landed, yaw=348.0, land_pitch=22.0, flat=0.10, swing=None),
    ]
    return make_clip(
        skeleton,
        "spin",
        keys,
        moved_in_one_go(duration, 0.36, landed + 0.06, yaw=360.0),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.0, 0.36, landed, landed + 0.06, duration),
    )
