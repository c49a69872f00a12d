"""The caterpillar on the spot: idle, a look around, a crouch; and a jump."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from actions_library.authoring.caterpillar.skeleton import PAIRS, TRUE_LEGS, legs_of_pair
from actions_library.authoring.caterpillar.trunk import VIAS, bent_spine_m, carried_swing, followed
from actions_library.authoring.feet import ALWAYS_S, Plant, Via
from actions_library.authoring.gait import standing_plants
from actions_library.authoring.keys import LegKey, Place, Turn
from actions_library.authoring.posing import RATE_HZ, RootCourse
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, on_both_sides
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import moved_in_one_go, standing_still
from smd.character.clip import Clip

_TUCKED = LegKey(to=(0.20, -0.9, 0.35), bend=112.0, knee=(1.0, 0.2, 0.0))
_FEELERS = on_both_sides(key(0.0, left_feeler=Turn()))


def idle(rig: Rig) -> Clip:
    """Breathes, sways its front a little, feels about."""
    end = 2.0
    spine = [
        key(0.0, breast=Turn(), neck=Turn(yaw=-3.0, lean=-3.0), length=1.0, place=Place()),
        key(0.5, breast=Turn(lean=1.0), neck=Turn(yaw=5.0, lean=-7.0), length=0.985),
        key(0.5, place=Place(up=0.004)),
    ]
    keys = [
        key(0.0, head=Turn(yaw=-6.0, lean=4.0)),
        key(0.45, head=Turn(yaw=10.0, lean=0.0, tilt=3.0)),
        key(0.7, head=Turn(yaw=8.0, lean=5.0)),
        key(0.10, left_feeler=Turn(lean=10.0), right_feeler=Turn(lean=-8.0, tilt=6.0)),
        key(0.35, left_feeler=Turn(lean=-12.0, tilt=-8.0), right_feeler=Turn(lean=9.0)),
        key(0.70, left_feeler=Turn(lean=8.0), right_feeler=Turn(lean=-4.0, tilt=4.0)),
    ]
    ground = standing_still(end)
    return make_rig_clip(
        rig,
        "idle",
        keys,
        ground,
        plants=standing_plants(rig),
        laid={"spine": bent_spine_m(spine, ground, cyclic=True)},
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def look(rig: Rig) -> Clip:
    """Raises its front with the legs of the thorax, looks to both sides, comes down."""
    end = 1.7
    spine = [
        key(0.0, middle=Turn(), breast=Turn(), neck=Turn(), length=1.0),
        key(0.12, breast=Turn(lean=5.0), neck=Turn(lean=8.0), length=0.97),
        key(0.50, middle=Turn(lean=-3.0), breast=Turn(lean=-46.0), neck=Turn(lean=-74.0)),
        key(0.72, breast=Turn(yaw=16.0, lean=-46.0), neck=Turn(yaw=34.0, lean=-66.0), length=1.0),
        key(1.08, breast=Turn(yaw=-16.0, lean=-46.0), neck=Turn(yaw=-34.0, lean=-66.0)),
        key(1.22, middle=Turn(lean=-3.0), breast=Turn(lean=-40.0), neck=Turn(lean=-54.0)),
        key(1.52, middle=Turn(), breast=Turn(), neck=Turn(lean=4.0)),
        key(end, breast=Turn(), neck=Turn()),
    ]
    keys = [
        key(0.0, head=Turn(lean=3.0)),
        key(0.12, head=Turn(lean=12.0)),
        key(0.50, head=Turn(lean=-8.0)),
        key(0.72, head=Turn(yaw=48.0, lean=-2.0, tilt=-8.0)),
        key(1.08, head=Turn(yaw=-48.0, lean=-2.0, tilt=8.0)),
        key(1.35, head=Turn(lean=8.0)),
        key(end, head=Turn(lean=3.0)),
        _FEELERS,
        on_both_sides(key(0.5, left_feeler=Turn(lean=-16.0, tilt=-10.0))),
        on_both_sides(key(0.9, left_feeler=Turn(lean=10.0, tilt=6.0))),
        on_both_sides(key(end, left_feeler=Turn())),
        *_legs(TRUE_LEGS, _TUCKED),
    ]
    plants = standing_plants(rig)
    for i, k in enumerate(reversed(TRUE_LEGS)):  # the foremost first, and last to come down
        leave, land = 0.18 + 0.04 * i, 1.54 - 0.04 * i
        for leg in legs_of_pair(k):
            plants[leg] = _let_go(plants[leg][0], leave, land)
    return _once(rig, "look", keys, spine, plants, standing_still(end), (0.12, 0.5, 1.2, 1.5, end))


def crouch(rig: Rig) -> Clip:
    """Draws itself together, down on its belly, the head tucked; and comes up again."""
    end = 1.1
    up = key(0.0, tail=Turn(), loin=Turn(), breast=Turn(), neck=Turn(), length=1.0, place=Place())
    down = key(
        0.45,
        tail=Turn(lean=-6.0),
        loin=Turn(lean=3.0),
        breast=Turn(lean=-4.0),
        neck=Turn(lean=14.0),
        length=0.88,
        place=Place(up=-0.030),
    )
    spine = [up, down, replace(down, at=0.65), replace(up, at=1.02)]
    keys = [
        key(0.0, head=Turn(lean=3.0)),
        key(0.47, head=Turn(lean=24.0)),
        key(0.67, head=Turn(lean=24.0)),
        key(end, head=Turn(lean=3.0)),
        _FEELERS,
        on_both_sides(key(0.47, left_feeler=Turn(lean=-46.0))),
        on_both_sides(key(0.70, left_feeler=Turn(lean=-44.0))),
        on_both_sides(key(end, left_feeler=Turn())),
    ]
    ground, plants = standing_still(end), standing_plants(rig)
    return _once(rig, "crouch", keys, spine, plants, ground, (0.1, 0.2, 0.65, 0.95, end))


def jump(rig: Rig) -> Clip:
    """Shortens like a spring and lets go: leaves the ground stretched, lands front feet first."""
    end, way_m = 1.2, 0.40
    rest = key(
        0.0,
        tail=Turn(),
        loin=Turn(),
        middle=Turn(),
        breast=Turn(),
        neck=Turn(),
        length=1.0,
        place=Place(),
    )
    spine = [
        rest,
        key(
            0.32,
            tail=Turn(lean=-1.0),
            loin=Turn(lean=-4.0),
            breast=Turn(lean=4.0),
            neck=Turn(lean=9.0),
            length=0.91,
            place=Place(up=-0.012),
        ),
        key(
            0.44,
            tail=Turn(lean=-2.0),
            loin=Turn(lean=-6.0),
            middle=Turn(lean=-10.0),
            breast=Turn(lean=-18.0),
            neck=Turn(lean=-20.0),
            length=1.02,
            place=Place(up=0.052),
        ),
        key(0.52, place=Place(up=0.150)),
        key(
            0.60,
            tail=Turn(lean=-26.0),
            loin=Turn(lean=-16.0),
            middle=Turn(),
            breast=Turn(lean=14.0),
            neck=Turn(lean=18.0),
            length=0.96,
            place=Place(up=0.190),
        ),
        key(0.68, place=Place(up=0.150)),
        key(
            0.77,
            tail=Turn(lean=8.0),
            loin=Turn(lean=7.0),
            middle=Turn(lean=7.0),
            breast=Turn(lean=4.0),
            neck=Turn(lean=-4.0),
            place=Place(up=0.052),
        ),
        key(
            0.90,
            tail=Turn(lean=-3.0),
            loin=Turn(),
            middle=Turn(),
            breast=Turn(lean=-2.0),
            neck=Turn(lean=8.0),
            length=0.91,
            place=Place(up=-0.020),
        ),
        replace(rest, at=1.12),
    ]
    keys = [
        key(0.0, head=Turn(lean=3.0)),
        key(0.32, head=Turn(lean=10.0)),
        key(0.46, head=Turn(lean=-14.0)),
        key(0.70, head=Turn(lean=12.0)),
        key(0.92, head=Turn(lean=14.0)),
        key(end, head=Turn(lean=3.0)),
        _FEELERS,
        on_both_sides(key(0.34, left_feeler=Turn(lean=-24.0))),
        on_both_sides(key(0.50, left_feeler=Turn(lean=-40.0))),
        on_both_sides(key(0.74, left_feeler=Turn(lean=20.0, tilt=-10.0))),
        on_both_sides(key(end, left_feeler=Turn())),
    ]
    ground = moved_in_one_go(end, 0.36, 0.88, ahead=way_m)
    spine_m, plants = bent_spine_m(spine, ground), standing_plants(rig)
    for i, k in enumerate(PAIRS):
        front = i / (len(PAIRS) - 1.0)
        leave, land = 0.41 - 0.08 * front, 0.86 - 0.06 * front
        frames = np.round((leave + np.array(VIAS) * (land - leave)) * RATE_HZ).astype(int)
        for leg in legs_of_pair(k):
            stood = plants[leg][0]
            carried = spine_m[frames, k - 1 : k + 1]
            swing = carried_swing(rig, leg, k, carried, stood.ahead, way_m)
            plants[leg] = _let_go(stood, leave, land, way_m, swing)
    return _once(rig, "jump", keys, spine, plants, ground, (0.10, 0.34, 0.88, 1.05, end))


def _legs(pairs: Iterable[int], how: LegKey) -> list[RigKey]:
    """Return keys of how legs hang when they touch nothing."""
    return [key(0.0, **{leg: how}) for k in pairs for leg in legs_of_pair(k)]


def _let_go(
    plant: Plant,
    leave: float,
    land: float,
    ahead: float = 0.0,
    swing: tuple[Via, ...] | None = None,
) -> list[Plant]:
    """Return the stands of a foot that lets go, and takes hold again so far ahead."""
    again = replace(plant, land=land, leave=ALWAYS_S, ahead=plant.ahead + ahead, swing=swing)
    return [replace(plant, leave=leave), again]


def _once(
    rig: Rig,
    name: str,
    keys: Sequence[RigKey],
    spine: Sequence[RigKey],
    plants: dict[str, list[Plant]],
    ground: RootCourse,
    stage_ends_s: tuple[float, ...],
) -> Clip:
    spine_m = bent_spine_m(spine, ground)
    return make_rig_clip(
        rig,
        name,
        [*keys, *followed(spine_m)],
        ground,
        plants=plants,
        laid={"spine": spine_m},
        stage_ends_s=stage_ends_s,
    )
