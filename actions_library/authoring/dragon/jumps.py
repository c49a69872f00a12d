"""The dragon leaves the ground: a jump that two beats of its wings carry, and a happy hop."""

from __future__ import annotations

from dataclasses import replace

from actions_library.authoring.dragon.gaits import blink, folded
from actions_library.authoring.dragon.standing import STAND
from actions_library.authoring.dragon.wings import wing_pose
from actions_library.authoring.feet import ALWAYS_S, Plant, Via
from actions_library.authoring.gait import standing_plants
from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import moved_in_one_go, standing_still
from smd.character.clip import Clip


def jump(rig: Rig) -> Clip:
    """Crouches with wings raised, takes off on their beat, glides and lands on its hind feet."""
    end, far = 2.7, 1.3
    keys = [
        STAND,
        key(  # crouched, wings up and open
            0.62,
            place=Place(up=-0.120, ahead=-0.050),
            body=Turn(lean=-3.0),
            neck=Turn(lean=30.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=8.0),
            **wing_pose(0.25, raised=64.0, twisted=-8.0),
        ),
        key(0.78, place=Place(up=0.0, ahead=0.06), **wing_pose(0.0, raised=34.0, twisted=12.0)),
        key(  # off, the wings strike down
            0.95,
            place=Place(up=0.190, ahead=0.27),
            body=Turn(lean=-24.0),
            neck=Turn(lean=40.0),
            head=Turn(lean=-2.0),
            tail=Turn(lean=30.0),
            jaw_open=0.25,
            brow_raise=0.5,
            **wing_pose(0.0, raised=-36.0, twisted=10.0),
        ),
        key(  # at the top
            1.18,
            place=Place(up=0.350, ahead=0.62),
            body=Turn(lean=-8.0),
            neck=Turn(lean=36.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=-6.0),
            **wing_pose(0.20, raised=34.0),
        ),
        key(1.38, place=Place(up=0.260, ahead=0.92), **wing_pose(0.0, raised=16.0)),
        key(  # brakes: body up, wings ahead
            1.56,
            place=Place(up=0.075, ahead=1.16),
            body=Turn(lean=-14.0),
            neck=Turn(lean=28.0),
            head=Turn(lean=10.0),
            tail=Turn(lean=14.0),
            jaw_open=0.1,
            **wing_pose(0.0, raised=14.0, twisted=-24.0, swept=-12.0),
        ),
        key(  # the legs give
            1.80,
            place=Place(up=-0.095, ahead=far - 0.01),
            body=Turn(lean=4.0),
            neck=Turn(lean=22.0),
            head=Turn(lean=12.0),
            tail=Turn(lean=-10.0),
            brow_raise=0.0,
            jaw_open=0.0,
            **folded(raised=8.0, opened=0.35),
        ),
        *blink(1.9, 1.0),
        replace(_moved_on(far), at=end - 0.40),
    ]
    plants = {}
    for leg, stands in standing_plants(rig).items():
        hind = leg.endswith("hind")
        off, on = (0.84, 1.60) if hind else (0.72, 1.68)
        rest = stands[0]
        plants[leg] = _hopped(rest, off, on, far, up=0.24 if hind else 0.34)
    course = moved_in_one_go(end, 0.72, 1.72, ahead=far)
    return make_rig_clip(
        rig, "jump", keys, course, plants=plants, stage_ends_s=(0.15, 0.62, 1.56, 1.85, end)
    )


def hop(rig: Rig) -> Clip:
    """Happy: two hops on the spot, wings fluttering, head and tail up, the mouth open."""
    end = 2.6
    glad = {"jaw_open": 0.45, "brow_raise": 0.8}
    keys = [STAND]
    for start in (0.0, 0.75):
        keys += [
            key(
                start + 0.32,
                place=Place(up=-0.080),
                body=Turn(lean=2.0),
                neck=Turn(lean=14.0),
                head=Turn(lean=8.0),
                tail=Turn(lean=8.0),
                **folded(raised=16.0, opened=0.35),
                **glad,
            ),
            key(
                start + 0.66,
                place=Place(up=0.110),
                body=Turn(lean=-5.0),
                neck=Turn(lean=-8.0),
                head=Turn(yaw=8.0 if start else -8.0, lean=-8.0, tilt=8.0 if start else -8.0),
                tail=Turn(yaw=20.0 if start else -20.0, lean=26.0),
                crest_raise=0.8,
                **wing_pose(0.40, raised=20.0),
                **glad,
            ),
            key(start + 0.48, place=Place(up=0.004)),
            key(start + 0.84, place=Place(up=0.0)),
        ]
    keys += [
        key(
            1.78,
            place=Place(up=-0.070),
            neck=Turn(lean=10.0),
            head=Turn(lean=6.0),
            tail=Turn(lean=4.0),
            **folded(raised=6.0, opened=0.15),
        ),
        *blink(1.05, 1.0),
        replace(STAND, at=end - 0.40),
    ]
    plants = {}
    for leg, stands in standing_plants(rig).items():
        late = 0.03 if leg.endswith("hind") else 0.0
        rest, stood = stands[0], []
        land = -ALWAYS_S
        for leave, on in ((0.48, 0.84), (1.23, 1.59)):
            up = (Via(0.5, 0.12),)
            stood.append(replace(rest, land=land, leave=leave + late, leave_pitch=16.0, roll=0.1))
            stood[-1] = replace(stood[-1], swing=up, flat=0.06)
            land = on + late
        stood.append(replace(rest, land=land, leave=ALWAYS_S, swing=(Via(0.5, 0.12),), flat=0.06))
        plants[leg] = stood
    return make_rig_clip(
        rig,
        "hop",
        keys,
        standing_still(end),
        plants=plants,
        stage_ends_s=(0.1, 0.4, 1.62, 1.8, end),
    )


def _moved_on(far: float) -> RigKey:
    """Return standing, so far ahead."""
    return replace(STAND, parts={**STAND.parts, "place": Place(up=-0.010, ahead=far)})


def _hopped(rest: Plant, off: float, on: float, far: float, *, up: float) -> list[Plant]:
    first = replace(rest, leave=off, leave_pitch=34.0, roll=0.16)
    swing = (Via(0.25, 0.7 * up, pitch=50.0), Via(0.6, up, pitch=40.0), Via(0.85, 0.4 * up))
    return [first, replace(rest, land=on, ahead=rest.ahead + far, swing=swing, flat=0.06)]
