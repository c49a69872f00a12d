"""Repertoire: the clips of a performer, each prepared once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from laban import Effort
from laban.effort import EFFORT_STEPS
from smd.acting.flight import airborne
from smd.acting.legs import Leg, feet_of, legs_of, pelvis_of, yaw_of
from smd.acting.move import Airborne, Footwork
from smd.acting.standing import resting, standing
from smd.cast import IDLE, ActionLibrary
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics, joints_in_world
from smd.character.mass import Mass
from smd.character.poses import Poses, sampled, sampled_tracks
from smd.character.roles import to_knuckles
from smd.character.tracks import Tracks
from smd.expression.body import Body, body_of
from smd.expression.expressive import expressive
from smd.expression.study import study_of
from smd.geometry.arrays import BoolArray, FloatArray
from smd.score import Phrase
from smd.transfer.body_work import BodyWork, body_works
from smd.transfer.gait import Gait, fastest_m_s, gait_of
from smd.transfer.ground_root import GroundRoot, ground_roots
from smd.transfer.pacing import near_share
from smd.transfer.swings import Swing, expressed, swing_of

NO_WAY_M = 0.05
"""Travel of a clip below which it has no direction of its own."""

ACROSS = np.cos(np.radians(45.0))
"""Cosine of the angle from which two gaits go in different directions of the body."""

UPRIGHT = 0.95
"""Least height of the centre of mass of an upright gait, as a share of the idle one."""

SAME_POSE = 0.999
"""Cosine of half the angle up to which two rotations of a joint count as equal: 5 degrees."""


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """An action's clip, with what was computed from it.

    Attributes
    ----------
    clip : neutral. Its expression by Effort would be a clip of the same kind in its place.
    travels : moves along the doodle's path.
    root : how its ground root goes.
    stands : (n, legs) when each of the character's feet stands.
    yaw_rad : (n, legs) which way each points in the clip's own world, without jumps.
    touching : joints of the feet that touch the ground in it.
    gait : what it does per cycle, if it steps along the path.
    near : share of its transition after which its pose is near to its last one.
    airborne : the part of it that flies, if it plays once and one does.
    body : what it asks of the body's mass, where that counts.
    swing : the part of it that repeats itself, if it plays once, in place, and one does.
    """

    clip: Clip
    travels: bool
    root: GroundRoot
    stands: BoolArray
    yaw_rad: FloatArray
    touching: tuple[int, ...]
    gait: Gait | None
    near: float
    airborne: Airborne | None
    body: BodyWork | None
    swing: Swing | None = None

    @property
    def direction_rad(self) -> float:
        """Direction in which it travels from its own heading, positive to the left."""
        left, ahead = self.root.position_m[-1]
        return float(np.arctan2(left, ahead)) if np.hypot(left, ahead) > NO_WAY_M else 0.0

    @property
    def last_frame(self) -> int:
        """Index of the clip's last frame."""
        return len(self.clip) - 1

    def sampled(self, frame: FloatArray) -> Poses:
        """Return local poses at fractional frames ``(n,)``, the ground root at its origin."""
        return sampled(self.clip, frame)

    def tracks_at(self, frame: FloatArray) -> Tracks:
        """Return the tracks at fractional frames ``(n,)``."""
        return sampled_tracks(self.clip, frame)

    def stands_at(self, frame: FloatArray) -> Footwork:
        """Return the foot contacts at fractional frames ``(n,)``: those of the nearest frame."""
        last = self.last_frame
        laps = np.floor(frame / last) if self.clip.cyclic else np.zeros(len(frame))
        nearest = np.mod(frame, last) if self.clip.cyclic else frame
        nearest = np.clip(np.round(nearest), 0, last).astype(np.int64)
        frames = np.arange(len(self.clip))
        yaw = [
            np.interp(frame - laps * last, frames, yaw) + laps * (yaw[-1] - yaw[0])
            for yaw in self.yaw_rad.T
        ]
        return Footwork(self.stands[nearest], np.reshape(yaw, (-1, len(frame))).T)


@dataclass(frozen=True, slots=True, eq=False)
class Repertoire:
    """The pieces of a Score, and the legs that stand in any of them.

    Attributes
    ----------
    pieces : by action and how it is played, as `piece_name` calls them.
    legs : of the character.
    rests : what is idled in after an action, where that is not idling.
    expressiveness : how much of a phrase's Effort is played; 0 is neutral.
    faster : by a gait's action, the others with which its way can be gone faster, the likest first.
    mass : where the body's weight is, where that counts.
    leaving : what leads out of such a rest, by the rest's name: its clip begins as that one does.
    """

    pieces: Mapping[str, Piece]
    legs: tuple[Leg, ...]
    rests: Mapping[str, str] = field(default_factory=dict)
    leaving: Mapping[str, str] = field(default_factory=dict)
    expressiveness: float = 0.0
    faster: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    mass: Mass | None = None

    @property
    def idle(self) -> Piece:
        """What is played where nothing is performed."""
        return self.pieces[IDLE]

    def of(self, phrase: Phrase) -> Piece:
        """Return the piece that a phrase is played with."""
        return self.pieces[piece_name(phrase.action, phrase.effort, self.expressiveness)]

    def like(self, phrase: Phrase) -> Piece:
        """Return its piece, or the neutral one where its Effort is not prepared."""
        name = piece_name(phrase.action, phrase.effort, self.expressiveness)
        return self.pieces.get(name, self.pieces[phrase.action])

    def rest_after(self, action: str) -> str:
        """Return the action whose clip is the idle clip after another one."""
        return self.rests.get(action, IDLE)


def played_effort(effort: Effort, expressiveness: float) -> Effort:
    """Return the Effort that is played for one that was read, in steps, within its poles."""

    def stepped(axis: str, steps: int) -> float:
        scaled = expressiveness * (getattr(effort, axis) or 0.0)
        return round(min(max(scaled, -1.0), 1.0) * steps) / steps

    return Effort(**{axis: stepped(axis, steps) for axis, steps in EFFORT_STEPS.items()})


@lru_cache(maxsize=4096)
def piece_name(action: str, effort: Effort, expressiveness: float) -> str:
    """Return what a piece is called: the action, and its Effort where it is not neutral."""
    played = played_effort(effort, expressiveness)
    shown = {axis: getattr(played, axis) for axis in EFFORT_STEPS}
    return " ".join([action, *(f"{axis} {value:+.1f}" for axis, value in shown.items() if value)])


def repertoire(
    library: ActionLibrary,
    phrases: Iterable[Phrase],
    *,
    expressiveness: float,
    mass: Mass | None = None,
) -> Repertoire:
    """Prepare the clips of some phrases, with their Effort, and the idle clips.

    Parameters
    ----------
    mass
        Where the body's weight is, if that counts.
    """
    phrases = list(phrases)
    actions = {phrase.action for phrase in phrases}
    rests = {name: rest for name in actions if (rest := library.action(name).rest)}
    leaving = _leaving(library, set(rests.values()))
    names = sorted({IDLE, *actions, *rests.values(), *leaving.values()})
    clips = [library.clip(name) for name in names]
    legs = legs_of(library.character.skeleton, sorted({f for clip in clips for f in feet_of(clip)}))
    asked, body = _asked(phrases, expressiveness), body_of(library.clip(IDLE))
    pieces: dict[str, Piece] = {}
    for name, clip in zip(names, clips, strict=True):
        travels, efforts = library.action(name).travels, asked.get(name, {})
        played = _played(clip, efforts, body, travels=travels)
        made = pieces_of([clip, *played], travels=travels, legs=legs, mass=mass)
        pieces.update(zip([name, *efforts], made, strict=True))
    return Repertoire(pieces, legs, rests, leaving, expressiveness, mass=mass)


def with_efforts(known: Repertoire, phrases: Iterable[Phrase]) -> Repertoire:
    """Return a repertoire in which some phrases have their Effort too."""
    pieces = dict(known.pieces)
    body = body_of(known.idle.clip)
    for action, efforts in _asked(phrases, known.expressiveness).items():
        new = {name: effort for name, effort in efforts.items() if name not in pieces}
        if new:
            neutral = pieces[action]
            travels = neutral.travels
            clips = _played(neutral.clip, new, body, travels=travels)
            made = pieces_of(
                clips, travels=travels, legs=known.legs, neutral=neutral, mass=known.mass
            )
            pieces.update(zip(new, made, strict=True))
    return replace(known, pieces=pieces)


def _asked(phrases: Iterable[Phrase], expressiveness: float) -> dict[str, dict[str, Effort]]:
    """Return the Efforts that are played, by action and by what their pieces are called."""
    asked: dict[str, dict[str, Effort]] = {}
    for phrase in phrases:
        name = piece_name(phrase.action, phrase.effort, expressiveness)
        if name != phrase.action:  # not neutral
            effort = played_effort(phrase.effort, expressiveness)
            asked.setdefault(phrase.action, {})[name] = effort
    return asked


def _played(
    clip: Clip, efforts: Mapping[str, Effort], body: Body, *, travels: bool
) -> tuple[Clip, ...]:
    """Return a clip as it is played with some Efforts."""
    if not efforts:
        return ()
    return expressive(study_of(clip, body), list(efforts.values()), travels=travels)


def with_faster(known: Repertoire, library: ActionLibrary) -> Repertoire:
    """Return a repertoire that knows with which gaits a way can be gone faster.

    A faster gait touches the ground with the same joints: nobody gets up from a crawl to run. It
    is of the same manner: who walks happily trots happily, and who just walks just trots.
    """
    slow = [
        name for name, piece in known.pieces.items() if _steps(piece) and name == piece.clip.name
    ]
    if not slow:
        return known
    pieces = dict(known.pieces)
    for action in library.actions:
        if action.travels and action.name not in pieces and library.clip(action.name).cyclic:
            clip = library.clip(action.name)
            pieces[action.name] = piece_of(clip, travels=True, legs=known.legs, mass=known.mass)
    gaits = sorted(
        (fastest_m_s(gait), name)
        for name, piece in pieces.items()
        if (gait := _steps(piece)) and piece.clip.name == name
    )
    faster = {name: _faster(pieces, gaits, name) for name in slow}
    return replace(known, pieces=pieces, faster=faster)


def _faster(
    pieces: Mapping[str, Piece], gaits: Sequence[tuple[float, str]], name: str
) -> tuple[str, ...]:
    """Return the gaits with which the way of another can be gone faster, the likest first.

    Those in its own direction come before those for which the body turns; for these it goes ahead,
    and upright.
    """
    own = pieces[name]
    assert own.gait is not None
    same, ahead = [], []
    names = [other for _, other in gaits]
    manner = _manner(pieces, names, name)
    for speed, other in gaits:
        if _manner(pieces, names, other) != manner:
            continue
        piece = pieces[other]
        touching = set(piece.clip.contact_joints) == set(own.clip.contact_joints)
        if (
            not touching
            or _manner(pieces, names, other) != manner
            or speed <= fastest_m_s(own.gait)
        ):
            continue
        if np.cos(piece.direction_rad - own.direction_rad) > ACROSS:
            same.append(other)
        elif np.cos(piece.direction_rad) > ACROSS and _upright(piece, pieces[IDLE]):
            ahead.append(other)
    return *same, *ahead


def _manner(pieces: Mapping[str, Piece], gaits: Sequence[str], name: str) -> str:
    """Return the manner of a gait: ``happy`` of ``walk_happy`` where that goes the way of ``walk``.

    Empty where there is no such other gait: ``walk_backward`` goes another way than ``walk``.
    """
    base, _, word = name.rpartition("_")
    if base not in gaits:
        return ""
    apart_rad = pieces[name].direction_rad - pieces[base].direction_rad
    return word if np.cos(apart_rad) > ACROSS else ""


def _upright(piece: Piece, idle: Piece) -> bool:
    """Return whether a clip holds the body about as high as idling does."""
    if piece.body is None or idle.body is None:
        return True
    return bool(piece.body.centre_m[:, 1].mean() > UPRIGHT * idle.body.centre_m[:, 1].mean())


def _steps(piece: Piece) -> Gait | None:
    """Return the gait of what steps along a path."""
    return piece.gait if piece.gait is not None and piece.gait.passings else None


def _leaving(library: ActionLibrary, rests: set[str]) -> dict[str, str]:
    """Return the action that leads out of each rest: its clip begins there, and ends elsewhere."""
    found = {}
    for rest in sorted(rests):
        first = library.clip(rest).rotation_xyzw[0, 1:]
        for action in library.actions:
            q = library.clip(action.name).rotation_xyzw[:, 1:]
            begins, ends = (np.abs(np.sum(q[i] * first, axis=-1)).min() for i in (0, -1))
            if begins > SAME_POSE > ends:
                found[rest] = action.name
    return found


def piece_of(clip: Clip, *, travels: bool, legs: Sequence[Leg], mass: Mass | None = None) -> Piece:
    """Prepare one clip; parameters as in `pieces_of`."""
    return pieces_of([clip], travels=travels, legs=legs, mass=mass)[0]


def pieces_of(
    clips: Sequence[Clip],
    *,
    travels: bool,
    legs: Sequence[Leg],
    neutral: Piece | None = None,
    mass: Mass | None = None,
) -> list[Piece]:
    """Prepare a clip and its expressions together: as many frames, in which the same feet touch.

    Parameters
    ----------
    clips
        At least one.
    neutral
        What they are expressions of; by default the first of them.
    mass
        Where the body's weight is, if what a clip asks of it is to be known.
    """
    skeleton, rate_hz = clips[0].skeleton, clips[0].rate_hz
    rotation = np.stack([clip.rotation_xyzw for clip in clips], axis=1)
    translation = np.stack([clip.translation_m for clip in clips], axis=1)
    feet, weighing = [leg.foot for leg in legs], [] if mass is None else mass.joints.tolist()
    holds_legs = pelvis_of(skeleton, legs) or 0
    joints = [*feet, holds_legs, *weighing]
    world_q, place_m = joints_in_world(skeleton, joints, rotation, translation)
    count = len(feet)
    foot_q, pelvis_m = world_q[:, :, :count], place_m[:, :, count, 1]
    rests = resting(legs, foot_q, place_m[:, :, :count], rate_hz)
    yaw = np.empty(rests.shape)
    for i, leg in enumerate(legs):
        yaw[..., i] = yaw_of(leg, foot_q[:, :, i])
    roots = ground_roots(rotation[:, :, 0], translation[:, :, 0])
    bodies: Sequence[BodyWork | None] = [None] * len(clips)
    if mass is not None:
        centre_m = mass.mean_m(place_m[:, :, count + 1 :])
        bodies = body_works(translation[:, :, 0], centre_m, rate_hz, travels=travels)
    pieces: list[Piece] = []
    for i, clip in enumerate(clips):
        like = pieces[0] if neutral is None and pieces else neutral
        stands = standing(clip, legs, None if like is None else like.touching, rests[:, i])
        never = np.zeros(len(clip), dtype=bool)
        columns = [stands.get(foot, never) for foot in feet]
        near, swing = _returning(clip, travels=travels) if like is None else _as(like, clip)
        pieces.append(
            Piece(
                clip=clip,
                travels=travels,
                root=roots[i],
                stands=np.reshape(columns, (-1, len(clip))).T.astype(bool),
                yaw_rad=yaw[:, i],
                touching=tuple(stands),
                gait=gait_of(clip, stands) if travels and clip.cyclic else None,
                near=near,
                airborne=_airborne(clip, stands, pelvis_m[:, i]),
                body=bodies[i],
                swing=swing,
            )
        )
    return pieces


def _returning(clip: Clip, *, travels: bool) -> tuple[float, Swing | None]:
    """Return when a neutral clip is near to its last pose, and what it repeats."""
    _, place_m = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    swing = None if travels or clip.cyclic else swing_of(clip, place_m)
    return near_share(clip, place_m[:, to_knuckles(clip.skeleton)]), swing


def _as(neutral: Piece, clip: Clip) -> tuple[float, Swing | None]:
    """Return the same of an expression of a clip."""
    swing = None if neutral.swing is None else expressed(neutral.swing, neutral.clip, clip)
    return neutral.near, swing


def _airborne(clip: Clip, stands: Mapping[int, BoolArray], body_m: FloatArray) -> Airborne | None:
    """Return the flight of a clip that plays once, if it has one.

    Parameters
    ----------
    body_m
        ``(n,)`` height of the joint that holds the legs.
    """
    if clip.cyclic or len(clip) < 3:
        return None
    touches = np.any([clip.contacts.any(axis=1), *stands.values()], axis=0)
    return airborne(body_m, touches)
