"""Down and up again: crouching, sitting down on the ground, sitting there, standing up."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.hand_poses import FLAT, RELAXED
from actions_library.authoring.keys import ArmKey, Hand, Key, Place, Turn, at
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    standing_still,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton

_ON_KNEES = ArmKey(to=(0.02, -0.46, 1.0), bend=40.0, elbow=(1.0, -0.4, -0.5), fingers=RELAXED)

SEAT = Key(
    0.0,
    place=Place(left=0.0, up=-0.838, ahead=-0.500),
    hips=Turn(lean=-16.0),
    chest=Turn(lean=22.0),
    head=Turn(lean=6.0),
    left_arm=_ON_KNEES,
    right_arm=replace(_ON_KNEES, to=(-0.02, -0.50, 1.0), bend=46.0),
)
"""Sitting on the ground behind the feet, knees up, hands on them."""


def crouch(skeleton: Skeleton) -> Clip:
    """Crouch low over the feet, look about, and come up again."""
    duration = 2.40
    low = ArmKey(to=(0.10, -0.62, 0.85), bend=62.0, elbow=(1.0, -0.4, -0.5), fingers=RELAXED)
    keys = [
        STAND,
        Key(
            0.22,
            place=Place(left=0.006, up=-0.020, ahead=0.008),
            hips=Turn(lean=5.0),
            chest=Turn(lean=6.0),
            head=Turn(lean=8.0),
        ),
        Key(
            0.78,
            place=Place(up=-0.520, ahead=-0.060),
            hips=Turn(lean=38.0),
            chest=Turn(lean=56.0),
            head=Turn(yaw=0.0, lean=12.0),
            left_arm=low,
            right_arm=low,
        ),
        Key(1.10, head=Turn(yaw=34.0, lean=8.0)),
        Key(
            1.30,
            place=Place(up=-0.528, ahead=-0.060),
            hips=Turn(lean=38.0),
            chest=Turn(lean=57.0),
            left_arm=low,
            right_arm=replace(low, to=(0.10, -0.66, 0.85)),
        ),
        Key(1.50, head=Turn(yaw=-30.0, lean=8.0)),
        Key(
            2.06,
            place=Place(left=0.008, up=-0.040, ahead=-0.004),
            hips=Turn(lean=7.0),
            chest=Turn(lean=6.0),
            head=Turn(yaw=0.0, lean=5.0),
            left_arm=ArmKey(to=(0.19, -1.0, 0.08), bend=19.0),
            right_arm=ArmKey(to=(0.19, -1.0, 0.10), bend=22.0),
        ),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "crouch",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.22, 0.78, 1.50, duration),
    )


def sit_down(skeleton: Skeleton) -> Clip:
    """Sit down on the ground: squat, a hand behind, the seat down, hands on the knees."""
    duration = 2.30
    behind = ArmKey(to=(0.60, -0.80, -0.30), bend=14.0, follow=0.0, flex=-30.0, fingers=FLAT)
    keys = [
        STAND,
        Key(  # looks where
            0.28,
            place=Place(left=-0.004, up=-0.014, ahead=0.006),
            hips=Turn(yaw=-4.0, lean=4.0),
            chest=Turn(yaw=-12.0, lean=6.0),
            head=Turn(yaw=-38.0, lean=20.0),
        ),
        Key(  # squats
            0.92,
            place=Place(left=0.0, up=-0.500, ahead=-0.120),
            hips=Turn(yaw=-2.0, lean=30.0),
            chest=Turn(yaw=-6.0, lean=66.0),
            head=Turn(yaw=-12.0, lean=30.0),
            left_arm=ArmKey(to=(0.06, -0.20, 1.0), bend=30.0, follow=0.0),
            right_arm=behind,
        ),
        Key(1.22, right_arm=replace(behind, to=(0.60, -0.60, -0.50), bend=20.0, flex=-50.0)),
        Key(  # lets the seat down
            1.36,
            place=Place(left=0.0, up=-0.825, ahead=-0.470),
            hips=Turn(lean=6.0),
            chest=Turn(lean=46.0),
            head=Turn(lean=26.0),
            left_arm=ArmKey(to=(0.04, -0.16, 1.0), bend=30.0, follow=0.0),
            right_arm=replace(behind, to=(0.62, -0.50, -0.50), bend=24.0, flex=-50.0),
        ),
        Key(
            1.70,
            place=SEAT.place,
            hips=Turn(lean=-18.0),
            chest=Turn(lean=18.0),
            head=Turn(lean=8.0),
            left_arm=_ON_KNEES,
            right_arm=ArmKey(to=(0.45, -0.30, 0.80), bend=50.0),
        ),
        at(duration, SEAT),
    ]
    return make_clip(
        skeleton,
        "sit_down",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.28, 1.36, 1.70, duration),
    )


def idle_sitting(skeleton: Skeleton) -> Clip:
    """Sit on the ground: two breaths, a look to either side."""
    duration = 6.0
    keys = [
        SEAT,
        Key(
            0.25,
            chest=Turn(yaw=2.0, lean=18.5, tilt=-1.0),
            head=Turn(yaw=16.0, lean=3.0, tilt=-1.5),
            left_arm=replace(_ON_KNEES, shrug=2.5),
        ),
        Key(0.5, chest=Turn(lean=22.5), head=Turn(yaw=1.0, lean=7.0)),
        Key(
            0.75,
            chest=Turn(yaw=-2.0, lean=19.0, tilt=1.0),
            head=Turn(yaw=-14.0, lean=3.5, tilt=1.5),
            left_arm=replace(_ON_KNEES, shrug=2.0),
        ),
    ]
    return make_clip(
        skeleton,
        "idle_sitting",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )


def stand_up(skeleton: Skeleton) -> Clip:
    """Stand up from the ground: hands behind push, the mass goes over the feet, then it rises."""
    duration = 2.60
    pushing = ArmKey(
        to=(0.50, -0.70, -0.50), bend=20.0, elbow=(0.5, 0.2, -1.0), flex=-50.0, fingers=FLAT
    )
    prop = Hand((0.28, 0.085, -0.56), fingers=(0.75, 0.0, -0.65), palm=(0.0, -1.0, 0.0))
    lifted = replace(prop, place=(0.36, 0.42, -0.28), hold=0.0)

    def both(hand: Hand, at_s: float) -> Key:
        return Key(at_s, left_hand=hand, right_hand=hand)

    keys = [
        SEAT,
        both(replace(lifted, place=(0.34, 0.36, -0.45)), 0.06),
        Key(
            0.22,
            left_arm=replace(pushing, to=(0.85, -0.46, 0.00)),
            right_arm=replace(pushing, to=(0.85, -0.46, 0.00)),
        ),
        both(prop, 0.40),
        Key(  # leans back onto the hands to gather
            0.44,
            place=Place(left=0.0, up=-0.836, ahead=-0.505),
            hips=Turn(lean=-22.0),
            chest=Turn(lean=6.0),
            head=Turn(lean=10.0),
            left_arm=pushing,
            right_arm=pushing,
        ),
        Key(  # rocks forward
            0.84,
            place=Place(left=0.0, up=-0.812, ahead=-0.430),
            hips=Turn(lean=6.0),
            chest=Turn(lean=42.0),
            head=Turn(lean=26.0),
            left_arm=replace(pushing, to=(0.60, -0.62, -0.40)),
            right_arm=replace(pushing, to=(0.60, -0.62, -0.40)),
        ),
        both(prop, 0.78),
        both(lifted, 1.10),
        Key(  # over the feet
            1.38,
            place=Place(left=0.0, up=-0.455, ahead=-0.085),
            hips=Turn(lean=31.0),
            chest=Turn(lean=64.0),
            head=Turn(lean=26.0),
            left_arm=ArmKey(to=(0.20, -0.72, 0.75), bend=24.0),
            right_arm=ArmKey(to=(0.20, -0.72, 0.80), bend=28.0),
        ),
        Key(  # up
            2.00,
            place=Place(left=0.006, up=-0.022, ahead=0.0),
            hips=Turn(lean=4.0),
            chest=Turn(lean=1.0),
            head=Turn(lean=2.0),
            left_arm=ArmKey(to=(0.19, -1.0, 0.04), bend=14.0),
            right_arm=ArmKey(to=(0.19, -1.0, 0.06), bend=18.0),
        ),
        Key(2.24, place=Place(left=0.009, up=-0.006), chest=Turn(lean=-1.0)),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "stand_up",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.44, 2.00, 2.24, duration),
    )
