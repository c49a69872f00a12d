"""USD: UsdSkel skeletons, skinned meshes and joint animation [1]_.

Of several skeletons, that which moves most points is taken, or the one with most joints. Rest
transforms, the skeleton's own place in the world, the up axis and the unit are folded into joints
that stand in metres, +Y up. Attributes are read as they are written; USD's own skeleton queries
are left to the tests.

References
----------
.. [1] OpenUSD, "UsdSkel: Skeleton, Skinning and Animation Schemas",
   https://openusd.org/release/api/usd_skel_page_front.html
"""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
from pxr import Tf, Usd, UsdGeom, UsdShade, UsdSkel

from actions_library.importers.imported import (
    MOST_BYTES,
    MOST_FRAMES,
    Animation,
    Imported,
    bound,
    checked_unit,
    fault,
    rigid,
    skeleton_of,
    strongest,
    to_y_up,
    unique_names,
)
from smd.character.character import Mesh
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import matrix_from_quaternion, normalized

_GREY = (0.8, 0.8, 0.8)
_FASTEST_HZ = 240.0


def read(path: Path, *, up: str | None, unit_m: float | None) -> Imported:
    """Return the skeleton, meshes and animation of a USD file."""
    if path.stat().st_size > MOST_BYTES:
        raise fault(path, "", f"at most {MOST_BYTES} bytes", path.stat().st_size)
    if path.suffix.lower() == ".usdz":
        _check_archive(path)
    try:
        stage = Usd.Stage.Open(str(path), Usd.Stage.LoadAll)
    except Tf.ErrorException as error:
        raise fault(path, "", "a USD file", _first_line(error)) from None
    prims = list(Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()))
    skeletons = [UsdSkel.Skeleton(p) for p in prims if p.IsA(UsdSkel.Skeleton)]
    meshes = [UsdGeom.Mesh(p) for p in prims if p.IsA(UsdGeom.Mesh)]
    skinned = {mesh.GetPath(): _skeleton_of_mesh(mesh) for mesh in meshes}
    if not skeletons:
        raise fault(path, "", "a skeleton", "none")

    def size(skeleton: Any) -> tuple[int, int]:
        own = [m for m in meshes if skinned[m.GetPath()] == skeleton.GetPath()]
        points = sum(len(m.GetPointsAttr().Get() or []) for m in own)
        return points, len(skeleton.GetJointsAttr().Get() or [])

    chosen = max(skeletons, key=size)
    change = np.eye(4)
    axis = up or str(UsdGeom.GetStageUpAxis(stage)).lower()
    unit = UsdGeom.GetStageMetersPerUnit(stage) if unit_m is None else unit_m
    change[:3, :3] = to_y_up(path, axis) * checked_unit(path, unit)
    return _imported(
        path,
        stage,
        chosen,
        [m for m in meshes if skinned[m.GetPath()] == chosen.GetPath()],
        change,
        len(skeletons),
    )


def _imported(
    path: Path, stage: Any, skeleton: Any, meshes: Sequence[Any], change: FloatArray, count: int
) -> Imported:
    paths = [str(joint) for joint in skeleton.GetJointsAttr().Get() or []]
    where = str(skeleton.GetPath())
    valid, why = UsdSkel.Topology(paths).Validate() if paths else (False, "no joints")
    if not valid or len(set(paths)) != len(paths):
        raise fault(path, where, "a tree of joints, parents first", why or "a joint twice")
    parents = [int(i) for i in UsdSkel.Topology(paths).GetParentIndices()]
    rest_local = _matrices(path, skeleton.GetRestTransformsAttr().Get(), len(paths), where, "rest")
    bind = _matrices(path, skeleton.GetBindTransformsAttr().Get(), len(paths), where, "bind")
    world_from_skeleton = _world(skeleton.GetPrim(), Usd.TimeCode.Default())
    rest = change @ world_from_skeleton @ _chained(rest_local, parents)
    here = rest[0] @ np.linalg.inv(bind[0])
    names = [joint.rsplit("/", 1)[-1] for joint in paths]
    own = skeleton.GetPrim().GetAttribute("jointNames").Get()
    if own and len(own) == len(paths):
        names = [str(name) for name in own]
    bind_world = here @ bind
    made = skeleton_of(path, names, parents, rest, bind_world)
    figures, notes = [], []
    for mesh in meshes:
        figures.append(_mesh(path, mesh, paths, here, bind_world))
        if UsdSkel.BindingAPI(mesh).GetBlendShapesAttr().Get():
            notes.append(f"blend shapes of {mesh.GetPath()} are not kept")
    if count > 1:
        notes.append(f"{count - 1} other skeletons are not kept")
    animation = _animation(path, stage, skeleton, paths, parents, rest_local, change)
    names_of = unique_names([figure.name for figure in figures])
    return Imported(
        path,
        made,
        tuple(
            Mesh(name, f.points_m, f.triangles, f.joint_indices, f.joint_weights, f.color_rgb)
            for name, f in zip(names_of, figures, strict=True)
        ),
        () if animation is None else (animation,),
        tuple(notes),
    )


def _check_archive(path: Path) -> None:
    """Refuse an archive whose content is too large, compressed, or leaves its folder."""
    try:
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
    except (zipfile.BadZipFile, OSError) as error:
        raise fault(path, "", "a zip archive", str(error)[:80]) from None
    for entry in entries:
        name = entry.filename
        outside = ".." in PurePosixPath(name).parts or name.startswith("/") or "\\" in name
        if outside or ":" in name:
            raise fault(path, "archive", "files inside it", repr(name)[:80])
        if entry.compress_type != zipfile.ZIP_STORED:
            raise fault(path, f"archive: {name[:60]}", "a file as it is", "a compressed one")
    total = sum(entry.file_size for entry in entries)
    if total > MOST_BYTES:
        raise fault(path, "archive", f"at most {MOST_BYTES} bytes", total)


def _first_line(error: Exception) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[-1][:100] if lines else "something else"


def _skeleton_of_mesh(mesh: Any) -> Any:
    """Return the path of the skeleton that a mesh is bound to; None without one."""
    binding = UsdSkel.BindingAPI(mesh)
    skeleton = binding.GetInheritedSkeleton()
    if not skeleton or not binding.GetJointIndicesPrimvar().HasValue():
        return None
    return skeleton.GetPath()


def _matrices(path: Path, found: Any, count: int, where: str, kind: str) -> FloatArray:
    """Return ``(count, 4, 4)`` matrices that act on columns: USD's act on rows."""
    if found is None or len(found) != count:
        raise fault(path, where, f"{count} {kind} transforms", 0 if found is None else len(found))
    matrices = np.swapaxes(np.array(found, dtype=np.float64), -1, -2)
    if not np.isfinite(matrices).all() or np.abs(np.linalg.det(matrices)).min() < 1e-18:
        raise fault(path, where, f"finite {kind} transforms with an inverse", "another")
    return matrices


def _world(prim: Any, time: Any) -> FloatArray:
    """Return where a prim stands in the world, ``(4, 4)``."""
    matrix = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(time)
    return np.array(matrix, dtype=np.float64).T


def _chained(local: FloatArray, parents: Sequence[int]) -> FloatArray:
    """Return transforms from the first joint on, ``(…, j, 4, 4)``."""
    chained = local.copy()
    for j, parent in enumerate(parents):
        if parent >= 0:
            chained[..., j, :, :] = chained[..., parent, :, :] @ local[..., j, :, :]
    return chained


def _mesh(
    path: Path, mesh: Any, joints: list[str], here: FloatArray, bind_world: FloatArray
) -> Mesh:
    """Return a mesh in the bind pose, its faces cut into triangles."""
    where = str(mesh.GetPath())
    points = np.array(mesh.GetPointsAttr().Get(), dtype=np.float64).reshape(-1, 3)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(), dtype=np.int64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(), dtype=np.int64)
    if not len(points) or not np.isfinite(points).all():
        raise fault(path, where, "finite points", "none, or some that are not")
    if counts.min(initial=0) < 0 or counts.sum() != len(corners) or not len(corners):
        raise fault(path, where, f"{int(counts.sum())} corners of faces", len(corners))
    if corners.min() < 0 or corners.max() >= len(points):
        raise fault(path, where, f"corners below {len(points)}", int(corners.max()))
    indices, weights = _influences(path, mesh, joints, len(points), where)
    binding = UsdSkel.BindingAPI(mesh)
    placed = binding.GetGeomBindTransformAttr().Get()
    matrix = here @ (np.eye(4) if placed is None else np.array(placed, dtype=np.float64).T)
    points = points @ matrix[:3, :3].T + matrix[:3, 3]
    if np.linalg.det(matrix[:3, :3]) < 0.0 or mesh.GetOrientationAttr().Get() == "leftHanded":
        corners, counts = corners[::-1].copy(), counts[::-1]
    # Points are where their joints were bound, which is the bind pose; nothing is to be moved.
    points = bound(points, weights, indices, np.tile(np.eye(4), (len(bind_world), 1, 1)))
    return Mesh(
        name=mesh.GetPrim().GetName(),
        points_m=points,
        triangles=fans(counts, corners),
        joint_indices=indices,
        joint_weights=weights,
        color_rgb=_color(mesh),
    )


def fans(counts: IntArray, corners: IntArray) -> IntArray:
    """Return the triangles ``(t, 3)`` of faces, each cut into a fan from its first corner."""
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    each = np.maximum(counts - 2, 0)
    start = np.repeat(first, each)
    step = np.arange(int(each.sum())) - np.repeat(np.cumsum(each) - each, each)
    return np.stack([corners[start], corners[start + step + 1], corners[start + step + 2]], axis=-1)


def _influences(
    path: Path, mesh: Any, joints: list[str], count: int, where: str
) -> tuple[IntArray, FloatArray]:
    """Return the four strongest joints of each point, among the skeleton's, and their weights."""
    binding = UsdSkel.BindingAPI(mesh)
    indices_of, weights_of = binding.GetJointIndicesPrimvar(), binding.GetJointWeightsPrimvar()
    indices = np.array(indices_of.Get(), dtype=np.int64).ravel()
    weights = np.array(weights_of.Get(), dtype=np.float64).ravel()
    each = indices_of.GetElementSize()
    rigid_mesh = indices_of.GetInterpolation() == UsdGeom.Tokens.constant
    expected = each * (1 if rigid_mesh else count)
    if not (len(indices) == len(weights) == expected) or not expected:
        raise fault(path, where, f"{expected} joint indices and weights", len(indices))
    own = UsdSkel.BindingAPI(mesh).GetJointsAttr().Get()
    order = np.arange(len(joints))
    if own:
        unknown = [str(joint) for joint in own if str(joint) not in joints]
        if unknown:
            raise fault(path, where, "joints of the skeleton", unknown[0][:60])
        order = np.array([joints.index(str(joint)) for joint in own])
    if indices.min() < 0 or indices.max() >= len(order):
        raise fault(path, where, f"joint indices below {len(order)}", int(indices.max()))
    shape = (1 if rigid_mesh else count, each)
    indices, weights = order[indices].reshape(shape), weights.reshape(shape)
    return strongest(
        np.broadcast_to(indices, (count, each)),
        np.nan_to_num(np.broadcast_to(weights, (count, each)), posinf=0.0, neginf=0.0),
    )


def _color(mesh: Any) -> tuple[float, float, float]:
    """Return a mesh's display colour, or its material's."""
    values = mesh.GetDisplayColorPrimvar().Get()
    if values:
        mean = np.clip(np.array(values, dtype=np.float64).reshape(-1, 3).mean(axis=0), 0.0, 1.0)
        return float(mean[0]), float(mean[1]), float(mean[2])
    material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
    surface = material.ComputeSurfaceSource()[0] if material else None
    value = surface.GetInput("diffuseColor") if surface else None
    color = value.Get() if value else None
    if color is None:
        return _GREY
    r, g, b = np.clip(np.array(color, dtype=np.float64), 0.0, 1.0).tolist()
    return r, g, b


def _animation(
    path: Path,
    stage: Any,
    skeleton: Any,
    joints: list[str],
    parents: list[int],
    rest: FloatArray,
    change: FloatArray,
) -> Animation | None:
    """Return the animation that a skeleton is bound to, sampled at the stage's frames."""
    prim = UsdSkel.BindingAPI(skeleton).GetInheritedAnimationSource()
    source = UsdSkel.Animation(prim) if prim else None
    if not source:
        return None
    where = str(prim.GetPath())
    own = [str(joint) for joint in source.GetJointsAttr().Get() or []]
    at = [(k, joints.index(joint)) for k, joint in enumerate(own) if joint in joints]
    attributes = (source.GetTranslationsAttr(), source.GetRotationsAttr(), source.GetScalesAttr())
    times = sorted({t for attribute in attributes for t in attribute.GetTimeSamples()})
    if not at or len(times) < 2:
        return None
    codes_per_s = stage.GetTimeCodesPerSecond()
    duration_s = (times[-1] - times[0]) / codes_per_s
    rate_hz = min(codes_per_s, _FASTEST_HZ)
    frames = max(round(duration_s * rate_hz), 1) + 1
    if not np.isfinite(duration_s) or frames > MOST_FRAMES:
        raise fault(path, where, f"at most {MOST_FRAMES} frames", frames)
    local = np.tile(rest, (frames, 1, 1, 1))
    for i in range(frames):
        code = min(times[0] + i * codes_per_s / rate_hz, times[-1])
        values = [attribute.Get(code) for attribute in attributes]
        parts = [_part(path, v, len(own), where, code) for v in values]
        for k, j in at:
            local[i, j] = _transform(*(None if part is None else part[k] for part in parts))
    world = np.stack(
        [_world(skeleton.GetPrim(), times[0] + i * codes_per_s / rate_hz) for i in range(frames)]
    )
    poses = change @ world[:, None] @ _chained(local, parents)
    rotation, translation = rigid(path, where, poses, parents)
    return Animation(prim.GetName(), rate_hz, rotation, translation)


def _part(path: Path, value: Any, count: int, where: str, code: float) -> FloatArray | None:
    """Return one attribute's numbers at a time, a row a joint; quaternions as xyzw."""
    if value is None or len(value) == 0:
        return None
    # In memory a quaternion lies as x, y, z, w.
    numbers = np.array(value, dtype=np.float64)
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise fault(path, f"{where}, time code {code:g}", f"{count} finite values", len(numbers))
    return numbers


def _transform(
    translation: FloatArray | None, rotation: FloatArray | None, scale: FloatArray | None
) -> FloatArray:
    matrix = np.eye(4)
    if rotation is not None:
        matrix[:3, :3] = matrix_from_quaternion(normalized(rotation))
    if scale is not None:
        matrix[:3, :3] *= scale
    if translation is not None:
        matrix[:3, 3] = translation
    return matrix
