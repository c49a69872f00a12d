"""Walk and run of the dragon on its feet, and its flight, a cycle each."""

from __future__ import annotations

from actions_library.authoring.dragon.wings import wing_pose
from actions_library.authoring.gait import (
    LATERAL_WALK,
    ROTARY_GALLOP,
    GaitDiagram,
    Step,
    gait_plants,
)
from actions_library.authoring.keys import LegKey, Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import Part, RigKey, key, whole_cycle
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import steady_travel
from actions_library.authoring.waves import Wave
from smd.character.clip import Clip

_FORE = ("left_fore", "right_fore")

FOLDED_DEG = 50.0
"""How far the plane of folded wings is raised."""


def folded(*, raised: float = 0.0, opened: float = 0.0) -> dict[str, Part]:
    """Return wings folded over the back, a little higher or opened."""
    return wing_pose(1.0 - opened, raised=FOLDED_DEG + raised)


def tucked(back: float = 0.0) -> dict[str, Part]:
    """Return all legs folded below the body, as in flight; ``back`` stretches the hind ones (°)."""
    hind = LegKey(
        to=(0.08, -0.55, -0.75), bend=62.0 - back, knee=(0.25, -0.4, 1.0), point=42.0 + 0.3 * back
    )
    fore = LegKey(to=(0.10, -0.80, -0.32), bend=92.0, knee=(0.2, -0.4, -1.0), point=38.0)
    return {
        f"{side}_{name}": leg
        for side in ("left", "right")
        for name, leg in (("hind", hind), ("fore", fore))
    }


def walk(rig: Rig) -> Clip:
    """Each hind foot before the fore foot of its side; neck and tail sway against each other."""
    fore = Step(
        duty=0.64,
        lift=0.060,
        land_pitch=-18.0,
        leave_pitch=60.0,
        roll=0.6,
        fold=60.0,
        toes=12.0,
        ahead=0.014,
        inward=0.016,
    )
    hind = Step(
        duty=0.66,
        lift=0.055,
        land_pitch=-16.0,
        leave_pitch=36.0,
        fold=44.0,
        toes=12.0,
        inward=0.016,
    )
    half = [
        key(
            0.0,
            place=Place(left=-0.008, up=-0.030),
            body=Turn(yaw=-3.5, lean=1.0, tilt=2.5),
            spine=Turn(yaw=7.0, tilt=-3.0),
            neck=Turn(yaw=-5.0, lean=5.0),
            head=Turn(yaw=1.0, lean=5.0),
            **folded(raised=2.0),
        ),
        key(
            0.25,
            place=Place(left=0.008, up=-0.035),
            body=Turn(yaw=0.0, lean=-0.5, tilt=1.5),
            spine=Turn(yaw=0.0, tilt=-2.0),
            neck=Turn(yaw=2.0, lean=8.0),
            head=Turn(yaw=1.5, lean=8.0),
            **folded(raised=-2.0),
        ),
    ]
    gait = GaitDiagram(74 / 60, 0.62, LATERAL_WALK, hind, dict.fromkeys(_FORE, fore))
    keys = [*whole_cycle(half), *blink(0.62, 60 / 74)]
    waves = [Wave("tail", "yaw", 4.0, tip=9.0, wavelength=1.4, phase=0.15)]
    return _gait(rig, "walk", gait, keys, waves)


def run(rig: Rig) -> Clip:
    """A gallop with the neck stretched, wings half open for balance."""
    fore = Step(
        duty=0.21,
        lift=0.14,
        land_pitch=-20.0,
        leave_pitch=56.0,
        roll=0.85,
        fold=76.0,
        toes=12.0,
        ahead=0.02,
        inward=0.04,
    )
    hind = Step(
        duty=0.21,
        lift=0.12,
        land_pitch=-14.0,
        leave_pitch=44.0,
        roll=0.85,
        fold=68.0,
        toes=12.0,
        ahead=0.02,
        inward=0.03,
    )
    keys = [
        key(  # the hind feet land far under the body, the back bent
            0.0,
            place=Place(up=-0.050, ahead=0.01),
            body=Turn(lean=-9.0),
            spine=Turn(lean=20.0),
            neck=Turn(lean=26.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=-26.0),
            jaw_open=0.10,
            **folded(raised=8.0, opened=0.22),
        ),
        key(  # they push, the back stretches
            0.26,
            place=Place(up=-0.024),
            body=Turn(lean=-3.0),
            spine=Turn(lean=-6.0),
            neck=Turn(lean=42.0),
            head=Turn(lean=4.0),
            tail=Turn(lean=4.0),
        ),
        key(  # the fore feet land
            0.44,
            place=Place(up=-0.034),
            body=Turn(lean=4.0),
            spine=Turn(lean=-6.0),
            neck=Turn(lean=34.0),
            head=Turn(lean=9.0),
            jaw_open=0.22,
            **folded(raised=-8.0, opened=0.12),
        ),
        key(
            0.60,
            place=Place(up=-0.055),
            body=Turn(lean=7.0),
            neck=Turn(lean=24.0),
            head=Turn(lean=10.0),
            tail=Turn(lean=16.0),
        ),
        key(  # gathered in the air
            0.86,
            place=Place(up=-0.008),
            body=Turn(lean=-2.0),
            spine=Turn(lean=22.0),
            neck=Turn(lean=20.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=-10.0),
        ),
    ]
    gait = GaitDiagram(30 / 60, 1.85, ROTARY_GALLOP, hind, dict.fromkeys(_FORE, fore))
    return _gait(rig, "run", gait, keys)


def fly(rig: Rig) -> Clip:
    """Wings beat: spread and down in one sweep, half folded on their way up; the body answers."""
    end = 52 / 60
    keys = [
        key(  # wings up and wide
            0.0,
            place=Place(up=0.455),
            body=Turn(lean=-4.0),
            neck=Turn(lean=34.0),
            head=Turn(lean=4.0),
            **wing_pose(0.06, raised=48.0, twisted=-6.0),
            **tucked(),
        ),
        key(0.22, **wing_pose(0.0, raised=6.0, twisted=16.0, swept=-8.0)),
        key(  # down: the body has been thrown up
            0.45,
            place=Place(up=0.515),
            body=Turn(lean=3.0),
            neck=Turn(lean=28.0),
            head=Turn(lean=7.0),
            **wing_pose(0.02, raised=-34.0, twisted=8.0, swept=-6.0),
            **tucked(14.0),
        ),
        key(0.72, **wing_pose(0.34, raised=4.0, twisted=-16.0, swept=6.0)),
    ]
    return make_rig_clip(
        rig,
        "fly",
        keys,
        steady_travel(end, ahead=2.2),
        waves=[Wave("tail", "lean", 2.5, tip=7.0, wavelength=1.2, phase=0.45)],
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def blink(at: float, unit: float) -> list[RigKey]:
    """Return keys of a blink that is closed at a time; ``unit`` is a second in the keys' time."""
    times = ((-0.10, 0.0), (-0.02, 1.0), (0.03, 1.0), (0.18, 0.0))
    return [key(at + dt * unit, left_blink=w, right_blink=w) for dt, w in times]


def _gait(
    rig: Rig, name: str, gait: GaitDiagram, keys: list[RigKey], waves: list[Wave] | None = None
) -> Clip:
    end = gait.period_s
    return make_rig_clip(
        rig,
        name,
        keys,
        steady_travel(end, ahead=gait.stride_m),
        plants=gait_plants(rig, gait),
        waves=waves or (),
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )
