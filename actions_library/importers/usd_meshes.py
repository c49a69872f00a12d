"""The meshes that a UsdSkel skeleton moves, in its bind pose, with their blend shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from pxr import Sdf, UsdGeom, UsdShade, UsdSkel

from actions_library.importers.imported import (
    MOST_POINTS,
    MOST_TRIANGLES,
    strongest,
    unique_names,
)
from actions_library.importers.usd_shapes import ShapeReader
from actions_library.importers.usd_values import extremes, numbers, texts, whole_numbers
from laban.faults import Fault
from smd.character.character import Mesh
from smd.geometry.arrays import FloatArray, IntArray

_GREY = (0.8, 0.8, 0.8)


def read_meshes(
    meshes: Sequence[UsdGeom.Mesh], joints: Sequence[str], here: FloatArray
) -> tuple[tuple[Mesh, ...], list[str]]:
    """Return the meshes, and what of their blend shapes was left out.

    Parameters
    ----------
    joints
        Paths of the skeleton's joints.
    here
        ``(4, 4)`` from where they were bound to our world.
    """
    names = unique_names([mesh.GetPrim().GetName() for mesh in meshes])
    figures: list[Mesh] = []
    reader = ShapeReader()
    for name, mesh in zip(names, meshes, strict=True):
        figures.append(_mesh(name, mesh, joints, here, reader))
        points = sum(len(figure.points_m) for figure in figures)
        faces = sum(len(figure.triangles) for figure in figures)
        if points > MOST_POINTS or faces > MOST_TRIANGLES:
            most = f"at most {MOST_POINTS} points and {MOST_TRIANGLES} triangles in all"
            raise Fault(str(mesh.GetPath()), most, f"{points} and {faces}")
    return tuple(figures), reader.notes


def skeleton_of_mesh(mesh: UsdGeom.Mesh) -> Sdf.Path | None:
    """Return the path of the skeleton that a mesh is bound to; None without one."""
    binding = UsdSkel.BindingAPI(mesh)
    skeleton = binding.GetInheritedSkeleton()
    if not skeleton or not binding.GetJointIndicesPrimvar().HasValue():
        return None
    return skeleton.GetPath()


def _mesh(
    name: str,
    mesh: UsdGeom.Mesh,
    joints: Sequence[str],
    here: FloatArray,
    reader: ShapeReader,
) -> Mesh:
    """Return a mesh in the bind pose, its faces cut into triangles."""
    where = str(mesh.GetPath())
    points = numbers(mesh.GetPointsAttr(), 3)
    if points is None or not len(points) or not np.isfinite(points).all():
        raise Fault(where, "finite points", "none, or some that are not")
    counts = whole_numbers(mesh.GetFaceVertexCountsAttr())
    corners = whole_numbers(mesh.GetFaceVertexIndicesAttr())
    if counts.min(initial=0) < 0 or counts.sum() != len(corners) or not len(corners):
        raise Fault(where, f"{int(counts.sum())} corners of faces", len(corners))
    if corners.min() < 0 or corners.max() >= len(points):
        raise Fault(where, f"corners from 0 to {len(points) - 1}", extremes(corners))
    indices, weights = _influences(mesh, joints, len(points), where)
    placed = UsdSkel.BindingAPI(mesh).GetGeomBindTransformAttr()
    matrix = here @ (numbers_of_one(placed, 4, 4, default=np.eye(4)).T)
    points = points @ matrix[:3, :3].T + matrix[:3, 3]
    if not np.isfinite(points).all():
        raise Fault(where, "a finite geomBindTransform", "another")
    mirrored = np.linalg.det(matrix[:3, :3]) < 0.0
    if mirrored != (str(mesh.GetOrientationAttr().Get()) == "leftHanded"):
        corners, counts = corners[::-1].copy(), counts[::-1]
    shapes = tuple(
        replace(shape, offsets_m=shape.offsets_m @ matrix[:3, :3].T)
        for shape in reader.shapes(mesh, len(points))
    )
    return Mesh(name, points, fans(counts, corners), indices, weights, _color(mesh), shapes)


def numbers_of_one(attribute: object, *shape: int, default: FloatArray) -> FloatArray:
    """Return the finite value of an attribute that holds one of a shape, or a default."""
    value = attribute.Get() if attribute else None  # type: ignore[attr-defined]
    if value is None:
        return default
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != shape or not np.isfinite(array).all():
        expected = f"{' times '.join(map(str, shape))} finite numbers"
        raise Fault(str(attribute.GetPath()), expected, repr(value)[:60])  # type: ignore[attr-defined]
    return array


def fans(counts: IntArray, corners: IntArray) -> IntArray:
    """Return the triangles ``(t, 3)`` of faces, each cut into a fan from its first corner."""
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    each = np.maximum(counts - 2, 0)
    start = np.repeat(first, each)
    step = np.arange(int(each.sum())) - np.repeat(np.cumsum(each) - each, each)
    return np.stack([corners[start], corners[start + step + 1], corners[start + step + 2]], axis=-1)


def _influences(
    mesh: UsdGeom.Mesh, joints: Sequence[str], count: int, where: str
) -> tuple[IntArray, FloatArray]:
    """Return the four strongest joints of each point, among the skeleton's, and their weights."""
    binding = UsdSkel.BindingAPI(mesh)
    primvar = binding.GetJointIndicesPrimvar()
    indices = whole_numbers(primvar.GetAttr())
    found = numbers(binding.GetJointWeightsPrimvar().GetAttr())
    weights = np.empty(0) if found is None else found
    each = primvar.GetElementSize()
    rigid_mesh = primvar.GetInterpolation() == UsdGeom.Tokens.constant
    rows = 1 if rigid_mesh else count
    if each < 1 or not (len(indices) == len(weights) == each * rows):
        expected = f"{each * rows} joint indices and weights"
        raise Fault(where, expected, f"{len(indices)} and {len(weights)}")
    own = texts(binding.GetJointsAttr()) or list(joints)
    place = {joint: j for j, joint in enumerate(joints)}
    unknown = [joint for joint in own if joint not in place]
    if unknown:
        raise Fault(where, "joints of the skeleton", unknown[0][:60])
    if indices.min() < 0 or indices.max() >= len(own):
        raise Fault(where, f"joint indices from 0 to {len(own) - 1}", extremes(indices))
    order = np.array([place[joint] for joint in own])
    known = np.nan_to_num(weights, posinf=0.0, neginf=0.0).reshape(rows, each)
    first, share = strongest(order[indices].reshape(rows, each), known)
    wide = (count, first.shape[1])
    return np.broadcast_to(first, wide).copy(), np.broadcast_to(share, wide).copy()


def _color(mesh: UsdGeom.Mesh) -> tuple[float, float, float]:
    """Return a mesh's display colour, or its material's."""
    values = numbers(mesh.GetDisplayColorAttr(), 3)
    if values is not None and len(values):
        found = values.mean(axis=0)
    else:
        material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
        surface = material.ComputeSurfaceSource()[0] if material else None
        diffuse = surface.GetInput("diffuseColor") if surface else None
        found = numbers_of_one(diffuse and diffuse.GetAttr(), 3, default=np.array(_GREY))
    r, g, b = np.clip(np.nan_to_num(found), 0.0, 1.0).tolist()
    return r, g, b
