"""Clips that never touch the ground."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.keys import Arm, Key, Leg, Place, Turn
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import steady_travel
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def fly(skeleton: Skeleton) -> Clip:
    """Return flight: lying on the air behind one fist, banking a little."""
    duration = 72 / 60
    fist = Arm(
        to=(0.10, 1.0, 0.16), bend=8.0, elbow=(1.0, 0.0, 0.3), twist=60.0, flex=0.0, curl=150.0
    )
    swept = Arm(to=(0.42, -1.0, -0.10), bend=14.0, elbow=(0.6, 0.0, -1.0), flex=-8.0, curl=15.0)
    straight = Leg(to=(0.06, -1.0, -0.02), bend=6.0, point=48.0)
    bent = Leg(to=(0.04, -1.0, 0.06), bend=38.0, point=52.0)
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
