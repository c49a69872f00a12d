"""Clips that never touch the ground."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.hand_poses import FIST, FLAT, HOLD, RELAXED
from actions_library.authoring.keys import ArmKey, Hand, Key, LegKey, Place, Turn, both_sides
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import standing_still, steady_travel
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def fly(skeleton: Skeleton) -> Clip:
    """Return flight: lying on the air behind one fist, banking a little."""
    duration = 72 / 60
    fist = ArmKey(
        to=(0.10, 1.0, 0.16), bend=8.0, elbow=(1.0, 0.0, 0.3), twist=60.0, flex=0.0, fingers=FIST
    )
    swept = ArmKey(
        to=(0.42, -1.0, -0.10), bend=14.0, elbow=(0.6, 0.0, -1.0), flex=-8.0, fingers=FLAT
    )
    straight = LegKey(to=(0.06, -1.0, -0.02), bend=6.0, point=48.0)
    bent = LegKey(to=(0.04, -1.0, 0.06), bend=38.0, point=52.0)
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


def swim(skeleton: Skeleton) -> Clip:
    """Return the front crawl, at the height of a pool's surface: two strokes, six kicks."""
    duration, stride = 96 / 60, 1.9
    entry = ArmKey(
        to=(0.10, 1.0, 0.12), bend=14.0, elbow=(1.0, 0.2, -0.4), twist=40.0, fingers=FLAT
    )
    pull = ArmKey(to=(0.16, 0.10, 1.0), bend=52.0, elbow=(1.0, 0.5, 0.1), twist=20.0, fingers=FLAT)
    push = ArmKey(to=(0.24, -1.0, 0.16), bend=14.0, elbow=(0.8, 0.2, -0.8), twist=0.0, fingers=FLAT)
    recovery = ArmKey(
        to=(0.90, -0.10, -0.42), bend=84.0, elbow=(0.6, 0.1, -1.0), twist=10.0, fingers=RELAXED
    )
    half = [
        Key(
            0.0,
            place=Place(left=-0.01, up=-0.115),
            hips=Turn(yaw=-4.0, lean=86.0, tilt=0.0),
            chest=Turn(yaw=-2.0, lean=80.0, tilt=-3.0),
            head=Turn(yaw=0.0, lean=52.0, tilt=0.0),
            left_arm=entry,
            right_arm=push,
        ),
        Key(0.13, left_arm=replace(entry, to=(0.10, 0.85, 0.50)), right_arm=recovery),
        Key(
            0.25,
            place=Place(left=0.01, up=-0.095),
            hips=Turn(yaw=3.0, lean=87.0, tilt=0.0),
            chest=Turn(yaw=3.0, lean=81.0, tilt=3.0),
            head=Turn(yaw=26.0, lean=54.0, tilt=-8.0),
            left_arm=pull,
            right_arm=replace(recovery, to=(0.90, 0.40, -0.34)),
        ),
        Key(
            0.38,
            left_arm=replace(pull, to=(0.18, -0.60, 0.70), bend=40.0),
            right_arm=replace(entry, to=(0.34, 0.95, -0.10), bend=40.0),
        ),
    ]
    up, down = (
        LegKey(to=(0.04, -1.0, -0.20), bend=10.0, point=50.0),
        LegKey(to=(0.04, -1.0, 0.16), bend=24.0, point=54.0),
    )
    kicks = [
        Key(beat / 6, left_leg=up if beat % 2 else down, right_leg=down if beat % 2 else up)
        for beat in range(6)
    ]
    return make_clip(
        skeleton,
        "swim",
        [*both_sides(half), *kicks],
        steady_travel(duration, ahead=stride),
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )


def climb(skeleton: Skeleton) -> Clip:
    """Climb on the spot, as up an endless ladder: the rungs come down, hand over hand."""
    duration = 90 / 60
    arm = ArmKey(to=(0.12, 0.85, 0.6), bend=50.0, elbow=(0.9, -1.0, -0.2), fingers=HOLD, twist=60.0)

    def rung(up: float, ahead: float = 0.40) -> Hand:
        return Hand(place=(0.17, up, ahead), fingers=(-0.1, 1.0, 0.5), palm=(0.0, -0.35, 1.0))

    low = LegKey(to=(0.10, -1.0, 0.20), bend=34.0, knee=(0.35, 0.0, 1.0), point=6.0)
    high = LegKey(to=(0.22, -0.62, 0.50), bend=104.0, knee=(0.55, 0.3, 1.0), point=10.0)
    half = [
        Key(  # the left hand has a new rung, the right foot too
            0.0,
            place=Place(left=-0.030, up=0.125, ahead=-0.03),
            hips=Turn(yaw=4.0, lean=6.0, tilt=-5.0),
            chest=Turn(yaw=-10.0, lean=2.0, tilt=5.0),
            head=Turn(yaw=4.0, lean=-16.0, tilt=1.0),
            left_arm=arm,
            right_arm=arm,
            left_hand=rung(1.97),
            right_hand=rung(1.52),
            left_leg=low,
            right_leg=high,
        ),
        Key(0.08, right_hand=rung(1.48, 0.34)),
        Key(
            0.25,
            place=Place(left=0.0, up=0.170, ahead=-0.02),
            hips=Turn(yaw=0.0, lean=4.0, tilt=0.0),
            chest=Turn(yaw=0.0, lean=0.0, tilt=0.0),
            head=Turn(yaw=0.0, lean=-20.0, tilt=0.0),
            left_hand=rung(1.745),
            right_hand=rung(1.80, 0.26),
            left_leg=replace(low, to=(0.14, -0.90, 0.06), bend=80.0, point=24.0),
            right_leg=replace(high, to=(0.16, -0.85, 0.38), bend=70.0),
        ),
        Key(0.42, right_hand=rung(1.97, 0.33)),
    ]
    return make_clip(
        skeleton,
        "climb",
        both_sides(half),
        standing_still(duration),
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )
