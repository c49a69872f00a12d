"""What the moon does: it idles, and a handful of expressions, each from rest and back to it."""

from __future__ import annotations

from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import Part, RigKey, key
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.stance import standing_still
from smd.character.clip import Clip


def both(**weights: float) -> dict[str, float]:
    """Return a shape's weight for its left and its right."""
    return {f"{side}_{name}": w for name, w in weights.items() for side in ("left", "right")}


def _looks(yaw: float = 0.0, lean: float = 0.0) -> dict[str, Part]:
    """Return both eyes turned: to the left, down (°)."""
    return {"left_eye": Turn(yaw=yaw, lean=lean), "right_eye": Turn(yaw=yaw, lean=lean)}


def idle(rig: Rig) -> Clip:
    """Sways, looks to one side and blinks twice."""
    end = 6.0
    keys = [
        key(0.0, place=Place(), body=Turn(), **_looks()),
        key(0.25, place=Place(up=0.004), body=Turn(yaw=2.0, tilt=2.0)),
        key(0.75, place=Place(up=-0.003), body=Turn(yaw=-3.0, lean=1.5, tilt=-2.0)),
        key(0.30, **_looks(), **both(smile=0.05)),
        key(0.34, **_looks(yaw=16.0, lean=-3.0)),
        key(0.52, **_looks(yaw=16.0, lean=-3.0), **both(smile=0.22)),
        key(0.56, **_looks()),
        key(0.40, **both(brow_up=0.25)),
        key(0.60, **both(brow_up=0.0)),
        key(0.95, **both(brow_up=0.0, smile=0.05)),
    ]
    for at in (0.15, 0.545):
        keys += _blink(at, 1.0 / end)
    return _clip(rig, "idle", keys, (0.0, 0.0, end, end, end), cyclic=True)


def smile(rig: Rig) -> Clip:
    """A broad one that reaches the eyes."""
    shown = both(smile=1.0, cheek_up=0.8, eye_squint=0.45, brow_up=0.3)
    return _shown(rig, "smile", shown, {"body": Turn(lean=-4.0, tilt=5.0)}, 2.4, jaw_open=0.22)


def frown(rig: Rig) -> Clip:
    """Displeased: brows down, corners down, eyes narrow."""
    shown = both(frown=1.0, brow_down=1.0, eye_squint=0.35, nose_wrinkle=0.4)
    return _shown(rig, "frown", shown, {"body": Turn(lean=7.0)}, 2.4)


def sad(rig: Rig) -> Clip:
    """Brows rise in the middle, the corners sink, the eyes go down."""
    shown = both(frown=0.85, blink=0.28)
    posed: dict[str, Part] = {"body": Turn(lean=9.0, tilt=-5.0), **_looks(lean=16.0)}
    return _shown(rig, "sad", shown, posed, 3.0, brow_inner_up=1.0, slow=True)


def surprise(rig: Rig) -> Clip:
    """Everything opens at once."""
    shown = both(brow_up=1.0, eye_wide=1.0)
    posed: dict[str, Part] = {"body": Turn(lean=-8.0), "place": Place(up=0.012)}
    return _shown(rig, "surprise", shown, posed, 2.0, jaw_open=0.75, pucker=0.45, pupils_wide=0.5)


def wink(rig: Rig) -> Clip:
    """The left eye closes, with a smile on that side."""
    left = {"left_blink": 1.0, "left_smile": 0.9, "left_cheek_up": 0.9, "left_brow_down": 0.15}
    shown = {**left, "right_smile": 0.35, "right_brow_up": 0.5}
    return _shown(rig, "wink", shown, {"body": Turn(yaw=-6.0, tilt=-7.0)}, 1.4)


def yawn(rig: Rig) -> Clip:
    """The mouth opens wide and long, the eyes close."""
    shown = both(blink=1.0, cheek_up=0.5, nose_wrinkle=0.3)
    posed: dict[str, Part] = {"body": Turn(lean=-13.0, tilt=4.0)}
    return _shown(
        rig, "yawn", shown, posed, 3.6, jaw_open=1.15, brow_inner_up=0.6, pucker=0.3, slow=True
    )


def kiss(rig: Rig) -> Clip:
    """Lips go ahead, the eyes close."""
    shown = both(blink=1.0, brow_up=0.4)
    return _shown(rig, "kiss", shown, {"body": Turn(lean=5.0, tilt=6.0)}, 1.8, pucker=1.0)


def huff(rig: Rig) -> Clip:
    """Cheeks are blown up, and let go."""
    shown = both(eye_wide=0.5, brow_down=0.4)
    return _shown(rig, "huff", shown, {"body": Turn(lean=-3.0)}, 2.2, cheek_puff=1.0, pucker=0.35)


def nod(rig: Rig) -> Clip:
    """Yes: down and up twice, with a smile."""
    keys = [key(0.0, body=Turn(), **both(smile=0.0, brow_up=0.0))]
    for at, lean in ((0.25, -5.0), (0.50, 15.0), (0.75, -3.0), (1.0, 13.0), (1.3, 0.0)):
        keys.append(key(at, body=Turn(lean=lean)))
    keys += [
        key(0.4, **both(smile=0.5, brow_up=0.3)),
        key(1.1, **both(smile=0.6, brow_up=0.2)),
        *_blink(0.42, 1.0),
        key(1.6, body=Turn(), **both(smile=0.0, brow_up=0.0)),
    ]
    return _clip(rig, "nod", keys, (0.1, 0.25, 1.1, 1.3, 1.6))


def shake_head(rig: Rig) -> Clip:
    """No: to and fro, the mouth pressed down."""
    still = both(frown=0.0, brow_down=0.0)
    keys = [key(0.0, body=Turn(), **_looks(), **still)]
    for at, yaw in ((0.3, 16.0), (0.6, -18.0), (0.9, 15.0), (1.2, -10.0), (1.5, 0.0)):
        keys.append(key(at, body=Turn(yaw=yaw, lean=3.0), **_looks(yaw=-0.6 * yaw)))
    keys += [
        key(0.3, **both(frown=0.6, brow_down=0.5)),
        key(1.2, **both(frown=0.6, brow_down=0.5)),
        key(1.8, body=Turn(), **_looks(), **still),
    ]
    return _clip(rig, "shake_head", keys, (0.1, 0.3, 1.2, 1.5, 1.8))


MOON_CLIPS = (
    *(idle, smile, frown, sad, surprise, wink, yawn, kiss, huff),
    *(nod, shake_head),
)
"""What makes each clip."""


def _blink(at: float, unit: float) -> list[RigKey]:
    """Return keys of a blink that is closed at a time; ``unit`` is a second in the keys' time."""
    times = ((-0.10, 0.0), (-0.02, 1.0), (0.03, 1.0), (0.20, 0.0))
    return [key(at + dt * unit, **both(blink=weight)) for dt, weight in times]


def _shown(
    rig: Rig,
    name: str,
    sided: dict[str, float],
    posed: dict[str, Part],
    end: float,
    *,
    slow: bool = False,
    **more: float,
) -> Clip:
    """Return a clip that goes from rest to an expression, holds it, lives in it, and goes back."""
    weights = {**sided, **more}
    rest: dict[str, Part] = {part: _at_rest(value) for part, value in posed.items()}
    none: dict[str, Part] = dict.fromkeys(weights, 0.0)
    in_s, out_s = (0.9, 0.9) if slow else (0.36, 0.55)
    keys = [
        key(0.0, **rest, **none),
        key(0.12, **rest, **none),
        key(0.12 + in_s, **posed, **weights),
        key(
            0.5 * (end + in_s - out_s),  # an eye that is closed stays so
            **{n: w if "blink" in n else 0.92 * w for n, w in weights.items()},
        ),
        key(end - out_s - 0.1, **posed, **weights),
        key(end - 0.1, **rest, **none),
        key(end, **rest, **none),
    ]
    ends = (0.12, 0.12 + 0.5 * in_s, end - out_s - 0.1, end - 0.1, end)
    return _clip(rig, name, keys, ends)


def _at_rest(part: Part) -> Part:
    return Place() if isinstance(part, Place) else Turn()


def _clip(
    rig: Rig, name: str, keys: list[RigKey], ends: tuple[float, ...], *, cyclic: bool = False
) -> Clip:
    ground = standing_still(ends[-1])
    return make_rig_clip(rig, name, keys, ground, stage_ends_s=ends, cyclic=cyclic)
