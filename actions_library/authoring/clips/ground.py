"""Close to the ground: crawling over it, rolling along it, falling onto it."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Plant, Via, other_foot, repeated
from actions_library.authoring.hand_poses import FLAT, RELAXED
from actions_library.authoring.keys import (
    ArmKey,
    Hand,
    Key,
    LegKey,
    Place,
    Turn,
    at,
    both_sides,
    carried,
)
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    moved_in_one_go,
    standing_still,
    steady_travel,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def crawl(skeleton: Skeleton) -> Clip:
    """Crawl on hands and toes, the knees just above the ground; hand and foot go crosswise."""
    duration, stride = 76 / 60, 0.62
    arm = ArmKey(to=(0.12, 0.10, 1.0), bend=30.0, elbow=(0.7, -1.0, 0.0), twist=20.0)
    half = [
        Key(
            0.0,
            place=Place(left=-0.016, up=-0.402),
            hips=Turn(yaw=-9.0, lean=90.0, tilt=0.0),
            chest=Turn(yaw=7.0, lean=104.0, tilt=0.0),
            head=Turn(yaw=6.0, lean=36.0, tilt=0.0),
            left_arm=arm,
            right_arm=arm,
        ),
        Key(
            0.25,
            place=Place(left=0.018, up=-0.390),
            hips=Turn(yaw=2.0, lean=88.0, tilt=0.0),
            chest=Turn(yaw=-2.0, lean=103.0, tilt=0.0),
            head=Turn(yaw=-2.0, lean=33.0, tilt=0.0),
        ),
    ]
    palm = Plant(
        land=0.0,
        leave=0.60 * duration,
        left=0.19,
        ahead=0.60,
        yaw=-6.0,
        land_pitch=26.0,
        flat=0.10,
        leave_pitch=44.0,
        roll=0.22,
        swing=(Via(0.45, 0.105, along=0.46, pitch=46.0), Via(0.80, 0.07, along=0.86, pitch=28.0)),
    )
    leave = 0.62 * duration
    toes = Plant(
        land=0.0,
        leave=leave,
        left=-0.125,
        ahead=-0.17,
        on_ball=(OnBall(0.0, 56.0), OnBall(0.3 * leave, 52.0), OnBall(leave, 78.0)),
        swing=(
            Via(0.45, 0.15, along=0.45, pitch=80.0, toes=50.0),
            Via(0.82, 0.135, along=0.90, pitch=64.0, toes=56.0),
        ),
    )
    left_palm, right_palm = _crosswise(palm, duration, stride)
    right_foot, left_foot = _crosswise(toes, duration, stride)
    return make_clip(
        skeleton,
        "crawl",
        both_sides(half),
        steady_travel(duration, ahead=stride),
        left_foot=left_foot,
        right_foot=right_foot,
        left_palm=left_palm,
        right_palm=right_palm,
        stage_ends_s=(0.0, 0.0, duration, duration, duration),
        cyclic=True,
    )


def _crosswise(first: Plant, duration: float, stride: float) -> tuple[list[Plant], list[Plant]]:
    """Return a cycle's plants of one hand or foot, and of the other one half a cycle later."""
    half = duration / 2
    other = replace(
        other_foot(first),
        land=first.land + half,
        leave=first.leave + half,
        ahead=first.ahead + stride / 2,
        on_ball=tuple(replace(key, at=key.at + half, turn=-key.turn) for key in first.on_ball),
    )
    one, two = (repeated([plant], duration, left=0.0, ahead=stride) for plant in (first, other))
    return one, two


def roll(skeleton: Skeleton) -> Clip:
    """Return a forward roll: down onto the hands, over the back, up onto the feet."""
    duration, far = 2.52, 1.55
    off, landed = 0.80, 1.52
    tucked = LegKey(to=(0.10, -0.30, 1.0), bend=128.0, point=20.0)
    on_ground = Hand(place=(0.20, 0.088, 0.60), fingers=(-0.2, 0.0, 1.0), palm=(0.0, -1.0, 0.1))
    reaching = ArmKey(to=(0.12, 0.20, 1.0), bend=40.0, elbow=(1.0, -0.6, 0.2), fingers=FLAT)
    hugging = ArmKey(to=(0.14, -0.62, 0.85), bend=64.0, elbow=(1.0, -0.2, -0.4), fingers=RELAXED)
    keys = [
        STAND,
        Key(  # squats
            0.44,
            place=Place(up=-0.330, ahead=-0.03),
            hips=Turn(lean=44.0),
            chest=Turn(lean=64.0),
            head=Turn(lean=40.0),
            left_arm=reaching,
            right_arm=reaching,
            left_hand=replace(on_ground, place=(0.20, 0.45, 0.45), hold=0.0),
            right_hand=replace(on_ground, place=(0.20, 0.45, 0.45), hold=0.0),
            left_leg=tucked,
            right_leg=tucked,
        ),
        Key(  # hands down
            0.66,
            place=Place(up=-0.380, ahead=0.20),
            hips=Turn(lean=88.0),
            chest=Turn(lean=118.0),
            head=Turn(lean=120.0),
            left_hand=on_ground,
            right_hand=on_ground,
        ),
        Key(0.74, left_hand=on_ground, right_hand=on_ground),
        Key(  # let go before the trunk turns over them
            0.80,
            left_hand=replace(on_ground, hold=0.0),
            right_hand=replace(on_ground, hold=0.0),
        ),
        Key(
            0.84,
            place=Place(up=-0.200, ahead=0.50),
            hips=Turn(lean=130.0),
            chest=Turn(lean=168.0),
            head=Turn(lean=205.0),
            left_leg=tucked,
            right_leg=tucked,
        ),
        Key(  # over the shoulders
            0.98,
            place=Place(up=-0.255, ahead=0.84),
            hips=Turn(lean=178.0),
            chest=Turn(lean=222.0),
            head=Turn(lean=262.0),
            left_arm=hugging,
            right_arm=hugging,
        ),
        Key(
            1.12,
            place=Place(up=-0.560, ahead=1.06),
            hips=Turn(lean=232.0),
            chest=Turn(lean=272.0),
            head=Turn(lean=308.0),
        ),
        Key(  # on the seat
            1.28,
            place=Place(up=-0.800, ahead=1.16),
            hips=Turn(lean=292.0),
            chest=Turn(lean=330.0),
            head=Turn(lean=356.0),
            left_leg=tucked,
            right_leg=tucked,
        ),
        Key(
            landed,
            place=Place(up=-0.690, ahead=1.25),
            hips=Turn(lean=352.0),
            chest=Turn(lean=392.0),
            head=Turn(lean=388.0),
            left_arm=replace(hugging, to=(0.25, -0.3, 1.0), bend=30.0),
            right_arm=replace(hugging, to=(0.25, -0.3, 1.0), bend=30.0),
        ),
        Key(  # over the feet
            1.76,
            place=Place(up=-0.460, ahead=far - 0.06),
            hips=Turn(lean=396.0),
            chest=Turn(lean=416.0),
            head=Turn(lean=382.0),
            left_arm=ArmKey(to=(0.35, -0.7, 0.7), bend=30.0),
            right_arm=ArmKey(to=(0.35, -0.7, 0.7), bend=34.0),
        ),
        Key(
            2.22,
            place=Place(up=-0.050, ahead=far + 0.01),
            hips=Turn(lean=368.0),
            chest=Turn(lean=368.0),
            head=Turn(lean=365.0),
            left_arm=ArmKey(to=(0.20, -1.0, 0.04), bend=16.0),
            right_arm=ArmKey(to=(0.20, -1.0, 0.06), bend=19.0),
        ),
        _head_over_heels(at(duration, carried(STAND, ahead=far))),
    ]
    left, right = (
        [
            replace(stance, leave=off + late, leave_pitch=64.0, roll=0.26),
            replace(
                stance,
                land=landed + late,
                ahead=stance.ahead + far,
                land_pitch=-12.0,
                flat=0.10,
                swing=None,
            ),
        ]
        for stance, late in ((LEFT_STANCE, 0.0), (RIGHT_STANCE, 0.02))
    )
    return make_clip(
        skeleton,
        "roll",
        keys,
        moved_in_one_go(duration, 0.52, landed, ahead=far),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.0, 0.52, landed, 1.76, duration),
    )


def _head_over_heels(key: Key) -> Key:
    """Return the key after a whole turn forward."""
    hips, chest, head = (
        turn and replace(turn, lean=turn.lean + 360.0) for turn in (key.hips, key.chest, key.head)
    )
    return replace(key, hips=hips, chest=chest, head=head)


def fall(skeleton: Skeleton) -> Clip:
    """Return a fall onto the back, a moment of lying there, and getting up again."""
    duration = 3.95
    flung = ArmKey(to=(0.75, 0.35, 0.75), bend=22.0, elbow=(0.4, -1.0, -0.4), fingers=RELAXED)
    spread = ArmKey(to=(1.0, -0.30, -0.03), bend=22.0, elbow=(0.1, -1.0, -0.2), fingers=RELAXED)
    pushing = ArmKey(
        to=(0.62, -0.45, -0.66), bend=24.0, elbow=(0.5, 0.2, -1.0), flex=-40.0, fingers=FLAT
    )
    prop = Hand((0.29, 0.085, -0.62), fingers=(0.75, 0.0, -0.65), palm=(0.0, -1.0, 0.0))

    def both(hand: Hand, at_s: float) -> Key:
        return Key(at_s, left_hand=hand, right_hand=hand)

    keys = [
        STAND,
        Key(  # struck: the chest gives way, the arms stay behind
            0.16,
            place=Place(up=-0.012, ahead=-0.03),
            hips=Turn(lean=4.0),
            chest=Turn(lean=14.0),
            head=Turn(lean=22.0),
            left_arm=ArmKey(to=(0.30, -0.90, 0.40), bend=30.0),
            right_arm=ArmKey(to=(0.30, -0.90, 0.50), bend=34.0),
        ),
        Key(  # tipping over the heels
            0.44,
            place=Place(up=-0.085, ahead=-0.21),
            hips=Turn(lean=-16.0),
            chest=Turn(lean=-18.0, tilt=3.0),
            head=Turn(lean=8.0),
            left_arm=flung,
            right_arm=replace(flung, to=(0.9, 0.10, 0.65)),
        ),
        Key(0.72, place=Place(up=-0.370, ahead=-0.40)),
        Key(0.90, place=Place(up=-0.745, ahead=-0.54)),
        Key(  # seat on the ground
            0.98,
            place=Place(left=0.01, up=-0.842, ahead=-0.58),
            hips=Turn(lean=-40.0),
            chest=Turn(lean=-26.0),
            head=Turn(lean=6.0),
            left_arm=replace(flung, to=(0.8, 0.15, 0.6)),
            right_arm=replace(flung, to=(0.9, 0.10, 0.55)),
        ),
        Key(  # back on the ground
            1.22,
            place=Place(left=0.01, up=-0.836, ahead=-0.64),
            hips=Turn(lean=-84.0),
            chest=Turn(lean=-84.0),
            head=Turn(lean=-62.0),
            left_arm=spread,
            right_arm=spread,
        ),
        Key(
            1.34,
            place=Place(left=0.01, up=-0.838, ahead=-0.645),
            hips=Turn(lean=-88.0),
            chest=Turn(lean=-89.0),
            head=Turn(yaw=10.0, lean=-84.0),
            left_arm=spread,
            right_arm=replace(spread, to=(1.0, -0.38, -0.03)),
        ),
        Key(  # lies there
            2.03,
            place=Place(left=0.01, up=-0.838, ahead=-0.645),
            hips=Turn(lean=-87.0),
            chest=Turn(lean=-86.0),
            head=Turn(yaw=14.0, lean=-78.0),
            left_arm=spread,
            right_arm=replace(spread, to=(1.0, -0.38, -0.03)),
        ),
        both(replace(prop, place=(0.55, 0.12, -0.85), hold=0.0), 2.10),
        both(prop, 2.46),
        Key(  # sits up, over the hands
            2.58,
            place=Place(up=-0.835, ahead=-0.56),
            hips=Turn(lean=-26.0),
            chest=Turn(lean=0.0),
            head=Turn(lean=12.0),
            left_arm=pushing,
            right_arm=pushing,
        ),
        both(prop, 2.74),
        Key(
            2.90,
            place=Place(up=-0.800, ahead=-0.44),
            hips=Turn(lean=8.0),
            chest=Turn(lean=42.0),
            head=Turn(lean=24.0),
            left_arm=replace(pushing, to=(0.62, -0.50, -0.30)),
            right_arm=replace(pushing, to=(0.62, -0.50, -0.30)),
        ),
        both(replace(prop, place=(0.36, 0.42, -0.28), hold=0.0), 3.06),
        Key(  # over the feet
            3.32,
            place=Place(up=-0.440, ahead=-0.09),
            hips=Turn(lean=32.0),
            chest=Turn(lean=64.0),
            head=Turn(lean=24.0),
            left_arm=ArmKey(to=(0.22, -0.75, 0.70), bend=22.0),
            right_arm=ArmKey(to=(0.22, -0.75, 0.75), bend=26.0),
        ),
        Key(
            3.74,
            place=Place(left=0.005, up=-0.040, ahead=-0.01),
            hips=Turn(lean=8.0),
            chest=Turn(lean=8.0),
            head=Turn(lean=7.0),
            left_arm=ArmKey(to=(0.20, -1.0, 0.06), bend=16.0),
            right_arm=ArmKey(to=(0.20, -1.0, 0.08), bend=19.0),
        ),
        at(duration, STAND),
    ]
    return make_clip(
        skeleton,
        "fall",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.16, 1.22, 1.34, duration),
    )
