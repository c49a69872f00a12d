"""From keys, waves and plants to a clip, for any rig."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from actions_library.authoring.feet import FootPath, Plant, foot_path
from actions_library.authoring.keys import Numbers
from actions_library.authoring.legs import RigLeg, foot_shape, pose_leg
from actions_library.authoring.pose import Pose
from actions_library.authoring.posing import RATE_HZ, RootCourse
from actions_library.authoring.rig import BODY, PLACE, Chain, Rig
from actions_library.authoring.rig_keys import RigKey, parts_named, rig_curve, track_curves
from actions_library.authoring.waves import Wave
from smd.character.clip import Clip
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    normalized,
    quaternion_about,
    quaternion_from_euler,
    rotate,
    slerp,
)

MOST_SHORT_M = 0.004
"""How far a planted foot may be from where it is put before a clip is refused."""


def make_rig_clip(
    rig: Rig,
    name: str,
    keys: Sequence[RigKey],
    ground: RootCourse,
    *,
    plants: Mapping[str, Sequence[Plant]] | None = None,
    waves: Sequence[Wave] = (),
    laid: Mapping[str, FloatArray] | None = None,
    stage_ends_s: Sequence[float],
    cyclic: bool = False,
) -> Clip:
    """Pose a rig at every frame and return the clip.

    Parts without keys stay at rest; waves are added to the turns of their chains. Nothing is
    corrected: the body is where its keys say, and its feet must be within reach.

    Parameters
    ----------
    keys
        Of the rig's parts, by their names. A leg needs one where it has no plants, or plants
        between which it swings by its own keys.
    ground
        Its length is the clip's. A cyclic clip's ``place`` is carried along by it.
    plants
        Each leg's, by its name, in the clip's world, covering the clip's time.
    laid
        Places that a chain's joints are put at, whatever their bones' lengths, and one that its
        last joint points to: ``(frames, joints + 1, 3)`` in the clip's world. It has neither keys
        nor waves.
    stage_ends_s
        When each of the five stages ends; the last is the clip's end.

    Raises
    ------
    ValueError
        If a name is none of the rig's parts, or a planted foot is out of its leg's reach.
    """
    plants, laid = plants or {}, laid or {}
    chains = {chain.name: chain for chain in rig.chains}
    legs = {leg.name: leg for leg in rig.legs}
    _check_names("keys", parts_named(keys), (PLACE, BODY, *chains, *legs, *rig.tracks))
    _check_names("plants", plants, legs)
    _check_names("waves", [wave.chain for wave in waves], chains)
    _check_names("laid", laid, chains)
    frames = len(ground.yaw_rad)
    time_s = np.arange(frames) / RATE_HZ
    pose = Pose(rig.skeleton, frames)
    numbers: Numbers = {
        part: curve
        for part in (PLACE, BODY, *legs)
        if (curve := rig_curve(keys, part, frames, RATE_HZ, cyclic=cyclic)) is not None
    }
    _pose_body(pose, rig, numbers, ground, carried=cyclic)
    posed = {"", rig.skeleton.joints[0], rig.body}
    for chain in rig.chains:
        _rest_above(pose, chain.joints[0], posed)
        if chain.name in laid:
            _lay_chain(pose, chain, laid[chain.name])
        else:
            _pose_chain(pose, chain, _chain_turns(chain, keys, waves, frames, cyclic=cyclic))
        posed.update(chain.joints)
    paths = {
        leg: foot_path(list(plants[leg]), foot_shape(rig.skeleton, legs[leg]), out, time_s)
        for leg, out in ((leg.name, leg.out) for leg in rig.legs)
        if plants.get(leg)
    }
    for leg in rig.legs:
        _rest_above(pose, leg.blade or leg.upper, posed)
        path = paths.get(leg.name)
        pose_leg(pose, leg, numbers.get(leg.name), path)
        posed.update((leg.blade, leg.upper, leg.lower, leg.foot, leg.toes))
        if path is not None:
            _check_reach(pose, leg, path, name)
    for joint in rig.skeleton.joints:
        _rest_above(pose, joint, posed)
        if joint not in posed:
            pose.turn(joint, np.tile([0.0, 0.0, 0.0, 1.0], (frames, 1)))
            posed.add(joint)
    contacts = {}
    for leg in rig.legs:
        if path := paths.get(leg.name):
            down = {leg.foot: path.sole_down, leg.toes: path.toes_down}
            contacts.update({joint: down[joint] for joint in leg.touching})
    rotation, translation = pose.local()
    return Clip(
        name=name,
        skeleton=rig.skeleton,
        rate_hz=RATE_HZ,
        rotation_xyzw=rotation,
        translation_m=translation,
        stage_end_frames=np.round(np.asarray(stage_ends_s) * RATE_HZ).astype(np.int64),
        contact_joints=tuple(contacts),
        contacts=np.array(list(contacts.values()), dtype=bool).reshape(-1, frames).T,
        cyclic=cyclic,
        tracks=Tracks(rig.tracks, track_curves(keys, rig.tracks, frames, RATE_HZ, cyclic=cyclic)),
    )


def at_half_rate(clip: Clip) -> Clip:
    """Return a clip of every second frame, for what is slow enough; it has an odd number of them.

    Raises
    ------
    ValueError
        If its last frame would be left out.
    """
    if len(clip) % 2 == 0:
        raise ValueError(f"{clip.name}: expected an odd number of frames, got {len(clip)}")
    return Clip(
        name=clip.name,
        skeleton=clip.skeleton,
        rate_hz=0.5 * clip.rate_hz,
        rotation_xyzw=clip.rotation_xyzw[::2],
        translation_m=clip.translation_m[::2],
        stage_end_frames=np.round(0.5 * clip.stage_end_frames).astype(np.int64),
        contact_joints=clip.contact_joints,
        contacts=clip.contacts[::2],
        cyclic=clip.cyclic,
        tracks=Tracks(clip.tracks.names, clip.tracks.value[::2]),
    )


def _check_names(what: str, found: Iterable[str], known: Iterable[str]) -> None:
    known = tuple(known)
    for name in found:
        if name not in known:
            raise ValueError(f"{what}: expected parts of the rig ({', '.join(known)}), got {name}")


def _rest_above(pose: Pose, joint: str, posed: set[str]) -> None:
    """Pose what holds a joint and has not been posed: as at rest."""
    parent = int(pose.skeleton.parents[pose.skeleton.index(joint)])
    above = pose.skeleton.joints[parent] if parent >= 0 else ""
    if above not in posed:
        _rest_above(pose, above, posed)
        pose.turn(above, np.tile([0.0, 0.0, 0.0, 1.0], (len(pose.rotation), 1)))
        posed.add(above)


def _pose_body(
    pose: Pose, rig: Rig, numbers: Numbers, ground: RootCourse, *, carried: bool
) -> None:
    """Stand on the ground's course, and place and turn the body about its pivot."""
    zero = np.zeros_like(ground.left_m)
    way = np.column_stack([ground.left_m, zero, ground.ahead_m])
    pose.rotation[:, 0] = quaternion_about([0.0, 1.0, 0.0], ground.yaw_rad)
    pose.position[:, 0] = way
    j = rig.skeleton.index(rig.body)
    pivot = np.array(rig.pivot_m)
    turn = _turn(numbers.get(BODY, np.zeros((len(way), 3))))
    place = numbers.get(PLACE, np.zeros((len(way), 3))) + (way if carried else 0.0)
    pose.rotation[:, j] = turn
    rest = rig.skeleton.world_from_bind[j, :3, 3] + pivot
    pose.position[:, j] = rest + place - rotate(turn, pivot)


def _chain_turns(
    chain: Chain, keys: Sequence[RigKey], waves: Sequence[Wave], frames: int, *, cyclic: bool
) -> FloatArray:
    """Return what turns each joint of a chain, ``(frames, joints, 3)``: yaw, lean, tilt (°)."""
    turns = np.zeros((frames, len(chain.joints), 3))
    for k in range(len(chain.joints)):
        lag_s = k * chain.lag_s
        curve = rig_curve(keys, chain.name, frames, RATE_HZ, cyclic=cyclic, lag_s=lag_s)
        if curve is not None:
            turns[:, k] = curve if chain.steady else chain.share(k) * curve
    for wave in waves:
        if wave.chain == chain.name:
            turns += wave.turns_deg(len(chain.joints), frames, RATE_HZ, cyclic=cyclic)
    return turns


def _pose_chain(pose: Pose, chain: Chain, turns_deg: FloatArray) -> None:
    """Turn a chain's joints, each from the one before it, or all toward a turn in the world."""
    holder = pose.parent_rotation(chain.joints[0])
    gone = 0.0
    for k, joint in enumerate(chain.joints):
        turn = _turn(turns_deg[:, k])
        if chain.steady:
            gone += chain.share(k)
            pose.set(joint, slerp(holder, turn, np.full(len(turn), min(gone, 1.0))))
        else:
            pose.turn(joint, turn)


def _lay_chain(pose: Pose, chain: Chain, points: FloatArray) -> None:
    """Put a chain's joints at points, each turned so that its +Z points to the next."""
    to = normalized(np.diff(points, axis=1))
    zero = np.zeros(to.shape[:2])
    angles = np.stack([np.arctan2(to[..., 0], to[..., 2]), -np.arcsin(to[..., 1]), zero], axis=-1)
    turned = quaternion_from_euler("YXZ", angles)
    for k, joint in enumerate(chain.joints):
        pose.put(joint, turned[:, k], points[:, k])


def _check_reach(pose: Pose, leg: RigLeg, path: FootPath, clip: str) -> None:
    """Raise ValueError where a foot that stands is not where it was put."""
    foot = pose.position[:, pose.skeleton.index(leg.foot)]
    short_m = np.linalg.norm(foot - path.ankle_m, axis=1) * (path.toes_down & (path.free == 0.0))
    worst = int(np.argmax(short_m))
    if short_m[worst] > MOST_SHORT_M:
        raise ValueError(
            f"{clip}: {leg.name}: expected feet within reach, fell {1e3 * short_m[worst]:.0f} mm "
            f"short at {worst / RATE_HZ:.2f} s"
        )


def _turn(yaw_lean_tilt_deg: FloatArray) -> FloatArray:
    return quaternion_from_euler("YXZ", np.radians(yaw_lean_tilt_deg))
