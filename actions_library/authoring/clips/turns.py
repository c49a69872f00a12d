"""Turns on the spot."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Plant, Via, other_foot
from actions_library.authoring.keys import Arm, Key, Place, Turn, at, carried, mirrored
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
