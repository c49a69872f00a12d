"""Walk, trot and gallop of the dog, a cycle each, in any mood."""

from __future__ import annotations

from collections.abc import Sequence

from actions_library.authoring.dog.moods import PLAIN, Mood
from actions_library.authoring.gait import (
    LATERAL_WALK,
    ROTARY_GALLOP,
    TROT,
    GaitDiagram,
    Step,
    gait_plants,
)
from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, whole_cycle
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import steady_travel
from smd.character.clip import Clip

_FORE = ("left_fore", "right_fore")


def walk(rig: Rig, mood: Mood = PLAIN) -> Clip:
    """Each hind foot before the fore foot of its side; three feet or two are down."""
    fore = Step(
        duty=0.62,
        lift=0.055,
        land_pitch=-18.0,
        leave_pitch=64.0,
        roll=0.6,
        fold=62.0,
        toes=12.0,
        ahead=0.018,
        inward=0.012,
    )
    hind = Step(
        duty=0.64,
        lift=0.050,
        land_pitch=-16.0,
        leave_pitch=38.0,
        fold=46.0,
        toes=12.0,
        ahead=0.000,
        inward=0.012,
    )
    half = [
        key(  # the left hind foot lands
            0.0,
            place=Place(left=-0.004, up=-0.024),
            body=Turn(yaw=-3.0, lean=1.0, tilt=1.5),
            spine=Turn(yaw=5.0, tilt=-2.0),
            head=Turn(yaw=0.5, lean=4.0),
            tail=Turn(yaw=9.0, lean=-4.0),
            left_ear=Turn(tilt=3.0),
            right_ear=Turn(tilt=3.0),
        ),
        key(  # the left fore foot lands
            0.25,
            place=Place(left=0.006, up=-0.028),
            body=Turn(yaw=0.0, lean=-0.5, tilt=1.0),
            spine=Turn(yaw=0.0, tilt=-2.0),
            head=Turn(yaw=1.0, lean=7.0),
            left_ear=Turn(tilt=-3.0),
            right_ear=Turn(tilt=-3.0),
        ),
    ]
    gait = GaitDiagram(66 / 60, 0.64, LATERAL_WALK, hind, dict.fromkeys(_FORE, fore))
    return _gait(rig, "walk", gait, whole_cycle(half), mood)


def trot(rig: Rig, mood: Mood = PLAIN) -> Clip:
    """Diagonal pairs, with a short flight after each; the back is level, the tail up."""
    fore = Step(
        duty=0.42,
        lift=0.085,
        land_pitch=-16.0,
        leave_pitch=66.0,
        roll=0.65,
        fold=78.0,
        toes=12.0,
        ahead=0.032,
        inward=0.018,
    )
    hind = Step(
        duty=0.42,
        lift=0.065,
        land_pitch=-12.0,
        leave_pitch=42.0,
        fold=52.0,
        toes=12.0,
        ahead=-0.01,
        inward=0.018,
    )
    half = [
        key(  # left hind and right fore feet land
            0.0,
            place=Place(up=-0.022),
            body=Turn(yaw=-2.0, tilt=1.5),
            spine=Turn(yaw=4.0, tilt=-2.0),
            head=Turn(lean=2.0),
            tail=Turn(yaw=4.0, lean=-14.0),
            left_ear=Turn(tilt=10.0),
            right_ear=Turn(tilt=-10.0),
        ),
        key(  # and bear
            0.18,
            place=Place(left=0.003, up=-0.040),
            body=Turn(lean=0.5),
            head=Turn(lean=5.0),
            tail=Turn(lean=-6.0),
            left_ear=Turn(tilt=-8.0),
            right_ear=Turn(tilt=8.0),
        ),
        key(0.42, place=Place(up=-0.012), head=Turn(lean=2.0)),
    ]
    gait = GaitDiagram(30 / 60, 1.0, TROT, hind, dict.fromkeys(_FORE, fore))
    return _gait(rig, "trot", gait, whole_cycle(half), mood)


def gallop(rig: Rig, mood: Mood = PLAIN) -> Clip:
    """The back bends and stretches; two flights a cycle, gathered and stretched out."""
    fore = Step(
        duty=0.20,
        lift=0.15,
        land_pitch=-20.0,
        leave_pitch=56.0,
        roll=0.85,
        fold=78.0,
        toes=12.0,
        ahead=0.02,
        inward=0.03,
    )
    hind = Step(
        duty=0.20,
        lift=0.13,
        land_pitch=-14.0,
        leave_pitch=44.0,
        roll=0.85,
        fold=70.0,
        toes=12.0,
        ahead=0.02,
        inward=0.02,
    )
    keys = [
        key(  # the hind feet land far under the body, the back bent
            0.0,
            place=Place(up=-0.045, ahead=0.01),
            body=Turn(lean=-9.0),
            spine=Turn(lean=20.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=-8.0),
            left_ear=Turn(lean=-4.0, tilt=14.0),
            right_ear=Turn(lean=-4.0, tilt=-14.0),
        ),
        key(  # they push, the back stretches
            0.26,
            place=Place(up=-0.020),
            body=Turn(lean=-3.0),
            spine=Turn(lean=-6.0),
            head=Turn(lean=4.0),
            tail=Turn(lean=10.0),
        ),
        key(  # the fore feet land
            0.44,
            place=Place(up=-0.030),
            body=Turn(lean=4.0),
            spine=Turn(lean=-6.0),
            head=Turn(lean=8.0),
            left_ear=Turn(lean=-30.0, tilt=26.0),
            right_ear=Turn(lean=-30.0, tilt=-26.0),
        ),
        key(0.60, place=Place(up=-0.052), body=Turn(lean=7.0), head=Turn(lean=10.0)),
        key(  # gathered in the air
            0.86,
            place=Place(up=-0.004),
            body=Turn(lean=-2.0),
            spine=Turn(lean=22.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=-6.0),
        ),
    ]
    gait = GaitDiagram(28 / 60, 1.9, ROTARY_GALLOP, hind, dict.fromkeys(_FORE, fore))
    return _gait(rig, "run", gait, keys, mood)


def _gait(rig: Rig, name: str, plain: GaitDiagram, keys: Sequence[RigKey], mood: Mood) -> Clip:
    gait = mood.gait(plain)
    end = gait.period_s
    return make_rig_clip(
        rig,
        mood.named(name),
        mood.keys(keys),
        steady_travel(end, ahead=gait.stride_m),
        plants=gait_plants(rig, gait),
        waves=mood.waves(end),
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )
