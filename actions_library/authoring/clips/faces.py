"""Faces: ten short motions, and eight moods of four takes each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from actions_library.authoring.face_keys import Face, FaceKey, blend, face, face_tracks
from actions_library.authoring.keys import Gaze, Key, Turn, at
from actions_library.authoring.posing import RATE_HZ, make_clip
from actions_library.authoring.stance import (
    LEFT_STANCE,
    RIGHT_STANCE,
    STAND,
    frame_count,
    standing_still,
)
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton

NEUTRAL: Face = {}
SMILE = face(mouthSmile=0.75, cheekSquint=0.4, eyeSquint=0.15)
HAPPY = face(
    **{"mouthSmile": 0.95, "mouthUpperUp": 0.40, "jawOpen": 0.16, "cheekSquint": 0.8},
    **{"eyeSquint": 0.30, "browOuterUp": 0.25},
)
LAUGH = blend((1.0, HAPPY), (1.0, face(jawOpen=0.45, eyeSquint=0.4, browInnerUp=0.3)))
SAD = face(browInnerUp=1.0, mouthFrown=0.85, eyeBlink=0.25, browDown=0.15)
ANGRY = face(browDown=1.0, noseSneer=0.7, eyeSquint=0.35, mouthFrown=0.55, mouthPress=0.8)
ROAR = face(
    **{"jawOpen": 0.85, "mouthUpperUp": 0.9, "mouthLowerDown": 0.6, "mouthStretch": 0.4},
    **{"noseSneer": 1.0, "browDown": 1.0, "eyeSquint": 0.25},
)
SURPRISED = face(
    **{"browInnerUp": 1.0, "browOuterUp": 1.0, "eyeWide": 1.0},
    **{"jawOpen": 0.55, "mouthFunnel": 0.40},
)
WINK = face(
    **{"eyeBlinkLeft": 1.0, "cheekSquintLeft": 1.0, "mouthSmileLeft": 0.9},
    **{"mouthSmileRight": 0.35, "browDownLeft": 0.3, "browOuterUpRight": 0.6},
)
YAWN = face(
    **{"jawOpen": 1.0, "mouthFunnel": 0.30, "eyeBlink": 0.95, "browInnerUp": 0.5},
    **{"noseSneer": 0.3, "cheekSquint": 0.5},
)
DISGUST = face(
    **{"noseSneer": 1.0, "browDown": 0.6, "mouthUpperUp": 0.6, "mouthFrown": 0.4},
    **{"eyeSquint": 0.5},
)
KISS = face(mouthPucker=1.0, eyeBlink=0.9, browInnerUp=0.2)
DOUBT = face(
    **{"browOuterUpRight": 1.0, "browInnerUp": 0.15, "browDownLeft": 0.7, "eyeSquintLeft": 0.5},
    **{"mouthFrownLeft": 0.4, "mouthPress": 0.4},
)
BORED = face(eyeBlink=0.42, browInnerUp=0.15, mouthFrown=0.30, jawOpen=0.03)
CURIOUS = face(browInnerUp=0.55, browOuterUpLeft=0.9, eyeWide=0.45, mouthPucker=0.25)
SULK = face(browDown=0.75, mouthPucker=0.55, mouthFrown=0.6, mouthPress=0.3, cheekPuff=0.25)
PUFF = face(cheekPuff=1.0, mouthPress=0.5, browInnerUp=0.4, mouthPucker=0.3)


@dataclass(frozen=True, slots=True)
class FaceBeat:
    """What the face shows at a time (s), where it looks, and how head and chest are turned (°)."""

    at: float
    face: Face
    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    gaze: tuple[float, float] = (0.0, 0.0)
    chest: float = 0.0


def _clip(
    skeleton: Skeleton,
    name: str,
    duration_s: float,
    beats: Sequence[FaceBeat],
    blinks_s: Sequence[float] = (),
) -> Clip:
    """Return a face on a body that stands; beats are added to how it stands."""
    stand_head, stand_chest = STAND.head or Turn(), STAND.chest or Turn()
    keys = [STAND, at(duration_s, replace(STAND, gaze=None))]
    for beat in (FaceBeat(0.0, NEUTRAL), *beats, FaceBeat(duration_s, NEUTRAL)):
        yaw, lean, tilt = beat.head
        keys.append(
            Key(
                beat.at,
                head=Turn(stand_head.yaw + yaw, stand_head.lean + lean, stand_head.tilt + tilt),
                chest=replace(stand_chest, lean=stand_chest.lean + beat.chest),
                gaze=Gaze(*beat.gaze),
            )
        )
    keys[:2] = [replace(key, head=None, chest=None) for key in keys[:2]]
    made = make_clip(
        skeleton,
        name,
        keys,
        standing_still(duration_s),
        left_foot=[LEFT_STANCE],
        right_foot=[RIGHT_STANCE],
        stage_ends_s=(0.0, 0.0, duration_s, duration_s, duration_s),
    )
    faces = [FaceKey(0.0, NEUTRAL), *(FaceKey(b.at, b.face) for b in beats)]
    faces.append(FaceKey(duration_s, NEUTRAL))
    tracks = face_tracks(faces, blinks_s, frame_count(duration_s), RATE_HZ)
    return replace(made, tracks=tracks)


_MOTIONS: dict[str, tuple[float, list[FaceBeat], tuple[float, ...]]] = {
    "smile": (
        1.8,
        [FaceBeat(0.45, SMILE, (0.0, -2.0, 3.0)), FaceBeat(1.25, SMILE, (0.0, -1.0, 4.0))],
        (0.2,),
    ),
    "frown": (
        1.8,
        [FaceBeat(0.5, ANGRY, (0.0, 4.0, 0.0)), FaceBeat(1.25, ANGRY, (0.0, 5.0, -2.0))],
        (1.4,),
    ),
    "surprise": (
        1.5,
        [
            FaceBeat(0.22, SURPRISED, (0.0, -8.0, 0.0), chest=-4.0),
            FaceBeat(0.95, SURPRISED, (0.0, -6.0, 2.0)),
        ],
        (1.1,),
    ),
    "wink": (
        1.2,
        [FaceBeat(0.35, WINK, (4.0, 2.0, -7.0)), FaceBeat(0.6, WINK, (4.0, 2.0, -7.0))],
        (),
    ),
    "yawn": (
        3.0,
        [
            FaceBeat(0.5, blend((0.3, YAWN)), (0.0, -3.0, 0.0)),
            FaceBeat(1.2, YAWN, (0.0, -13.0, 4.0), chest=-4.0),
            FaceBeat(1.9, YAWN, (0.0, -11.0, 5.0), chest=-3.0),
            FaceBeat(2.5, face(eyeBlink=0.5, mouthPress=0.4), (0.0, 5.0, 0.0), chest=1.0),
        ],
        (2.65,),
    ),
    "laugh": (
        2.4,
        [
            FaceBeat(0.35, LAUGH, (0.0, -9.0, 2.0), chest=-3.0),
            *(
                FaceBeat(
                    0.5 + 0.15 * k,
                    (HAPPY, LAUGH)[k % 2],
                    (0.0, -5.0 + 3.0 * (k % 2), 2.0),
                    chest=k % 2,
                )
                for k in range(8)
            ),
            FaceBeat(2.0, SMILE, (0.0, 1.0, 0.0)),
        ],
        (),
    ),
    "sneer": (
        1.6,
        [
            FaceBeat(0.4, DISGUST, (-6.0, -3.0, -4.0)),
            FaceBeat(1.1, DISGUST, (-9.0, -4.0, -5.0), (8.0, -4.0)),
        ],
        (),
    ),
    "kiss": (
        1.6,
        [
            FaceBeat(0.5, KISS, (0.0, 4.0, 3.0), chest=3.0),
            FaceBeat(0.9, KISS, (0.0, 5.0, 3.0), chest=3.0),
        ],
        (),
    ),
    "doubt": (
        1.8,
        [
            FaceBeat(0.4, DOUBT, (7.0, 2.0, 7.0), (-6.0, 0.0)),
            FaceBeat(1.3, DOUBT, (8.0, 3.0, 8.0), (-7.0, 0.0)),
        ],
        (0.15,),
    ),
    "eye_roll": (
        1.9,
        [
            FaceBeat(0.35, face(eyeBlink=0.2, mouthPress=0.5), (0.0, 1.0, 0.0), (-20.0, 4.0)),
            FaceBeat(
                0.7,
                face(eyeWide=0.4, browOuterUp=0.5, mouthPress=0.5),
                (0.0, -5.0, 3.0),
                (-8.0, 24.0),
            ),
            FaceBeat(
                1.1,
                face(eyeWide=0.2, browOuterUp=0.4, mouthPress=0.5),
                (0.0, -5.0, 4.0),
                (16.0, 20.0),
            ),
            FaceBeat(1.5, face(eyeBlink=0.5, mouthFrown=0.4), (0.0, 3.0, 3.0), (10.0, -8.0)),
        ],
        (1.6,),
    ),
}

TAKE_S = 2.0
"""A take of a mood: after each the face is as it was at first."""

Take = tuple[list[FaceBeat], tuple[float, ...]]


def _held(
    shown: Face,
    head: tuple[float, float, float],
    gaze: tuple[float, float],
    first: float,
    last: float,
) -> list[FaceBeat]:
    """Return beats of one face that is held."""
    less = (0.7 * head[0], 0.7 * head[1], 0.7 * head[2])
    return [FaceBeat(first, shown, head, gaze), FaceBeat(last, shown, less, gaze)]


_MOODS: dict[str, list[Take]] = {
    "mood_happy": [
        (_held(SMILE, (0.0, -2.0, 4.0), (0.0, 0.0), 0.4, 1.5), (0.9,)),
        (_held(HAPPY, (6.0, -4.0, -4.0), (4.0, 2.0), 0.35, 1.5), (0.2,)),
        (
            [
                FaceBeat(0.3, HAPPY, (0.0, -4.0, 0.0), chest=-2.0),
                FaceBeat(0.7, LAUGH, (0.0, -9.0, 3.0), chest=-4.0),
                FaceBeat(1.0, HAPPY, (0.0, -3.0, 2.0), chest=0.0),
                FaceBeat(1.3, LAUGH, (0.0, -7.0, -2.0), chest=-3.0),
                FaceBeat(1.6, SMILE, (0.0, -1.0, 0.0)),
            ],
            (),
        ),
        (
            [
                *_held(WINK, (5.0, 2.0, -8.0), (0.0, 0.0), 0.45, 0.75),
                FaceBeat(1.3, SMILE, (3.0, 0.0, -3.0)),
            ],
            (),
        ),
    ],
    "mood_grumpy": [
        (_held(ANGRY, (0.0, 6.0, 0.0), (0.0, 4.0), 0.5, 1.5), (1.6,)),
        (_held(SULK, (12.0, 4.0, -4.0), (14.0, 0.0), 0.5, 1.5), (0.25,)),
        (
            _held(blend((0.6, ANGRY), (0.6, PUFF)), (-8.0, 3.0, 3.0), (-10.0, -3.0), 0.45, 1.4),
            (1.5,),
        ),
        (
            [
                FaceBeat(0.5, SULK, (-10.0, 8.0, 4.0), (-12.0, -8.0)),
                FaceBeat(1.1, ANGRY, (4.0, 7.0, 0.0), (6.0, 4.0)),
                FaceBeat(1.5, ANGRY, (4.0, 7.0, 0.0), (6.0, 4.0)),
            ],
            (),
        ),
    ],
    "mood_bored": [
        (_held(BORED, (9.0, 5.0, 7.0), (16.0, 3.0), 0.6, 1.6), (1.0,)),
        (_held(BORED, (-12.0, -4.0, -3.0), (-12.0, 16.0), 0.6, 1.5), (0.7,)),
        (
            [
                FaceBeat(0.5, blend((0.6, PUFF)), (0.0, -3.0, 0.0), (0.0, 10.0)),
                FaceBeat(1.0, face(mouthFunnel=0.6, eyeBlink=0.4), (0.0, 2.0, 0.0), (0.0, 4.0)),
                FaceBeat(1.5, BORED, (0.0, 8.0, 5.0), (-6.0, -12.0)),
            ],
            (),
        ),
        (
            [
                FaceBeat(0.6, blend((0.8, YAWN)), (0.0, -9.0, 4.0)),
                FaceBeat(1.1, blend((0.8, YAWN)), (0.0, -8.0, 5.0)),
                FaceBeat(1.6, BORED, (0.0, 5.0, 0.0), (0.0, -6.0)),
            ],
            (),
        ),
    ],
    "mood_curious": [
        (_held(CURIOUS, (10.0, 3.0, 9.0), (8.0, 0.0), 0.4, 1.5), (0.15,)),
        (_held(CURIOUS, (-16.0, 5.0, -9.0), (-12.0, -4.0), 0.4, 1.5), (0.2, 1.6)),
        (
            [
                FaceBeat(0.4, CURIOUS, (14.0, 0.0, 5.0), (16.0, 0.0)),
                FaceBeat(0.9, DOUBT, (4.0, 4.0, 8.0), (-4.0, 0.0)),
                FaceBeat(1.5, CURIOUS, (-12.0, 1.0, -5.0), (-14.0, 4.0)),
            ],
            (0.65,),
        ),
        (
            [
                FaceBeat(0.5, blend((0.7, CURIOUS)), (0.0, 10.0, 5.0), (0.0, -10.0), 5.0),
                FaceBeat(
                    1.4, blend((1.0, CURIOUS), (0.4, SMILE)), (0.0, 3.0, 8.0), (0.0, 3.0), 4.0
                ),
            ],
            (),
        ),
    ],
    "mood_neutral": [
        ([FaceBeat(1.0, face(browInnerUp=0.06), (2.0, 0.0, 0.0))], (0.8,)),
        (_held(face(mouthPress=0.25), (-6.0, 1.0, -1.0), (-9.0, 0.0), 0.6, 1.4), (0.5,)),
        (_held(face(browOuterUp=0.12), (5.0, -1.0, 2.0), (10.0, 4.0), 0.5, 1.4), (0.4, 1.5)),
        (_held(face(mouthSmile=0.12), (0.0, 3.0, 0.0), (0.0, -7.0), 0.7, 1.3), (1.0,)),
    ],
    "mood_roar": [
        (
            [
                FaceBeat(0.35, ANGRY, (0.0, 8.0, 0.0)),
                FaceBeat(0.7, ROAR, (0.0, -10.0, 0.0), chest=-5.0),
                FaceBeat(1.4, ROAR, (0.0, -7.0, 0.0), chest=-3.0),
            ],
            (),
        ),
        (
            [
                FaceBeat(0.3, ANGRY, (8.0, 6.0, 4.0)),
                FaceBeat(0.6, ROAR, (-10.0, -4.0, -5.0), chest=4.0),
                FaceBeat(1.0, ROAR, (10.0, -5.0, 5.0), chest=3.0),
                FaceBeat(1.4, ROAR, (-6.0, -3.0, 0.0), chest=2.0),
            ],
            (),
        ),
        (
            [
                FaceBeat(0.3, blend((0.7, ROAR)), (0.0, -3.0, 3.0)),
                FaceBeat(0.6, ANGRY, (0.0, 4.0, 3.0)),
                FaceBeat(1.0, ROAR, (0.0, -12.0, -3.0), chest=-4.0),
                FaceBeat(1.5, ANGRY, (0.0, 5.0, 0.0)),
            ],
            (),
        ),
        (
            [
                FaceBeat(
                    0.5,
                    face(noseSneer=1.0, browDown=1.0, mouthUpperUp=0.9),
                    (0.0, 9.0, 0.0),
                    (0.0, 6.0),
                ),
                FaceBeat(
                    1.1,
                    blend((1.0, ROAR), (1.0, face(eyeWide=0.8))),
                    (0.0, 2.0, 6.0),
                    (0.0, 0.0),
                    6.0,
                ),
                FaceBeat(1.5, ANGRY, (0.0, 7.0, 3.0), chest=3.0),
            ],
            (),
        ),
    ],
    "mood_head_shake": [
        (
            [
                FaceBeat(
                    0.3 + 0.3 * k,
                    face(mouthFrown=0.3, browInnerUp=0.3),
                    ((-1.0) ** k * 18.0, 2.0, 0.0),
                )
                for k in range(5)
            ],
            (0.2,),
        ),
        (
            [
                FaceBeat(
                    0.4 + 0.45 * k,
                    ANGRY,
                    ((-1.0) ** k * 12.0, 5.0, 0.0),
                    ((-1.0) ** (k + 1) * 8.0, 0.0),
                )
                for k in range(3)
            ],
            (),
        ),
        (
            [
                FaceBeat(0.3 + 0.22 * k, SMILE, ((-1.0) ** k * 9.0, -3.0, (-1.0) ** k * 4.0))
                for k in range(6)
            ],
            (1.0,),
        ),
        (
            [
                FaceBeat(
                    0.5 + 0.5 * k, SAD, ((-1.0) ** k * 14.0, 8.0, (-1.0) ** k * 5.0), (0.0, -10.0)
                )
                for k in range(3)
            ],
            (0.75,),
        ),
    ],
    "mood_surprise": [
        (_held(SURPRISED, (0.0, -8.0, 0.0), (0.0, 0.0), 0.25, 1.3), (1.5,)),
        (
            _held(blend((1.0, SURPRISED), (0.5, HAPPY)), (8.0, -6.0, 4.0), (5.0, 0.0), 0.25, 1.3),
            (1.4,),
        ),
        (
            [
                FaceBeat(0.25, SURPRISED, (-20.0, -3.0, 0.0), (-14.0, 0.0)),
                FaceBeat(0.9, SURPRISED, (14.0, -3.0, 0.0), (12.0, 0.0)),
                FaceBeat(1.4, CURIOUS, (5.0, 2.0, 4.0)),
            ],
            (0.55,),
        ),
        (
            [
                FaceBeat(
                    0.3,
                    face(browInnerUp=1.0, eyeWide=0.9, mouthStretch=0.7, jawOpen=0.2),
                    (0.0, 5.0, -4.0),
                    chest=-6.0,
                ),
                FaceBeat(
                    1.3,
                    face(browInnerUp=1.0, eyeWide=0.8, mouthStretch=0.6, jawOpen=0.12),
                    (0.0, 6.0, -5.0),
                    chest=-5.0,
                ),
            ],
            (0.1,),
        ),
    ],
}

MOTIONS, MOODS = tuple(_MOTIONS), tuple(_MOODS)
"""Names of the clips."""


def motion(skeleton: Skeleton, name: str) -> Clip:
    """Return a short motion of the face."""
    duration_s, beats, blinks_s = _MOTIONS[name]
    return _clip(skeleton, name, duration_s, beats, blinks_s)


def mood(skeleton: Skeleton, name: str) -> Clip:
    """Return the takes of a mood, one after the other."""
    beats, blinks_s = [], []
    for k, (take, blinks) in enumerate(_MOODS[name]):
        start_s = k * TAKE_S
        beats += [replace(beat, at=start_s + beat.at) for beat in take]
        beats.append(FaceBeat(start_s + TAKE_S, NEUTRAL))
        blinks_s += [start_s + blink for blink in blinks]
    return _clip(skeleton, name, len(_MOODS[name]) * TAKE_S, beats[:-1], blinks_s)
