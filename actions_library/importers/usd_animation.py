"""The animation that a UsdSkel skeleton is bound to, sampled at the stage's frames."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

from actions_library.importers.imported import Animation, check_poses, rigid
from actions_library.importers.usd_values import numbers, texts
from laban.faults import Fault
from smd.character.tracks import NO_TRACKS, Tracks
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    matrix_from_quaternion,
    normalized,
    sign_continuous,
)

FASTEST_HZ = 240.0
"""Rate at which stages of more time codes per second are sampled."""

_BLOCK = 100_000  # poses that become matrices at once


def read_animation(
    stage: Usd.Stage,
    skeleton: UsdSkel.Skeleton,
    joints: Sequence[str],
    parents: Sequence[int],
    rest: FloatArray,
    change: FloatArray,
    kept: Sequence[str],
    known: Collection[str] | None,
) -> tuple[Animation | None, Tracks, list[str]]:
    """Return the animation if there is one, the weights at rest, and what was left out.

    Parameters
    ----------
    joints, parents, rest
        Paths of the skeleton's joints, their parents' places, and their local matrices at rest.
    change
        ``(4, 4)`` from the file's axes and unit to ours.
    kept
        Names of the blend shapes of the skeleton's meshes; weights of others are left out.
    known
        Those of all of the file's meshes; None where it has no mesh, and all weights are kept.

    Raises
    ------
    Fault
        If it does not fit its joints, or there is a weight without a shape.
    """
    prim = UsdSkel.BindingAPI(skeleton).GetInheritedAnimationSource()
    source = UsdSkel.Animation(prim) if prim else None
    if not source:
        return None, NO_TRACKS, []
    names = texts(source.GetBlendShapesAttr())
    for name in names:
        if known is not None and name not in known:
            raise Fault(f"{prim.GetPath()}.blendShapes", "shapes of its meshes", repr(name)[:60])
    wanted = names if known is None else kept
    attributes = (*_parts_of(source), source.GetBlendShapeWeightsAttr())
    times = sorted({t for attribute in attributes for t in attribute.GetTimeSamples()})
    if len(times) < 2:
        only = np.array(times or [0.0])
        return None, _weights(source, names, only).among(wanted), []
    where = str(prim.GetPath())
    rate_hz, codes = _codes(where, stage, times, len(joints) + len(names))
    own = texts(source.GetJointsAttr())
    moved = _Moved.read(source, own, codes)
    if moved.scale is not None and np.abs(moved.scale).min(initial=1.0) < 1e-6:
        note = f"animation {prim.GetName()!r} scales joints to nothing: left out"
        return None, NO_TRACKS, [note]
    place = {joint: j for j, joint in enumerate(joints)}
    at = [(k, place[joint]) for k, joint in enumerate(own) if joint in place]
    world = _world(skeleton, codes)
    blocks = []
    step = max(_BLOCK // len(joints), 1)
    for first in range(0, len(codes), step):
        rows = slice(first, first + step)
        local = np.tile(rest, (len(codes[rows]), 1, 1, 1))
        local[:, [j for _, j in at]] = moved.matrices(rows)[:, [k for k, _ in at]]
        poses = change @ world[rows if len(world) > 1 else slice(None), None]
        blocks.append(rigid(where, poses @ chained(local, parents), parents))
    rotation = sign_continuous(np.concatenate([q for q, _ in blocks]))
    translation = np.concatenate([t for _, t in blocks])
    weights = _weights(source, names, codes).among(wanted)
    return Animation(prim.GetName(), rate_hz, rotation, translation, weights), NO_TRACKS, []


def chained(local: FloatArray, parents: Sequence[int]) -> FloatArray:
    """Return transforms from the first joint on, ``(…, j, 4, 4)``."""
    found = local.copy()
    for j, parent in enumerate(parents):
        if parent >= 0:
            found[..., j, :, :] = found[..., parent, :, :] @ local[..., j, :, :]
    return found


@dataclass(frozen=True, eq=False)
class _Moved:
    """The parts of an animation's own joints, ``(n, k, c)``; None where it has none of a part."""

    count: int
    frames: int
    translation: FloatArray | None
    rotation: FloatArray | None
    scale: FloatArray | None

    @classmethod
    def read(cls, source: UsdSkel.Animation, joints: Sequence[str], codes: FloatArray) -> _Moved:
        parts = [
            _over_time(attribute, codes, len(joints), width) if joints else None
            for attribute, width in zip(_parts_of(source), (3, 4, 3), strict=True)
        ]
        return cls(len(joints), len(codes), *parts)

    def matrices(self, rows: slice) -> FloatArray:
        """Return some frames' local matrices, ``(n, k, 4, 4)``."""
        count = len(range(*rows.indices(self.frames)))
        found = np.tile(np.eye(4), (count, self.count, 1, 1))
        if self.rotation is not None:
            length = np.linalg.norm(self.rotation[rows], axis=-1, keepdims=True)
            turns = np.where(length > 0.0, self.rotation[rows], IDENTITY_XYZW)
            found[..., :3, :3] = matrix_from_quaternion(normalized(turns))
        if self.scale is not None:
            found[..., :3, :3] *= self.scale[rows][..., None, :]
        if self.translation is not None:
            found[..., :3, 3] = self.translation[rows]
        return found


def _parts_of(source: UsdSkel.Animation) -> tuple[Usd.Attribute, Usd.Attribute, Usd.Attribute]:
    return source.GetTranslationsAttr(), source.GetRotationsAttr(), source.GetScalesAttr()


def _codes(
    where: str, stage: Usd.Stage, times: Sequence[float], joints: int
) -> tuple[float, FloatArray]:
    """Return the rate, and the time code of each frame from the first sample to the last."""
    codes_per_s = stage.GetTimeCodesPerSecond()
    if not (np.isfinite(codes_per_s) and codes_per_s > 0.0):
        raise Fault("timeCodesPerSecond", "a positive number", codes_per_s)
    if not np.isfinite(times).all():
        raise Fault(where, "finite time codes", "another")
    rate_hz = min(codes_per_s, FASTEST_HZ)
    with np.errstate(over="ignore"):
        frames = np.round((times[-1] - times[0]) / codes_per_s * rate_hz) + 1.0
    check_poses(where, max(frames, 2.0), joints)
    steps = np.arange(int(max(frames, 2.0)))
    return rate_hz, np.minimum(times[0] + steps * codes_per_s / rate_hz, times[-1])


def _over_time(
    attribute: Usd.Attribute, codes: FloatArray, count: int, *shape: int
) -> FloatArray | None:
    """Return an attribute's values ``(n, count, *shape)`` at time codes; None without any."""
    frames = len(codes)
    if not attribute.ValueMightBeTimeVarying():
        codes = codes[:1]
    found = [numbers(attribute, *shape, time=float(code)) for code in codes]
    if found[0] is None or not len(found[0]):
        return None
    for code, values in zip(codes, found, strict=True):
        if values is None or len(values) != count or not np.isfinite(values).all():
            place = f"{attribute.GetPath()}, time code {code:g}"
            raise Fault(place, f"{count} finite values", 0 if values is None else len(values))
    values = np.stack([v for v in found if v is not None])
    return np.broadcast_to(values, (frames, *values.shape[1:]))


def _world(skeleton: UsdSkel.Skeleton, codes: FloatArray) -> FloatArray:
    """Return where a skeleton stands in the world, ``(n, 4, 4)``, or ``(1, 4, 4)`` if it stays."""
    prim, moves = skeleton.GetPrim(), False
    while prim:
        moves = moves or UsdGeom.Xformable(prim).TransformMightBeTimeVarying()
        prim = prim.GetParent()
    place = UsdGeom.Xformable(skeleton)
    found = [place.ComputeLocalToWorldTransform(float(c)) for c in (codes if moves else codes[:1])]
    return np.swapaxes(np.array(found, dtype=np.float64), -1, -2)


def _weights(source: UsdSkel.Animation, names: Sequence[str], codes: FloatArray) -> Tracks:
    """Return the weights of blend shapes at time codes; none where the file has none."""
    attribute = source.GetBlendShapeWeightsAttr()
    found = _over_time(attribute, codes, len(names)) if names else None
    return NO_TRACKS if found is None else Tracks(tuple(names), found)
