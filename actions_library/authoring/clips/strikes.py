"""Strikes: what goes out at something and comes back."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.feet import OnBall, Via
from actions_library.authoring.hand_poses import FIST, FLAT, HOLD, LOOSE
from actions_library.authoring.keys import ArmKey, Hand, Key, LegKey, Place, Turn, at
from actions_library.authoring.posing import make_clip
from actions_library.authoring.stance import LEFT_STANCE, RIGHT_STANCE, STAND, standing_still
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton


def punch(skeleton: Skeleton) -> Clip:
    """Return a right-hand straight: from the rear foot through hips and shoulder to the fist."""
    duration = 1.68
    fist = ArmKey(bend=120.0, elbow=(0.4, -1.0, -0.1), twist=25.0, flex=0.0, fingers=FIST)
    straight = replace(
        fist, to=(-0.02, 0.05, 1.0), bend=7.0, elbow=(1.0, -0.6, 0.0), follow=0.0, twist=80.0
    )
    keys = [
        STAND,
        Key(  # the weight goes to the rear foot before the front one leaves
            0.19,
            place=Place(left=-0.070, up=-0.045, ahead=-0.015),
            left_arm=ArmKey(to=(0.22, -0.9, 0.50), bend=70.0, fingers=HOLD),
            right_arm=ArmKey(to=(0.22, -0.9, 0.45), bend=75.0, fingers=HOLD),
        ),
        Key(  # guard
            0.41,
            place=Place(left=-0.030, up=-0.070, ahead=0.050),
            hips=Turn(yaw=-26.0, lean=6.0),
            chest=Turn(yaw=-24.0, lean=10.0),
            head=Turn(yaw=-4.0, lean=9.0),
            left_arm=replace(fist, to=(-0.05, 0.0, 1.0), bend=108.0),
            right_arm=replace(fist, to=(-0.25, -0.02, 0.8), bend=130.0),
        ),
        Key(0.52, place=Place(left=-0.055, up=-0.085, ahead=0.030)),  # the weight goes back
        Key(  # anticipation: and the fist, while the weight already comes
            0.65,
            place=Place(left=-0.030, up=-0.100, ahead=0.075),
            hips=Turn(yaw=-46.0, lean=3.0, tilt=2.0),
            chest=Turn(yaw=-62.0, lean=4.0, tilt=5.0),
            head=Turn(yaw=-8.0, lean=7.0, tilt=3.0),
            left_arm=replace(fist, to=(0.10, 0.0, 1.0), bend=58.0, follow=0.0, twist=40.0),
            right_arm=replace(fist, to=(0.25, -0.50, 0.45), bend=132.0, elbow=(0.5, -0.2, -1.0)),
        ),
        Key(0.77, hips=Turn(yaw=14.0, lean=9.0)),  # the hips first, then the chest
        Key(0.80, chest=Turn(yaw=42.0, lean=13.0, tilt=-4.0)),
        Key(  # then the elbow, the fist still at the shoulder
            0.73,
            right_arm=replace(fist, to=(0.12, -0.20, 0.9), bend=122.0, elbow=(0.8, -0.7, -0.3)),
        ),
        Key(0.83, right_arm=straight),  # and the fist, which comes a little after its key
        Key(  # it arrives
            0.87,
            place=Place(left=0.030, up=-0.110, ahead=0.195),
            hips=Turn(yaw=23.0, lean=10.0),
            head=Turn(yaw=6.0, lean=10.0, tilt=-4.0),
            left_arm=replace(fist, to=(0.05, -0.05, 0.8), bend=132.0, elbow=(0.5, -1.0, -0.5)),
        ),
        Key(  # and goes on a little
            0.99,
            place=Place(left=0.040, up=-0.112, ahead=0.225),
            hips=Turn(yaw=26.0, lean=11.0),
            chest=Turn(yaw=58.0, lean=15.0, tilt=-4.0),
            head=Turn(yaw=8.0, lean=10.0, tilt=-4.0),
            left_arm=replace(fist, to=(0.08, -0.05, 0.8), bend=134.0, elbow=(0.5, -1.0, -0.6)),
            right_arm=replace(straight, to=(0.03, 0.03, 1.0), bend=10.0),
        ),
        Key(  # the weight is back on the rear foot
            1.22,
            place=Place(left=-0.060, up=-0.055, ahead=0.020),
            hips=Turn(yaw=-12.0, lean=6.0),
            chest=Turn(yaw=-6.0, lean=8.0),
            head=Turn(yaw=-2.0, lean=8.0),
            left_arm=replace(fist, to=(0.02, -0.60, 0.9), bend=88.0, fingers=HOLD),
            right_arm=replace(fist, to=(-0.02, -0.60, 0.8), bend=96.0, fingers=HOLD),
        ),
        at(duration, STAND),
    ]
    left = [
        replace(LEFT_STANCE, leave=0.19, leave_pitch=18.0, roll=0.10),
        replace(
            LEFT_STANCE,
            land=0.40,
            leave=1.18,
            left=0.125,
            ahead=0.32,
            yaw=2.0,
            land_pitch=-8.0,
            flat=0.06,
            leave_pitch=12.0,
            roll=0.10,
            swing=(Via(0.5, 0.055),),
        ),
        replace(LEFT_STANCE, land=1.43, land_pitch=10.0, flat=0.08, swing=(Via(0.5, 0.05),)),
    ]
    right = [
        replace(
            RIGHT_STANCE,
            on_ball=(
                OnBall(0.26, 0.0),
                OnBall(0.41, 8.0, turn=-20.0),
                OnBall(0.63, 6.0, turn=-22.0),
                OnBall(0.87, 44.0, turn=4.0),
                OnBall(0.99, 48.0, turn=8.0),
                OnBall(1.22, 8.0, turn=-4.0),
                OnBall(1.38, 0.0),
            ),
        )
    ]
    return make_clip(
        skeleton,
        "punch",
        keys,
        standing_still(duration),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.41, 0.65, 0.87, 0.99, duration),
    )


def kick(skeleton: Skeleton) -> Clip:
    """Return a front kick with the right leg: knee up, foot out, foot back, down."""
    duration, off, landed = 1.76, 0.42, 1.34
    guard = ArmKey(
        to=(0.10, -0.30, 1.0), bend=104.0, elbow=(0.5, -1.0, -0.2), twist=25.0, fingers=FIST
    )
    low_guard = replace(guard, to=(0.30, -0.75, 0.35), bend=78.0)
    chambered = LegKey(to=(0.06, -0.50, 0.55), bend=118.0, point=-6.0)
    out = LegKey(to=(0.0, -0.26, 1.0), bend=9.0, point=10.0)
    keys = [
        STAND,
        Key(  # weight onto the left leg
            0.30,
            place=Place(left=0.062, up=-0.050, ahead=0.020),
            hips=Turn(yaw=-12.0, lean=6.0, tilt=2.0),
            chest=Turn(yaw=-14.0, lean=9.0),
            head=Turn(yaw=-2.0, lean=7.0),
            left_arm=guard,
            right_arm=replace(guard, to=(0.0, -0.30, 1.0), bend=116.0),
            right_leg=LegKey(to=(0.04, -1.0, -0.16), bend=40.0, point=20.0),
        ),
        Key(  # the knee comes up
            0.60,
            place=Place(left=0.092, up=-0.056, ahead=0.012),
            hips=Turn(yaw=-6.0, lean=-6.0, tilt=4.0),
            chest=Turn(yaw=-8.0, lean=4.0, tilt=-2.0),
            head=Turn(yaw=-1.0, lean=6.0),
            left_arm=guard,
            right_arm=replace(guard, to=(0.10, -0.45, 0.9)),
            right_leg=chambered,
        ),
        Key(0.67, right_leg=replace(chambered, to=(0.05, -0.42, 0.78), bend=112.0)),
        Key(  # the foot arrives
            0.76,
            place=Place(left=0.094, up=-0.034, ahead=0.060),
            hips=Turn(yaw=16.0, lean=-30.0, tilt=4.0),
            chest=Turn(yaw=6.0, lean=-22.0, tilt=-2.0),
            head=Turn(yaw=0.0, lean=4.0),
            left_arm=replace(guard, to=(0.25, -0.50, 0.9), bend=92.0),
            right_arm=replace(low_guard, to=(0.45, -0.90, -0.20), bend=46.0),
            right_leg=out,
        ),
        Key(
            0.86,
            place=Place(left=0.094, up=-0.036, ahead=0.064),
            hips=Turn(yaw=18.0, lean=-31.0, tilt=4.0),
            chest=Turn(yaw=7.0, lean=-23.0, tilt=-2.0),
            head=Turn(yaw=0.0, lean=4.0),
            right_leg=replace(out, to=(0.0, -0.24, 1.0)),
        ),
        Key(  # back at the knee
            1.08,
            place=Place(left=0.092, up=-0.060, ahead=0.020),
            hips=Turn(yaw=-2.0, lean=-6.0, tilt=3.0),
            chest=Turn(yaw=-4.0, lean=4.0, tilt=-1.0),
            head=Turn(yaw=0.0, lean=6.0),
            left_arm=guard,
            right_arm=replace(guard, to=(0.10, -0.45, 0.9)),
            right_leg=replace(chambered, to=(0.06, -0.70, 0.45), bend=104.0),
        ),
        Key(
            1.46,
            place=Place(left=0.030, up=-0.026, ahead=0.004),
            hips=Turn(yaw=-3.0, lean=3.0, tilt=1.0),
            chest=Turn(yaw=-2.0, lean=4.0),
            head=Turn(yaw=0.0, lean=5.0),
            left_arm=ArmKey(to=(0.20, -1.0, 0.26), bend=42.0, fingers=LOOSE),
            right_arm=ArmKey(to=(0.20, -1.0, 0.28), bend=46.0, fingers=LOOSE),
        ),
        at(duration, STAND),
    ]
    right = [
        replace(RIGHT_STANCE, leave=off, leave_pitch=40.0, roll=0.16),
        replace(RIGHT_STANCE, land=landed, land_pitch=20.0, flat=0.10, swing=None),
    ]
    return make_clip(
        skeleton,
        "kick",
        keys,
        standing_still(duration),
        left_foot=[LEFT_STANCE],
        right_foot=right,
        stage_ends_s=(0.30, 0.60, 0.76, 0.86, duration),
    )


def push(skeleton: Skeleton) -> Clip:
    """Return a shove with both hands: palms to something heavy, then the whole body behind it."""
    duration = 2.40
    arm = ArmKey(to=(0.12, -0.10, 1.0), bend=104.0, elbow=(0.8, -1.0, -0.2), fingers=FLAT)

    def palm(up: float, ahead: float, hold: float = 1.0) -> Hand:
        return Hand((0.17, up, ahead), fingers=(-0.15, 1.0, -0.25), palm=(0.0, 0.2, 1.0), hold=hold)

    hanging = Hand((0.2, 0.95, 0.2), fingers=(0.0, -0.3, 1.0), palm=(-1.0, 0.0, 0.2), hold=0.0)

    def both(hand: Hand, at_s: float) -> Key:
        return Key(at_s, left_hand=hand, right_hand=hand)

    keys = [
        STAND,
        both(hanging, 0.08),
        Key(  # a step back with the right foot, hands up
            0.42,
            place=Place(left=0.010, up=-0.070, ahead=-0.015),
            hips=Turn(yaw=-8.0, lean=6.0),
            chest=Turn(yaw=-4.0, lean=6.0),
            head=Turn(lean=6.0),
            left_arm=arm,
            right_arm=arm,
            left_hand=palm(1.26, 0.30),
            right_hand=palm(1.26, 0.30),
        ),
        Key(  # gathers
            0.78,
            place=Place(left=0.000, up=-0.135, ahead=-0.065),
            hips=Turn(yaw=-6.0, lean=12.0),
            chest=Turn(yaw=-2.0, lean=16.0),
            head=Turn(lean=12.0),
            left_hand=palm(1.20, 0.25),
            right_hand=palm(1.20, 0.25),
        ),
        Key(  # shoves: the back leg straightens, then the arms
            1.22,
            place=Place(left=0.010, up=-0.165, ahead=0.225),
            hips=Turn(yaw=4.0, lean=34.0),
            chest=Turn(yaw=2.0, lean=38.0),
            head=Turn(lean=20.0),
            left_hand=palm(1.17, 0.92),
            right_hand=palm(1.17, 0.92),
        ),
        Key(
            1.52,
            place=Place(left=0.012, up=-0.170, ahead=0.250),
            hips=Turn(yaw=5.0, lean=36.0),
            chest=Turn(yaw=3.0, lean=40.0),
            head=Turn(lean=20.0),
            left_hand=palm(1.15, 0.965),
            right_hand=palm(1.15, 0.965),
        ),
        Key(1.78, left_hand=palm(1.16, 0.72, 0.7), right_hand=palm(1.16, 0.72, 0.7)),
        Key(
            2.02,
            place=Place(left=0.030, up=-0.050, ahead=0.050),
            hips=Turn(yaw=-2.0, lean=8.0),
            chest=Turn(yaw=0.0, lean=9.0),
            head=Turn(lean=7.0),
            left_arm=ArmKey(to=(0.20, -1.0, 0.34), bend=34.0),
            right_arm=ArmKey(to=(0.20, -1.0, 0.36), bend=38.0),
            left_hand=hanging,
            right_hand=hanging,
        ),
        at(duration, STAND),
    ]
    left = [
        replace(LEFT_STANCE, leave=0.50, leave_pitch=18.0, roll=0.12),
        replace(
            LEFT_STANCE,
            land=0.74,
            leave=1.74,
            ahead=0.28,
            yaw=2.0,
            land_pitch=-12.0,
            flat=0.08,
            leave_pitch=14.0,
            roll=0.10,
            swing=(Via(0.5, 0.07),),
        ),
        replace(LEFT_STANCE, land=2.00, land_pitch=10.0, flat=0.08, swing=(Via(0.5, 0.05),)),
    ]
    right = [
        replace(RIGHT_STANCE, leave=0.16, leave_pitch=16.0, roll=0.10),
        replace(
            RIGHT_STANCE,
            land=0.40,
            leave=1.98,
            left=-0.115,
            ahead=-0.26,
            yaw=-22.0,
            land_pitch=12.0,
            flat=0.08,
            leave_pitch=16.0,
            roll=0.08,
            on_ball=(
                OnBall(0.80, 0.0),
                OnBall(1.22, 38.0),
                OnBall(1.54, 42.0),
                OnBall(1.84, 0.0),
            ),
            swing=(Via(0.5, 0.05, pitch=8.0),),
        ),
        replace(RIGHT_STANCE, land=2.24, land_pitch=10.0, flat=0.08, swing=(Via(0.5, 0.05),)),
    ]
    return make_clip(
        skeleton,
        "push",
        keys,
        standing_still(duration),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.42, 0.78, 1.22, 1.52, duration),
    )


def slash(skeleton: Skeleton) -> Clip:
    """Return a sword's cut from high on the right to low on the left, with a step."""
    duration = 1.80
    grip = ArmKey(elbow=(1.0, -0.4, -0.4), twist=40.0, flex=0.0, fingers=HOLD)
    balance = ArmKey(to=(0.45, -0.55, 0.35), bend=60.0, elbow=(0.7, -0.4, -0.8), fingers=LOOSE)
    keys = [
        STAND,
        Key(
            0.26,
            place=Place(left=0.0, up=-0.040, ahead=0.02),
            hips=Turn(yaw=-14.0, lean=4.0),
            chest=Turn(yaw=-14.0, lean=6.0),
            head=Turn(yaw=-2.0, lean=6.0),
            left_arm=balance,
            right_arm=replace(grip, to=(0.30, -0.50, 0.85), bend=76.0),
        ),
        Key(  # raised over the right shoulder
            0.58,
            place=Place(left=-0.080, up=-0.048, ahead=-0.040),
            hips=Turn(yaw=-38.0, lean=0.0, tilt=3.0),
            chest=Turn(yaw=-56.0, lean=-6.0, tilt=6.0),
            head=Turn(yaw=-10.0, lean=5.0, tilt=3.0),
            left_arm=replace(balance, to=(0.15, -0.10, 1.0), bend=40.0, follow=0.0),
            right_arm=replace(grip, to=(0.62, 0.72, -0.10), bend=96.0, elbow=(1.0, 0.2, 0.5)),
        ),
        Key(0.72, hips=Turn(yaw=14.0, lean=11.0, tilt=-1.0)),  # the hips first, then the chest
        Key(0.70, chest=Turn(yaw=-10.0, lean=6.0, tilt=-1.0)),
        Key(0.76, chest=Turn(yaw=36.0, lean=22.0, tilt=-7.0)),
        Key(  # then the arm, long at last
            0.70,
            place=Place(left=0.010, up=-0.080, ahead=0.09),
            head=Turn(yaw=0.0, lean=8.0),
            right_arm=replace(grip, to=(0.55, 0.62, 0.62), bend=84.0),
        ),
        Key(0.745, right_arm=replace(grip, to=(-0.02, 0.0, 1.0), bend=70.0)),
        Key(  # through
            0.82,
            place=Place(left=0.050, up=-0.125, ahead=0.195),
            hips=Turn(yaw=32.0, lean=18.0, tilt=-2.0),
            chest=Turn(yaw=54.0, lean=28.0, tilt=-8.0),
            head=Turn(yaw=10.0, lean=14.0, tilt=-3.0),
            left_arm=replace(balance, to=(0.70, -0.50, -0.45), bend=44.0),
            right_arm=replace(grip, to=(-0.42, -0.72, 0.85), bend=14.0),
        ),
        Key(
            1.02,
            place=Place(left=0.056, up=-0.135, ahead=0.205),
            hips=Turn(yaw=38.0, lean=20.0, tilt=-2.0),
            chest=Turn(yaw=66.0, lean=31.0, tilt=-8.0),
            head=Turn(yaw=14.0, lean=14.0, tilt=-3.0),
            left_arm=replace(balance, to=(0.72, -0.52, -0.50), bend=48.0),
            right_arm=replace(grip, to=(-0.66, -0.78, 0.45), bend=24.0),
        ),
        Key(
            1.34,
            place=Place(left=-0.010, up=-0.055, ahead=0.055),
            hips=Turn(yaw=4.0, lean=7.0),
            chest=Turn(yaw=8.0, lean=9.0),
            head=Turn(yaw=1.0, lean=7.0),
            left_arm=ArmKey(to=(0.26, -1.0, 0.12), bend=30.0),
            right_arm=replace(grip, to=(0.05, -0.85, 0.55), bend=42.0, fingers=HOLD),
        ),
        at(duration, STAND),
    ]
    left = [
        replace(LEFT_STANCE, leave=0.48, leave_pitch=18.0, roll=0.12),
        replace(
            LEFT_STANCE,
            land=0.74,
            leave=1.28,
            left=0.11,
            ahead=0.32,
            yaw=4.0,
            land_pitch=-10.0,
            flat=0.07,
            leave_pitch=14.0,
            roll=0.12,
            swing=(Via(0.5, 0.08),),
        ),
        replace(LEFT_STANCE, land=1.58, land_pitch=10.0, flat=0.08, swing=(Via(0.5, 0.05),)),
    ]
    right = [
        replace(
            RIGHT_STANCE,
            on_ball=(
                OnBall(0.60, 0.0),
                OnBall(0.82, 30.0, turn=16.0),
                OnBall(1.02, 34.0, turn=18.0),
                OnBall(1.36, 0.0),
            ),
        )
    ]
    return make_clip(
        skeleton,
        "slash",
        keys,
        standing_still(duration),
        left_foot=left,
        right_foot=right,
        stage_ends_s=(0.26, 0.58, 0.82, 1.02, duration),
    )
