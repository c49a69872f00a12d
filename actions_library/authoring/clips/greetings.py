"""Greetings."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.keys import Arm, Key, Place, Turn, at
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, standing_still
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


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
