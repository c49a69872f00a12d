"""The dog's jump: it crouches, rears, pushes off with the hind feet, and lands on the fore ones.

In the air the middle of the body falls by 1 g: its keys lie on a parabola.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from actions_library.authoring.dog.standing import STAND
from actions_library.authoring.feet import Plant, Via
from actions_library.authoring.gait import standing_plants
from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, on_both_sides, rekeyed
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import moved_in_one_go
from smd.character.clip import Clip

G_M_S2 = 9.81

_REAR, _OFF = 0.62, 0.76
"""When the fore feet leave the ground, and the hind feet (s)."""


def jump(rig: Rig) -> Clip:
    """Return a jump over something low, from standing to standing."""
    far, flight_s = 1.10, 0.34
    land = _OFF + flight_s
    hind_land, low, end = land + 0.09, land + 0.20, land + 0.80
    off, down = Place(up=-0.005, ahead=0.24), Place(up=-0.030, ahead=far - 0.17)
    ears_up = on_both_sides(key(_OFF + 0.02, left_ear=Turn(lean=26.0, tilt=-4.0)))
    keys = [
        STAND,
        key(0.18, place=Place(up=-0.002), head=Turn(lean=-4.0)),
        on_both_sides(key(0.25, left_ear=Turn(tilt=12.0))),
        key(  # crouched, the hind legs deeper
            0.46,
            place=Place(up=-0.100, ahead=-0.055),
            body=Turn(lean=-3.0),
            spine=Turn(lean=10.0),
            head=Turn(lean=8.0),
            tail=Turn(lean=-20.0),
        ),
        key(  # the fore feet leave
            _REAR,
            place=Place(up=-0.050, ahead=0.060),
            body=Turn(lean=-12.0),
            spine=Turn(lean=-4.0),
            head=Turn(lean=-4.0),
        ),
        *_falling(off, down, flight_s),
        key(_OFF, body=Turn(lean=-20.0), spine=Turn(lean=-8.0), head=Turn(lean=-8.0)),
        key(_OFF, tail=Turn(lean=-30.0)),
        ears_up,
        key(
            _OFF + 0.5 * flight_s,
            body=Turn(lean=-3.0),
            spine=Turn(lean=-5.0),
            head=Turn(lean=2.0),
        ),
        key(  # the fore feet land
            land,
            body=Turn(lean=13.0),
            spine=Turn(lean=2.0),
            head=Turn(lean=-2.0),
            tail=Turn(lean=34.0),
        ),
        on_both_sides(key(land + 0.04, left_ear=Turn(lean=-24.0, tilt=24.0))),
        key(hind_land, body=Turn(lean=8.0), spine=Turn(lean=16.0)),
        key(  # absorbed
            low,
            place=Place(up=-0.090, ahead=far - 0.03),
            body=Turn(lean=2.0),
            spine=Turn(lean=8.0),
            head=Turn(lean=10.0),
        ),
        on_both_sides(key(low + 0.12, left_ear=Turn(lean=10.0))),
        *_stood(end, far),
    ]
    return make_rig_clip(
        rig,
        "jump",
        keys,
        moved_in_one_go(end, 0.46, low, ahead=far),
        plants={leg.name: _plants(rig, leg.name, far, land, hind_land) for leg in rig.legs},
        stage_ends_s=(0.18, 0.46, land, low, end),
    )


def _falling(off: Place, down: Place, flight_s: float) -> Iterator[RigKey]:
    """Yield keys of the body's place in the air, at constant speed ahead."""
    rise_m_s = (down.up - off.up) / flight_s + 0.5 * G_M_S2 * flight_s
    for t in np.linspace(0.0, flight_s, 6):
        up = off.up + rise_m_s * t - 0.5 * G_M_S2 * t * t
        ahead = off.ahead + (down.ahead - off.ahead) * t / flight_s
        yield key(_OFF + float(t), place=Place(up=float(up), ahead=float(ahead)))


def _stood(end: float, far: float) -> Iterator[RigKey]:
    """Yield keys of standing at the end of the way."""
    for time in (end - 0.25, end):
        still = rekeyed(time, STAND)
        place = still.parts["place"]
        assert isinstance(place, Place)
        yield RigKey(time, {**still.parts, "place": Place(place.left, place.up, far)})


def _plants(rig: Rig, leg: str, far: float, land: float, hind_land: float) -> list[Plant]:
    (stand,) = standing_plants(rig)[leg]
    fore = leg.endswith("fore")
    right = leg.startswith("right")
    leave = (_REAR if fore else _OFF) - (0.02 if right else 0.0)
    first = Plant(
        stand.land, leave, stand.left, stand.ahead, leave_pitch=52.0 if fore else 60.0, roll=0.16
    )
    swing = (
        (Via(0.35, 0.24, along=0.32, pitch=70.0), Via(0.75, 0.20, along=0.82, pitch=20.0))
        if fore
        else (Via(0.32, 0.20, along=0.30, pitch=70.0), Via(0.70, 0.24, along=0.84, pitch=40.0))
    )
    touch = (land if fore else hind_land) + (0.02 if right else 0.0)
    last = Plant(
        touch,
        stand.leave,
        stand.left,
        stand.ahead + far,
        land_pitch=-18.0,
        flat=0.10,
        swing=swing,
    )
    return [first, last]
