"""Joy: clapping, cheering, dancing."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.clips.jumps import ballistic
from actions_library.authoring.feet import OnBall, Plant, Via, other_foot, repeated
from actions_library.authoring.hand_poses import FIST, FLAT, LOOSE
from actions_library.authoring.keys import ArmKey, Hand, Key, Place, Turn, at, both_sides
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    standing_still,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def clap(skeleton: Skeleton) -> Clip:
    """Clap the hands before the chest, five times."""
    duration, first, beat = 2.40, 0.52, 0.28
    arm = ArmKey(to=(0.05, -0.45, 0.8), bend=86.0, elbow=(0.9, -1.0, -0.3), fingers=FLAT)
    apart = Hand((0.150, 1.20, 0.345), fingers=(0.12, 0.55, 0.80), palm=(-1.0, 0.0, 0.0))
    together = replace(apart, place=(0.030, 1.215, 0.375), fingers=(-0.10, 0.55, 0.80))

    def hands(at_s: float, hand: Hand) -> Key:
        return Key(at_s, left_hand=hand, right_hand=hand)

    claps = [
        hands(first + (i + part) * beat, hand)
        for i in range(5)
        for part, hand in ((0.0, apart), (0.42, together), (0.54, together))
    ]
    keys = [
        STAND,
        hands(0.10, replace(apart, place=(0.2, 1.0, 0.2), hold=0.0)),
        Key(
            0.40,
            place=Place(left=0.008, up=-0.012),
            hips=Turn(yaw=-1.0, lean=2.0, tilt=1.0),
            chest=Turn(yaw=0.5, lean=3.0),
            head=Turn(lean=3.0),
            left_arm=arm,
            right_arm=arm,
        ),
        *claps,
        *(
            Key(
                first + (i + 0.45) * beat,
                place=Place(left=0.008, up=-0.018),
                chest=Turn(yaw=0.5, lean=4.5, tilt=1.0 if i % 2 else -1.0),
                head=Turn(lean=6.0, tilt=2.0 if i % 2 else -2.0),
            )
            for i in range(5)
        ),
        hands(first + 5 * beat, apart),
        Key(
            2.12,
            place=Place(left=0.012, up=-0.010),
            hips=Turn(yaw=-2.0, lean=2.0, tilt=1.5),
            left_arm=ArmKey(to=(0.19, -1.0, 0.22), bend=34.0),
            right_arm=ArmKey(to=(0.19, -1.0, 0.24), bend=38.0),
            left_hand=replace(apart, place=(0.2, 1.0, 0.25), hold=0.0),
            right_hand=replace(apart, place=(0.2, 1.0, 0.25), hold=0.0),
        ),
        at(duration, STAND),
    ]
    end = first + 5 * beat
    return make_clip(
        skeleton,
        "clap",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.10, first, end, end, duration),
    )


def cheer(skeleton: Skeleton) -> Clip:
    """Throw both arms up and jump for joy, twice."""
    duration = 3.00
    flights = ((0.64, 0.96), (1.44, 1.76))
    down = ArmKey(to=(0.30, -0.90, 0.35), bend=92.0, elbow=(0.8, -0.3, -1.0), fingers=FIST)
    high = ArmKey(to=(0.55, 1.0, 0.12), bend=16.0, elbow=(0.9, -0.3, 0.2), fingers=FIST)
    pumped = replace(high, to=(0.60, 0.80, 0.28), bend=60.0)
    take_off, touch_down = Place(up=-0.006, ahead=0.015), Place(up=-0.070, ahead=0.010)
    crouch = Place(up=-0.200, ahead=-0.025)
    keys = [
        STAND,
        Key(
            0.42,
            place=crouch,
            hips=Turn(lean=22.0),
            chest=Turn(lean=30.0),
            head=Turn(lean=14.0),
            left_arm=down,
            right_arm=down,
        ),
        Key(
            1.23,
            place=Place(up=-0.245, ahead=-0.025),
            hips=Turn(lean=20.0),
            chest=Turn(lean=20.0),
            left_arm=pumped,
            right_arm=pumped,
        ),
        Key(
            2.04,
            place=Place(up=-0.225, ahead=-0.025),
            hips=Turn(lean=18.0),
            chest=Turn(lean=16.0),
            left_arm=high,
            right_arm=high,
        ),
        Key(
            2.48,
            place=Place(up=-0.014, ahead=0.0),
            hips=Turn(lean=2.0),
            chest=Turn(lean=-3.0),
            head=Turn(lean=-6.0),
            left_arm=replace(high, to=(0.70, 0.75, 0.12), bend=30.0),
            right_arm=replace(high, to=(0.70, 0.75, 0.12), bend=34.0),
        ),
        at(duration, STAND),
    ]
    for off, landed in flights:
        keys += [
            Key(
                off,
                place=take_off,
                hips=Turn(lean=3.0),
                chest=Turn(lean=-6.0),
                head=Turn(lean=-14.0),
            ),
            Key(off + 0.08, left_arm=high, right_arm=high),
            Key(
                landed,
                place=touch_down,
                hips=Turn(lean=8.0),
                chest=Turn(lean=6.0),
                head=Turn(lean=-4.0),
            ),
            *ballistic(off, take_off, landed, touch_down),
        ]

    def feet(stance: Plant, late: float) -> list[Plant]:
        edges = [(None, flights[0][0]), (flights[0][1], flights[1][0]), (flights[1][1], None)]
        return [
            replace(
                stance,
                land=stance.land if land is None else land + late,
                leave=stance.leave if leave is None else leave,
                land_pitch=28.0,
                flat=0.09,
                leave_pitch=0.0 if leave is None else 58.0,
                roll=0.14,
                swing=(Via(0.5, 0.24, pitch=46.0),),
            )
            for land, leave in edges
        ]

    return make_clip(
        skeleton,
        "cheer",
        keys,
        standing_still(duration),
        left_foot=feet(LEFT_STANCE, 0.0),
        right_foot=feet(RIGHT_STANCE, 0.012),
        stage_ends_s=(0.0, 0.42, 1.76, 2.04, duration),
    )


def dance(skeleton: Skeleton) -> Clip:
    """Dance on the spot: step, touch, step, touch, the hips and the arms swinging."""
    duration = 76 / 60
    swung = ArmKey(to=(0.75, -0.45, 0.50), bend=70.0, elbow=(0.8, -0.8, -0.6), fingers=LOOSE)
    across = ArmKey(to=(-0.25, -0.40, 0.95), bend=86.0, elbow=(1.0, -0.5, 0.1), fingers=LOOSE)
    half = [
        Key(  # the left foot has stepped to the left
            0.0,
            place=Place(left=0.105, up=-0.085),
            hips=Turn(yaw=8.0, lean=5.0, tilt=-6.0),
            chest=Turn(yaw=-10.0, lean=6.0, tilt=6.0),
            head=Turn(yaw=12.0, lean=3.0, tilt=-3.0),
            left_arm=swung,
            right_arm=across,
        ),
        Key(
            0.13,
            place=Place(left=0.168, up=-0.030),
            hips=Turn(yaw=16.0, lean=3.0, tilt=7.0),
            chest=Turn(yaw=-14.0, lean=2.0, tilt=-6.0),
            head=Turn(yaw=10.0, lean=1.0, tilt=3.0),
            left_arm=replace(swung, to=(0.95, 0.05, 0.35), bend=92.0),
            right_arm=replace(across, to=(-0.10, -0.05, 1.0), bend=98.0),
        ),
        Key(  # the right toes touch beside it
            0.27,
            place=Place(left=0.172, up=-0.070),
            hips=Turn(yaw=6.0, lean=5.0, tilt=4.0),
            chest=Turn(yaw=2.0, lean=6.0, tilt=-3.0),
            head=Turn(yaw=2.0, lean=4.0, tilt=2.0),
        ),
    ]
    left = [
        Plant(
            land=0.0,
            leave=0.56 * duration,
            left=0.205,
            ahead=0.01,
            yaw=14.0,
            land_pitch=14.0,
            flat=0.09,
            leave_pitch=30.0,
            roll=0.18,
            swing=(Via(0.5, 0.09, pitch=16.0),),
        ),
        Plant(  # touches on its toes, beside the right foot
            land=0.70 * duration,
            leave=0.90 * duration,
            left=-0.035,
            ahead=0.05,
            yaw=16.0,
            on_ball=(OnBall(0.70 * duration, 40.0), OnBall(0.90 * duration, 44.0)),
            swing=(Via(0.5, 0.13, pitch=36.0, toes=10.0),),
        ),
    ]
    right = [
        replace(
            other,
            land=other.land + duration / 2,
            leave=other.leave + duration / 2,
            on_ball=tuple(replace(key, at=key.at + duration / 2) for key in other.on_ball),
        )
        for other in map(other_foot, left)
    ]
    return make_clip(
        skeleton,
        "dance",
        both_sides(half),
        standing_still(duration),
        left_foot=repeated(left, duration, left=0.0, ahead=0.0),
        right_foot=repeated(right, duration, left=0.0, ahead=0.0),
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )
