"""What the dragon does where it stands: it idles, roars, looks, sits, bows, turns, swipes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from actions_library.authoring.dragon.gaits import blink, folded
from actions_library.authoring.dragon.wings import wing_pose
from actions_library.authoring.feet import ALWAYS_S, OnBall, Plant, Via
from actions_library.authoring.gait import standing_plants
from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.posing import RATE_HZ
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import Part, RigKey, key, rekeyed
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import moved_in_one_go, standing_still
from actions_library.authoring.waves import Wave
from smd.character.clip import Clip

CALM: dict[str, Part] = dict.fromkeys(
    (
        *("jaw_open", "snarl", "brow_angry", "brow_raise", "nostril_flare"),
        *("throat_puff", "crest_raise"),
    ),
    0.0,
)
STAND = key(
    0.0,
    place=Place(up=-0.010),
    body=Turn(),
    spine=Turn(),
    neck=Turn(),
    head=Turn(lean=3.0),
    tail_root=Turn(),
    tail=Turn(),
    **folded(),
    **CALM,
)
SIT = key(
    0.0,
    place=Place(up=-0.158, ahead=-0.015),
    body=Turn(lean=-44.0),
    spine=Turn(lean=6.0),
    neck=Turn(lean=26.0),
    head=Turn(lean=0.0),
    tail_root=Turn(lean=58.0),
    tail=Turn(),
    **folded(raised=6.0),
    **CALM,
)
_HOCKS_DOWN = -66.0
_TUCKED = {"ahead": 0.225, "left": 0.030}


def idle(rig: Rig) -> Clip:
    """Breathes, sways its tail, looks to one side, settles its wings and blinks."""
    end = 4.0
    keys = [
        STAND,
        key(0.2, throat_puff=0.10),
        key(0.25, spine=Turn(lean=-1.2, tilt=0.8), neck=Turn(lean=2.0)),
        key(0.30, head=Turn(yaw=3.0, lean=3.0)),
        key(0.40, neck=Turn(yaw=14.0, lean=-2.0), head=Turn(yaw=22.0, lean=1.0)),
        key(0.40, throat_puff=0.0, nostril_flare=0.0),
        key(0.50, spine=Turn()),
        key(0.50, left_eye=Turn(yaw=6.0), right_eye=Turn(yaw=6.0)),
        key(0.58, neck=Turn(yaw=14.0), head=Turn(yaw=24.0, lean=3.0, tilt=6.0)),
        key(0.62, throat_puff=0.12, nostril_flare=0.35, **folded()),
        key(0.68, **folded(raised=8.0, opened=0.08)),
        key(0.76, **folded()),
        key(0.75, spine=Turn(lean=-1.2, tilt=-0.8)),
        key(0.85, neck=Turn(lean=1.0), head=Turn(lean=3.0), throat_puff=0.0, nostril_flare=0.0),
        key(0.85, left_eye=Turn(), right_eye=Turn()),
        key(0.15, left_eye=Turn(), right_eye=Turn()),
        *blink(0.12, 1.0 / end),
        *blink(0.37, 1.0 / end),
        *blink(0.80, 1.0 / end),
    ]
    waves = [Wave("tail", "yaw", 2.5, tip=7.0, wavelength=1.3, per_cycle=2)]
    return _in_place(rig, "idle", keys, end=end, waves=waves, cyclic=True)


def roar(rig: Rig) -> Clip:
    """Breathes in with its head low, then roars: jaw wide, crest up, wings spread."""
    end = 3.0
    mad: dict[str, Part] = {
        "brow_angry": 1.0,
        "snarl": 1.0,
        "nostril_flare": 1.0,
        "crest_raise": 1.0,
    }
    wide = wing_pose(0.25, raised=40.0, twisted=-14.0)
    keys = [
        STAND,
        key(
            0.75,
            place=Place(up=-0.045, ahead=-0.035),
            body=Turn(lean=4.0),
            neck=Turn(lean=34.0),
            head=Turn(lean=32.0),
            throat_puff=0.9,
            brow_angry=0.6,
            jaw_open=0.05,
            crest_raise=0.2,
            tail=Turn(lean=10.0),
            **folded(raised=-6.0),
        ),
        key(
            1.10,
            place=Place(up=-0.030, ahead=0.020),
            body=Turn(lean=-5.0),
            neck=Turn(lean=20.0),
            head=Turn(lean=-12.0),
            throat_puff=0.35,
            jaw_open=1.05,
            tail=Turn(lean=-14.0),
            **mad,
            **wide,
        ),
        key(1.5, head=Turn(yaw=9.0, lean=-9.0), neck=Turn(yaw=4.0, lean=24.0), jaw_open=0.92),
        key(1.85, head=Turn(yaw=-8.0, lean=-11.0), neck=Turn(yaw=-4.0, lean=24.0), jaw_open=1.1),
        key(
            2.10,
            place=Place(up=-0.032, ahead=0.018),
            body=Turn(lean=-5.0),
            throat_puff=0.2,
            tail=Turn(lean=-12.0),
            **mad,
            **wing_pose(0.22, raised=44.0, twisted=-12.0),
        ),
        *blink(2.55, 1.0),
        rekeyed(end - 0.40, STAND),
    ]
    waves = [Wave("tail", "yaw", 3.0, tip=9.0, wavelength=1.2, per_cycle=3.0)]
    return _in_place(rig, "roar", keys, ends=(0.2, 0.75, 2.1, 2.6, end), waves=waves)


def shake_head(rig: Rig) -> Clip:
    """No: the head goes to and fro, the neck and the tail against it."""
    end = 2.2
    keys = [STAND, rekeyed(0.1, STAND)]
    for at, yaw in ((0.35, 26.0), (0.62, -30.0), (0.89, 28.0), (1.16, -22.0), (1.43, 8.0)):
        keys.append(
            key(
                at,
                neck=Turn(yaw=0.55 * yaw, lean=6.0),
                head=Turn(yaw=yaw, lean=8.0, tilt=-0.25 * yaw),
                tail=Turn(yaw=-0.6 * yaw),
                spine=Turn(yaw=0.08 * yaw),
            )
        )
    keys += [
        key(0.35, brow_angry=0.6, left_blink=0.0, right_blink=0.0),
        key(0.5, left_blink=0.75, right_blink=0.75, **folded(raised=5.0, opened=0.06)),
        key(1.1, brow_angry=0.6, left_blink=0.75, right_blink=0.75),
        key(1.35, left_blink=0.0, right_blink=0.0),
        rekeyed(end - 0.40, STAND),
    ]
    return _in_place(rig, "shake_head", keys, ends=(0.1, 0.35, 1.16, 1.5, end))


def look_around(rig: Rig) -> Clip:
    """The neck carries the head far to the left, over the top, to the right; eyes go first."""
    end = 3.75
    keys = [
        STAND,
        key(0.13, left_eye=Turn(), right_eye=Turn()),
        key(0.30, left_eye=Turn(yaw=14.0), right_eye=Turn(yaw=14.0), head=Turn(lean=3.0)),
        key(0.83, neck=Turn(yaw=52.0, lean=10.0), head=Turn(yaw=74.0, lean=8.0, tilt=5.0)),
        key(0.83, spine=Turn(yaw=8.0), tail=Turn(yaw=-18.0), brow_raise=0.7),
        key(0.87, left_eye=Turn(), right_eye=Turn()),
        key(1.26, neck=Turn(yaw=54.0, lean=12.0), head=Turn(yaw=78.0, lean=10.0, tilt=9.0)),
        key(1.48, left_eye=Turn(yaw=-14.0), right_eye=Turn(yaw=-14.0)),
        key(1.74, neck=Turn(yaw=4.0, lean=-12.0), head=Turn(yaw=6.0, lean=-12.0), brow_raise=0.3),
        key(2.13, neck=Turn(yaw=-52.0, lean=4.0), head=Turn(yaw=-74.0, lean=4.0, tilt=-5.0)),
        key(2.13, spine=Turn(yaw=-8.0), tail=Turn(yaw=18.0), brow_raise=0.8),
        key(2.22, left_eye=Turn(), right_eye=Turn()),
        key(2.57, neck=Turn(yaw=-54.0, lean=7.0), head=Turn(yaw=-77.0, lean=7.0, tilt=-9.0)),
        *blink(0.55, 1.0),
        *blink(1.78, 1.0),
        *blink(2.85, 1.0),
        rekeyed(end - 0.40, STAND),
    ]
    return _in_place(rig, "look_around", keys, ends=(0.15, 0.5, 2.6, 3.2, end))


def tail_swipe(rig: Rig) -> Clip:
    """Winds its tail up to one side, and whips it round to the other."""
    end = 2.5
    keys = [
        STAND,
        key(
            0.75,
            place=Place(left=0.015, up=-0.030),
            body=Turn(yaw=-5.0, lean=2.0),
            spine=Turn(yaw=-10.0),
            neck=Turn(yaw=-26.0, lean=14.0),
            head=Turn(yaw=-52.0, lean=14.0),
            tail_root=Turn(yaw=24.0),
            tail=Turn(yaw=66.0, lean=8.0),
            brow_angry=0.8,
            snarl=0.5,
            crest_raise=0.6,
            **folded(raised=8.0, opened=0.2),
        ),
        key(
            1.08,
            place=Place(left=-0.020, up=-0.035),
            body=Turn(yaw=7.0, lean=2.0),
            spine=Turn(yaw=12.0),
            neck=Turn(yaw=22.0, lean=16.0),
            head=Turn(yaw=34.0, lean=12.0),
            tail_root=Turn(yaw=-28.0),
            tail=Turn(yaw=-76.0, lean=-2.0),
            jaw_open=0.45,
            brow_angry=1.0,
            snarl=0.9,
            crest_raise=1.0,
            **folded(raised=12.0, opened=0.34),
        ),
        key(1.35, tail=Turn(yaw=-62.0, lean=2.0), jaw_open=0.3, head=Turn(yaw=32.0, lean=10.0)),
        *blink(1.65, 1.0),
        rekeyed(end - 0.40, STAND),
    ]
    return _in_place(rig, "tail_swipe", keys, ends=(0.15, 0.75, 1.15, 1.5, end))


def bow(rig: Rig) -> Clip:
    """The fore legs bend, the head goes to the ground and up again, the wings open a little."""
    end = 2.6
    low = key(
        0.95,
        place=Place(up=-0.085, ahead=-0.060),
        body=Turn(lean=15.0),
        spine=Turn(lean=7.0),
        neck=Turn(lean=72.0),
        head=Turn(lean=34.0),
        tail=Turn(lean=-22.0),
        left_blink=1.0,
        right_blink=1.0,
        **folded(raised=-14.0, opened=0.30),
    )
    none = key(0.3, left_blink=0.0, right_blink=0.0)
    keys = [STAND, rekeyed(0.15, STAND), none, low, rekeyed(1.35, low), rekeyed(1.75, none)]
    keys += [rekeyed(end - 0.40, STAND)]
    return _in_place(rig, "bow", keys, ends=(0.15, 0.5, 1.35, 1.8, end))


def sit_down(rig: Rig) -> Clip:
    """The hind feet step under, the rump goes down between the hocks; the fore feet stay."""
    end = 1.8
    keys = [
        STAND,
        rekeyed(0.20, STAND),
        key(0.50, place=Place(up=-0.024), neck=Turn(lean=12.0), head=Turn(lean=12.0)),
        rekeyed(1.2, SIT),
        *blink(0.75, 1.0),
    ]
    plants = standing_plants(rig)
    for leg, start in (("left_hind", 0.25), ("right_hind", 0.45)):
        down = (OnBall(start + 0.25, 0.0), OnBall(1.2, _HOCKS_DOWN))
        first = replace(plants[leg][0], leave=start, leave_pitch=20.0)
        plants[leg] = [first, _under(plants[leg][0], start + 0.22, ALWAYS_S, down)]
    return _in_place(rig, "sit_down", keys, plants=plants, ends=(0.2, 0.5, 1.2, 1.4, end))


def stand_up(rig: Rig) -> Clip:
    """From sitting to standing: the rump rises, then the hind feet step back."""
    end = 1.7
    keys = [
        SIT,
        rekeyed(0.15, SIT),
        key(0.4, head=Turn(lean=14.0), neck=Turn(lean=34.0)),
        rekeyed(1.1, STAND),
    ]
    plants = standing_plants(rig)
    for leg, start in (("right_hind", 0.74), ("left_hind", 0.94)):
        up = (OnBall(0.15, _HOCKS_DOWN), OnBall(start - 0.05, 0.0))
        last = replace(plants[leg][0], land=start + 0.22, swing=(Via(0.5, 0.04),))
        plants[leg] = [_under(plants[leg][0], -ALWAYS_S, start, up), last]
    return _in_place(rig, "stand_up", keys, plants=plants, ends=(0.15, 0.4, 1.1, 1.3, end))


def idle_sitting(rig: Rig) -> Clip:
    """Sits, breathes, sways its tail over the ground and looks about."""
    end = 3.4
    keys = [
        SIT,
        key(0.3, spine=Turn(lean=4.5), neck=Turn(yaw=-10.0, lean=24.0), head=Turn(yaw=-18.0)),
        key(0.3, throat_puff=0.14),
        key(0.55, spine=Turn(lean=6.0), neck=Turn(yaw=-10.0, lean=26.0)),
        key(0.55, head=Turn(yaw=-20.0, lean=2.0, tilt=-6.0), throat_puff=0.0),
        key(0.8, spine=Turn(lean=4.5), neck=Turn(lean=25.0), head=Turn(), throat_puff=0.14),
        *blink(0.20, 1.0 / end),
        *blink(0.70, 1.0 / end),
    ]
    plants = standing_plants(rig)
    for leg in ("left_hind", "right_hind"):
        still = (OnBall(-1.0, _HOCKS_DOWN), OnBall(end + 1.0, _HOCKS_DOWN))
        plants[leg] = [_under(plants[leg][0], -ALWAYS_S, ALWAYS_S, still)]
    waves = [Wave("tail", "yaw", 2.0, tip=7.0, wavelength=1.5, per_cycle=2)]
    return _in_place(rig, "idle_sitting", keys, end=end, plants=plants, waves=waves, cyclic=True)


def turn_left(rig: Rig) -> Clip:
    """A quarter turn on the spot in two rounds of steps; the head goes first, the tail last."""
    return _turned(rig, "turn_left", 90.0)


def turn_right(rig: Rig) -> Clip:
    """The mirror image of turning left."""
    return _turned(rig, "turn_right", -90.0)


def _turned(rig: Rig, name: str, yaw: float) -> Clip:
    end, begin, done = 2.25, 0.30, 1.75
    course = moved_in_one_go(end, begin, done, yaw=yaw)
    side = np.sign(yaw)
    keys = []
    for at in np.linspace(0.0, end - 0.40, 12):
        now = float(np.degrees(course.yaw_rad[round(at * RATE_HZ)]))
        soon = float(
            np.degrees(course.yaw_rad[min(round((at + 0.22) * RATE_HZ), len(course.yaw_rad) - 1)])
        )
        before = float(np.degrees(course.yaw_rad[max(round((at - 0.25) * RATE_HZ), 0)]))
        keys.append(
            key(
                float(at),
                place=Place(up=-0.030),
                body=Turn(yaw=now),
                spine=Turn(yaw=0.35 * (soon - now)),
                neck=Turn(yaw=1.0 * (soon - now), lean=3.0 * abs(soon - now) / 20.0),
                head=Turn(yaw=soon + 0.6 * (soon - now), lean=3.0),
                tail=Turn(yaw=1.5 * (before - now)),
                **folded(),
            )
        )
    keys += [key(0.0, left_eye=Turn(), right_eye=Turn()), *blink(0.4, 1.0)]
    keys += [key(0.3, **{f"{s}_eye": Turn(yaw=12.0 * side) for s in ("left", "right")})]
    keys += [key(1.2, left_eye=Turn(), right_eye=Turn())]
    first = ("left", "right") if yaw > 0 else ("right", "left")
    order = (f"{first[0]}_fore", f"{first[1]}_hind", f"{first[1]}_fore", f"{first[0]}_hind")
    plants = {}
    for name_of_leg, stands in standing_plants(rig).items():
        rest, k = stands[0], order.index(name_of_leg)
        lifts = [0.38 + 0.16 * k, 1.06 + 0.16 * k]
        steps, at = [], -ALWAYS_S
        for number, turned in enumerate((0.0, 0.5 * yaw, yaw)):
            leave = lifts[number] if number < 2 else ALWAYS_S
            steps.append(_swivelled(rest, turned, at, leave))
            at = leave + 0.22
        plants[name_of_leg] = steps
    return make_rig_clip(
        rig,
        name,
        keys,
        course,
        plants=plants,
        stage_ends_s=(0.2, 0.38, 1.75, 1.95, end),
    )


def _swivelled(rest: Plant, yaw: float, land: float, leave: float) -> Plant:
    """Return a stand turned about the origin."""
    sine, cosine = np.sin(np.radians(yaw)), np.cos(np.radians(yaw))
    return replace(
        rest,
        land=land,
        leave=leave,
        left=float(rest.left * cosine + rest.ahead * sine),
        ahead=float(rest.ahead * cosine - rest.left * sine),
        yaw=yaw,
        flat=0.06,
        roll=0.08,
        swing=(Via(0.5, 0.05),),
    )


def _under(plant: Plant, land: float, leave: float, rolling: tuple[OnBall, ...]) -> Plant:
    """Return a hind foot's stand under the body of a dragon that sits."""
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


def _in_place(
    rig: Rig,
    name: str,
    keys: list[RigKey],
    *,
    end: float = 0.0,
    ends: tuple[float, ...] = (),
    plants: dict[str, list[Plant]] | None = None,
    waves: list[Wave] | None = None,
    cyclic: bool = False,
) -> Clip:
    stage_ends_s = ends or (0.0, 0.0, end, end, end)
    return make_rig_clip(
        rig,
        name,
        keys,
        standing_still(stage_ends_s[-1]),
        plants=plants or standing_plants(rig),
        waves=waves or (),
        stage_ends_s=stage_ends_s,
        cyclic=cyclic,
    )
