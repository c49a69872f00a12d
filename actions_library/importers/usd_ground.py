"""A ground to walk on, from the meshes of a USD file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Tf, Usd, UsdGeom

from actions_library.importers.imported import checked_unit, to_y_up
from actions_library.importers.usd_layers import check_layers, check_used, first_line
from actions_library.importers.usd_meshes import fans
from actions_library.importers.usd_values import numbers
from laban.faults import Fault, naming
from smd.acting.terrain import Terrain
from smd.errors import ImportedFileError
from smd.geometry.arrays import FloatArray, IntArray


def read_terrain(path: Path | str) -> Terrain:
    """Read a terrain from all visible meshes of a USD file.

    Wherever the file's up axis, unit, transforms and orientation have them, they become metres,
    +Y up, counter-clockwise from outside. Guides, proxies and what is invisible are left out. The
    terrain's origin is the scene's: the middle of the devices' first places.

    Raises
    ------
    ImportedFileError
        If it is no USD file, or holds no mesh of finite points.
    TransferError
        If no part of it is level enough to stand on.
    """
    path = Path(path)
    with naming(path, ImportedFileError):
        if not path.is_file():
            raise Fault("", "a USD file", "none")
        check_layers(path)
        try:
            stage = Usd.Stage.Open(str(path), Usd.Stage.LoadAll)
            check_used(path, stage)
            points_m, triangles = _read(stage)
        except (Tf.ErrorException, UnicodeDecodeError) as error:
            raise Fault("", "a USD file", first_line(error)) from None
    return Terrain(points_m, triangles, name=str(path))


def _read(stage: Usd.Stage) -> tuple[FloatArray, IntArray]:
    """Return the points ``(v, 3)`` and triangles ``(t, 3)`` of what is seen, in our frame."""
    change = to_y_up(str(UsdGeom.GetStageUpAxis(stage)).lower()) * checked_unit(
        UsdGeom.GetStageMetersPerUnit(stage)
    )
    cache = UsdGeom.XformCache()
    points, triangles, count = [], [], 0
    for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
        if not prim.IsA(UsdGeom.Mesh) or not is_seen(UsdGeom.Imageable(prim)):
            continue
        matrix = np.array(cache.GetLocalToWorldTransform(prim))  # of rows
        own, faces = mesh_of(UsdGeom.Mesh(prim))
        points.append((own @ matrix[:3, :3] + matrix[3, :3]) @ change.T)
        mirrored = np.linalg.det(matrix[:3, :3]) < 0.0
        triangles.append((faces[:, ::-1] if mirrored else faces) + count)
        count += len(own)
    if not count or not sum(map(len, triangles)):
        raise Fault("", "a mesh to walk on", "none")
    return np.concatenate(points), np.concatenate(triangles)


def is_seen(prim: UsdGeom.Imageable) -> bool:
    """Return whether a prim is visible, and meant to be."""
    hidden = prim.ComputeVisibility() == UsdGeom.Tokens.invisible
    return not hidden and prim.ComputePurpose() in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)


def mesh_of(mesh: UsdGeom.Mesh, code: float | None = None) -> tuple[FloatArray, IntArray]:
    """Return a mesh's points, by default or at a time code, and its faces as triangles."""
    where = str(mesh.GetPath())
    points = numbers(mesh.GetPointsAttr(), 3, time=code)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get() or [], dtype=np.int64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get() or [], dtype=np.int64)
    if points is None or not len(points):
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    if not np.isfinite(points).all():
        raise Fault(where, "finite points", "others")
    if counts.sum() != len(corners) or (counts < 0).any():
        raise Fault(where, f"{counts.sum()} corners of faces", len(corners))
    if len(corners) and (corners.min() < 0 or corners.max() >= len(points)):
        raise Fault(where, f"corners from 0 to {len(points) - 1}", "others")
    triangles = fans(counts, corners)
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        triangles = triangles[:, ::-1]
    return points, triangles
