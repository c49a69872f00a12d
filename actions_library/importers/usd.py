"""USD: UsdSkel skeletons, skinned meshes and joint animation [1]_.

Of several skeletons, one is taken by its name, or that which moves most points, or the one with
most joints. Rest
transforms, the skeleton's own place in the world, the up axis and the unit are folded into joints
that stand in metres, +Y up. Attributes are read as they are written; USD's own skeleton queries
are left to the tests.

References
----------
.. [1] OpenUSD, "UsdSkel: Skeleton, Skinning and Animation Schemas",
   https://openusd.org/release/api/usd_skel_page_front.html
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np
from pxr import Tf, Usd, UsdGeom, UsdSkel

from actions_library.importers.format import ImportOptions
from actions_library.importers.imported import (
    Imported,
    checked_unit,
    skeleton_of,
    to_y_up,
)
from actions_library.importers.usd_animation import chained, read_animation
from actions_library.importers.usd_layers import check_layers, check_used, first_line
from actions_library.importers.usd_meshes import read_meshes, skeleton_of_mesh
from actions_library.importers.usd_shapes import names_of_shapes
from actions_library.importers.usd_values import numbers, texts
from laban.faults import Fault
from smd.character.character import shape_names
from smd.geometry.arrays import FloatArray


def read(path: Path, asked: ImportOptions) -> Imported:
    """Return a skeleton, its meshes and its animation from a USD file."""
    check_layers(path)
    try:
        stage = Usd.Stage.Open(str(path), Usd.Stage.LoadAll)
        check_used(path, stage)
        return _read(path, stage, asked)
    # A crate's values are unpacked when they are asked for, and damage shows only then.
    except (Tf.ErrorException, UnicodeDecodeError) as error:
        raise Fault("", "a USD file", first_line(error)) from None


def _read(path: Path, stage: Usd.Stage, asked: ImportOptions) -> Imported:
    prims = list(Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()))
    meshes = [UsdGeom.Mesh(p) for p in prims if p.IsA(UsdGeom.Mesh)]
    skeletons = [UsdSkel.Skeleton(p) for p in prims if p.IsA(UsdSkel.Skeleton)]
    chosen = _chosen(skeletons, meshes, asked.skeleton)
    change = np.eye(4)
    axis = asked.up or str(UsdGeom.GetStageUpAxis(stage)).lower()
    unit = UsdGeom.GetStageMetersPerUnit(stage) if asked.unit_m is None else asked.unit_m
    change[:3, :3] = to_y_up(axis) * checked_unit(unit)
    bound = [mesh for mesh in meshes if skeleton_of_mesh(mesh) == chosen.GetPath()]
    known = names_of_shapes(meshes) if meshes else None
    return _imported(path, stage, chosen, bound, known, change, len(skeletons))


def _chosen(
    skeletons: Sequence[UsdSkel.Skeleton],
    meshes: Sequence[UsdGeom.Mesh],
    name: str | None,
) -> UsdSkel.Skeleton:
    """Return the skeleton of a name or path, or the one that moves most."""
    if not skeletons:
        raise Fault("", "a skeleton", "none")
    if name is not None:
        for skeleton in skeletons:
            if name in (str(skeleton.GetPath()), skeleton.GetPrim().GetName()):
                return skeleton
        known = ", ".join(str(skeleton.GetPath()) for skeleton in skeletons)
        raise Fault("skeleton", f"one of {known[:300]}", repr(name)[:80])

    def size(skeleton: UsdSkel.Skeleton) -> tuple[int, int]:
        own = [m for m in meshes if skeleton_of_mesh(m) == skeleton.GetPath()]
        points = [numbers(mesh.GetPointsAttr(), 3) for mesh in own]
        joints = texts(skeleton.GetJointsAttr())
        return sum(0 if p is None else len(p) for p in points), len(joints)

    return max(skeletons, key=size)


def _imported(
    path: Path,
    stage: Usd.Stage,
    skeleton: UsdSkel.Skeleton,
    meshes: Sequence[UsdGeom.Mesh],
    known: Collection[str] | None,
    change: FloatArray,
    count: int,
) -> Imported:
    paths = texts(skeleton.GetJointsAttr())
    where = str(skeleton.GetPath())
    valid, why = UsdSkel.Topology(paths).Validate() if paths else (False, "no joints")
    if not valid or len(set(paths)) != len(paths):
        raise Fault(where, "a tree of joints, parents first", why or "a joint twice")
    parents = [int(i) for i in UsdSkel.Topology(paths).GetParentIndices()]
    rest_local = _matrices(skeleton.GetRestTransformsAttr(), len(paths), "rest")
    bind = _matrices(skeleton.GetBindTransformsAttr(), len(paths), "bind")
    names = texts(skeleton.GetJointNamesAttr())
    if len(names) != len(paths):
        names = [joint.rsplit("/", 1)[-1] for joint in paths]
    world = np.array(
        UsdGeom.Xformable(skeleton).ComputeLocalToWorldTransform(Usd.TimeCode.Default())
    ).T
    rest = change @ world @ chained(rest_local, parents)
    here = rest[0] @ np.linalg.inv(bind[0])
    bind_world = here @ bind
    made = skeleton_of(names, parents, rest, bind_world)
    figures, left_out = read_meshes(meshes, paths, here)
    animation, resting, notes = read_animation(
        stage, skeleton, paths, parents, rest_local, change, shape_names(figures), known
    )
    if count > 1:
        notes.append(f"{count - 1} other skeletons are not kept")
    found = () if animation is None else (animation,)
    return Imported(path, made, figures, found, (*left_out, *notes), resting)


def _matrices(attribute: Usd.Attribute, count: int, kind: str) -> FloatArray:
    """Return ``(count, 4, 4)`` matrices that act on columns: USD's act on rows."""
    found = numbers(attribute, 4, 4)
    where = str(attribute.GetPrim().GetPath())
    if found is None or len(found) != count:
        raise Fault(where, f"{count} {kind} transforms", 0 if found is None else len(found))
    matrices = np.swapaxes(found, -1, -2)
    if not np.isfinite(matrices).all() or np.abs(np.linalg.det(matrices)).min() < 1e-18:
        raise Fault(where, f"finite {kind} transforms with an inverse", "another")
    return matrices
