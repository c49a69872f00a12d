"""Greetings."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.hand_poses import FLAT
from actions_library.authoring.keys import ArmKey, Key, Place, Turn, at
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, standing_still
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def bow(skeleton: Skeleton) -> Clip:
    """Return a formal bow: from the hips, the back straight, the arms along the body."""
    duration = 2.60
    straight = ArmKey(to=(0.15, -1.0, 0.03), bend=10.0, twist=15.0, flex=2.0, fingers=FLAT)
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


def nod(skeleton: Skeleton) -> Clip:
    """Return a nod: the head down and up, twice, the chest and the arms with it a little."""
    duration = 1.70
    sunk = ArmKey(to=(0.17, -1.0, 0.12), bend=20.0, shrug=-1.5)
    sunk_right = ArmKey(to=(0.175, -1.0, 0.15), bend=26.0, shrug=-1.5)
    raised = ArmKey(to=(0.18, -1.0, 0.02), bend=14.0, shrug=2.5)
    raised_right = ArmKey(to=(0.185, -1.0, 0.05), bend=20.0, shrug=2.5)
    keys = [
        STAND,
        Key(  # up first
            0.24,
            chest=Turn(yaw=1.5, lean=-1.5, tilt=-1.0),
            head=Turn(yaw=0.0, lean=-9.0),
            left_arm=raised,
            right_arm=raised_right,
        ),
        Key(
            0.48,
            place=Place(left=0.012, up=-0.012, ahead=-0.004),
            hips=Turn(yaw=-2.0, lean=3.5, tilt=1.5),
            chest=Turn(yaw=1.5, lean=5.5, tilt=-1.0),
            head=Turn(yaw=0.0, lean=34.0),
            left_arm=sunk,
            right_arm=sunk_right,
        ),
        Key(
            0.74,
            hips=Turn(yaw=-2.0, lean=2.0, tilt=1.5),
            chest=Turn(yaw=1.5, lean=1.0, tilt=-1.0),
            head=Turn(yaw=0.0, lean=-3.0),
            left_arm=raised,
            right_arm=raised_right,
        ),
        Key(
            1.00,
            place=Place(left=0.012, up=-0.012, ahead=-0.003),
            hips=Turn(yaw=-2.0, lean=3.2, tilt=1.5),
            chest=Turn(yaw=1.5, lean=4.5, tilt=-1.0),
            head=Turn(yaw=0.0, lean=29.0),
            left_arm=sunk,
            right_arm=sunk_right,
        ),
        Key(
            1.34,
            chest=Turn(yaw=1.5, lean=0.2, tilt=-1.0),
            head=Turn(yaw=0.0, lean=1.0),
        ),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "nod",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.24, 0.48, 1.34, duration),
    )


def wave(skeleton: Skeleton) -> Clip:
    """Wave with the right hand: raised beside the head, from side to side, three times.

    The other arm goes out to balance the body, and swings with it.
    """
    duration, beat = 2.60, 0.21
    up = ArmKey(
        to=(0.62, 0.55, 0.42),
        bend=78.0,
        elbow=(1.0, -0.7, -0.1),
        twist=-62.0,
        flex=0.0,
        fingers=FLAT,
    )
    inward = replace(up, to=(0.30, 0.75, 0.42), bend=88.0, flex=-4.0)
    outward = replace(up, to=(0.95, 0.62, 0.36), bend=52.0, flex=6.0)
    balance = ArmKey(to=(0.36, -1.0, 0.02), bend=24.0)
    swung = replace(balance, to=(0.27, -1.0, 0.14), bend=32.0)
    first = 0.62
    waving = [
        Key(
            first + i * beat,
            right_arm=(outward, inward)[i % 2],
            left_arm=(balance, swung)[i % 2],
            chest=chest,
        )
        for i, chest in enumerate([Turn(yaw=-3.0, tilt=3.0), Turn(yaw=-1.0, tilt=0.5)] * 3)
    ]
    keys = [
        STAND,
        Key(  # the weight goes to the left leg
            0.22,
            place=Place(left=0.030, up=-0.012),
            hips=Turn(yaw=-3.0, lean=2.0, tilt=3.0),
            head=Turn(lean=3.0),
            left_arm=ArmKey(to=(0.24, -1.0, 0.04), bend=18.0),
            right_arm=ArmKey(to=(0.30, -0.80, 0.40), bend=50.0),
        ),
        Key(
            0.60,
            place=Place(left=0.036, up=-0.013),
            hips=Turn(yaw=-4.0, lean=1.5, tilt=3.6),
            head=Turn(yaw=-2.0, lean=0.0, tilt=4.0),
        ),
        *waving,
        Key(
            first + 5 * beat,
            place=Place(left=0.034, up=-0.012),
            hips=Turn(yaw=-4.0, lean=1.5, tilt=3.4),
            head=Turn(yaw=-2.0, lean=0.0, tilt=3.0),
        ),
        Key(2.12, right_arm=ArmKey(to=(0.30, -0.95, 0.34), bend=38.0)),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "wave",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.22, first, first + 5 * beat, first + 5 * beat, duration),
    )
