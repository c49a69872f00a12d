"""What is played where nothing is drawn."""

from __future__ import annotations

from actions_library.authoring.keys import ArmKey, Key, Place, Turn
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, standing_still
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
            left_arm=ArmKey(to=(0.18, -1.0, 0.06), bend=16.0, shrug=2.5),
            right_arm=ArmKey(to=(0.18, -1.0, 0.09), bend=23.0, shrug=2.5),
        ),
        Key(
            0.5,
            place=Place(left=-0.008, up=-0.010, ahead=-0.003),
            hips=Turn(yaw=-0.5, lean=2.5, tilt=-0.8),
            chest=Turn(yaw=0.5, lean=1.4, tilt=0.8),
            head=Turn(yaw=1.0, lean=4.0, tilt=0.5),
            left_arm=ArmKey(to=(0.175, -1.0, 0.07), bend=18.0),
            right_arm=ArmKey(to=(0.165, -1.0, 0.06), bend=18.0),
        ),
        Key(
            0.75,
            place=Place(left=-0.028, up=-0.012, ahead=0.003),
            hips=Turn(yaw=1.0, lean=2.0, tilt=-3.2),
            chest=Turn(yaw=-1.5, lean=-1.4, tilt=2.4),
            head=Turn(yaw=-9.0, lean=1.5, tilt=1.5),
            left_arm=ArmKey(to=(0.18, -1.0, 0.06), bend=18.0, shrug=2.5),
            right_arm=ArmKey(to=(0.18, -1.0, 0.07), bend=20.0, shrug=2.5),
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
