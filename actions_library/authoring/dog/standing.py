"""Standing, sitting down, sitting and getting up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from actions_library.authoring.feet import ALWAYS_S, OnBall, Plant, Via
from actions_library.authoring.gait import standing_plants
from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, on_both_sides, rekeyed
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import standing_still
from actions_library.authoring.waves import Wave
from smd.character.clip import Clip

STAND = on_both_sides(
    key(
        0.0,
        place=Place(up=-0.006),
        body=Turn(),
        spine=Turn(),
        head=Turn(lean=2.0),
        tail=Turn(lean=8.0),
        left_ear=Turn(),
    )
)
SIT = on_both_sides(
    key(
        0.0,
        place=Place(up=-0.155, ahead=-0.015),
        body=Turn(lean=-46.0),
        spine=Turn(lean=6.0),
        head=Turn(lean=-2.0),
        tail=Turn(lean=52.0),
        left_ear=Turn(),
    )
)
HOCKS_DOWN = -70.0
"""Of a hind foot whose heel is on the ground (°)."""

_TUCKED = {"ahead": 0.230, "left": 0.030}
"""How far ahead of rest, and how far out, the hind feet of a sitting dog are (m)."""


def idle(rig: Rig) -> Clip:
    """Breathes, looks to one side and wags a little."""
    end = 4.0
    keys = [
        STAND,
        key(
            0.25,
            place=Place(left=0.006, up=-0.009),
            spine=Turn(lean=-0.8),
            head=Turn(yaw=14.0, lean=0.0),
        ),
        key(0.5, place=Place(up=-0.006), spine=Turn(), head=Turn(yaw=16.0, lean=1.0, tilt=4.0)),
        key(0.75, place=Place(left=-0.005, up=-0.009), spine=Turn(lean=-0.8), head=Turn(lean=3.0)),
        key(0.6, left_ear=Turn(tilt=-8.0), right_ear=Turn(tilt=3.0)),
    ]
    return make_rig_clip(
        rig,
        "idle",
        keys,
        standing_still(end),
        plants=standing_plants(rig),
        waves=[Wave("tail", "yaw", 2.0, tip=6.0, wavelength=2.0, per_cycle=5)],
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def idle_panting(rig: Rig) -> Clip:
    """Pants, the mouth open and the chest quick, and wags; the ears hang."""
    end, breaths = 3.0, 8
    keys = [
        RigKey(0.0, {**STAND.parts, "head": Turn(lean=-6.0), "jaw": Turn(lean=19.0)}),
        key(0.35, place=Place(left=0.005, up=-0.009), head=Turn(yaw=6.0, lean=-8.0)),
        key(0.70, place=Place(left=-0.004, up=-0.008), head=Turn(yaw=-5.0, lean=-4.0)),
        on_both_sides(key(0.5, left_ear=Turn(lean=5.0, tilt=-2.0))),
    ]
    return make_rig_clip(
        rig,
        "idle_panting",
        keys,
        standing_still(end),
        plants=standing_plants(rig),
        waves=[
            Wave("jaw", "lean", 3.0, per_cycle=breaths),
            Wave("spine", "lean", 0.35, wavelength=float("inf"), per_cycle=breaths, phase=0.25),
            Wave("left_ear", "tilt", 1.2, per_cycle=breaths),
            Wave("right_ear", "tilt", -1.2, per_cycle=breaths),
            Wave("tail", "yaw", 4.0, tip=9.0, wavelength=2.0, per_cycle=9),
        ],
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def idle_looking(rig: Rig) -> Clip:
    """Listens to one side and to the other, the ears up, the tail still but for its tip."""
    end = 4.0
    keys = [
        STAND,
        key(0.12, head=Turn(yaw=-34.0, lean=-6.0), spine=Turn(yaw=-4.0)),
        on_both_sides(key(0.15, left_ear=Turn(lean=-4.0, tilt=16.0))),
        key(0.34, head=Turn(yaw=-36.0, lean=-5.0, tilt=-12.0), spine=Turn(yaw=-4.0)),
        key(0.38, place=Place(left=-0.006, up=-0.009), left_ear=Turn(tilt=4.0)),
        key(0.54, head=Turn(yaw=38.0, lean=-8.0), spine=Turn(yaw=5.0), right_ear=Turn(tilt=-18.0)),
        key(0.60, left_ear=Turn(lean=-4.0, tilt=18.0)),
        key(0.78, head=Turn(yaw=40.0, lean=-6.0, tilt=9.0), spine=Turn(yaw=5.0)),
        key(0.80, place=Place(left=0.006, up=-0.010), right_ear=Turn(tilt=-6.0)),
        key(0.5, tail=Turn(lean=20.0)),
    ]
    return make_rig_clip(
        rig,
        "idle_looking",
        keys,
        standing_still(end),
        plants=standing_plants(rig),
        waves=[Wave("tail", "yaw", 0.5, tip=3.0, wavelength=1.5, per_cycle=4)],
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def sit_down(rig: Rig) -> Clip:
    """The hind feet step under, the rump goes down between the hocks; the fore feet stay."""
    end = 1.7
    keys = [
        STAND,
        rekeyed(0.20, STAND),
        key(0.50, place=Place(up=-0.02), head=Turn(lean=12.0), tail=Turn(lean=20.0)),
        on_both_sides(key(0.75, left_ear=Turn(lean=10.0, tilt=6.0))),
        rekeyed(1.15, SIT),
        rekeyed(end, SIT),
    ]
    plants = standing_plants(rig)
    for leg, start in (("left_hind", 0.25), ("right_hind", 0.45)):
        down = (OnBall(start + 0.25, 0.0), OnBall(1.15, HOCKS_DOWN))
        first = replace(plants[leg][0], leave=start, leave_pitch=20.0)
        plants[leg] = [first, tucked(plants[leg][0], start + 0.22, ALWAYS_S, down)]
    return in_place(rig, "sit_down", keys, plants, (0.20, 0.5, 1.15, 1.35, end))


def stand_up(rig: Rig) -> Clip:
    """From sitting to standing: the rump rises, then the hind feet step back."""
    end = 1.6
    keys = [
        SIT,
        rekeyed(0.15, SIT),
        key(0.35, head=Turn(lean=14.0)),
        on_both_sides(key(0.6, left_ear=Turn(lean=12.0, tilt=6.0))),
        rekeyed(1.05, STAND),
        rekeyed(end, STAND),
    ]
    plants = standing_plants(rig)
    for leg, start in (("right_hind", 0.72), ("left_hind", 0.92)):
        up = (OnBall(0.15, HOCKS_DOWN), OnBall(start - 0.05, 0.0))
        last = replace(plants[leg][0], land=start + 0.22, swing=(Via(0.5, 0.04),))
        plants[leg] = [tucked(plants[leg][0], -ALWAYS_S, start, up), last]
    return in_place(rig, "stand_up", keys, plants, (0.15, 0.35, 1.15, 1.3, end))


def idle_sitting(rig: Rig) -> Clip:
    """Sits, breathes, wags over the ground and looks about."""
    end = 4.0
    keys = [
        SIT,
        key(0.3, spine=Turn(lean=4.5), head=Turn(yaw=-12.0, lean=-4.0)),
        key(0.55, spine=Turn(lean=6.0), head=Turn(yaw=-14.0, lean=-2.0, tilt=-5.0)),
        key(0.8, spine=Turn(lean=4.5), head=Turn(lean=-3.0)),
        key(0.35, left_ear=Turn(tilt=3.0), right_ear=Turn(tilt=-12.0)),
    ]
    plants = standing_plants(rig)
    for leg in ("left_hind", "right_hind"):
        still = (OnBall(-1.0, HOCKS_DOWN), OnBall(end + 1.0, HOCKS_DOWN))
        plants[leg] = [tucked(plants[leg][0], -ALWAYS_S, ALWAYS_S, still)]
    return make_rig_clip(
        rig,
        "idle_sitting",
        keys,
        standing_still(end),
        plants=plants,
        waves=[Wave("tail", "yaw", 3.0, tip=9.0, wavelength=2.0, per_cycle=6)],
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def tucked(plant: Plant, land: float, leave: float, rolling: tuple[OnBall, ...]) -> Plant:
    """Return a hind foot's stand under the body of a dog that sits."""
    out = _TUCKED["left"] if plant.left > 0.0 else -_TUCKED["left"]
    return replace(
        plant,
        land=land,
        leave=leave,
        left=plant.left + out,
        ahead=plant.ahead + _TUCKED["ahead"],
        on_ball=rolling,
        swing=(Via(0.5, 0.04, pitch=12.0),),
    )


def in_place(
    rig: Rig,
    name: str,
    keys: Sequence[RigKey],
    plants: dict[str, list[Plant]],
    stage_ends_s: tuple[float, ...],
    waves: Sequence[Wave] = (),
) -> Clip:
    """Return a clip that plays once on the spot."""
    return make_rig_clip(
        rig,
        name,
        keys,
        standing_still(stage_ends_s[-1]),
        plants=plants,
        waves=waves,
        stage_ends_s=stage_ends_s,
    )
