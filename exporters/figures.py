"""Skinned characters, read back from any UsdSkel file with USD's own skinning.

The pictures are drawn from the file that was written, by another reader than the code that
wrote it: what they show is what other programs will find.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Tf, Usd, UsdGeom, UsdShade, UsdSkel

from exporters.palette import RGB, srgb_from_linear
from exporters.performer import DEVICE_KEY
from exporters.phrases import phrases_of
from exporters.usd import START_KEY, places
from smd.errors import ExportError
from smd.geometry.arrays import FloatArray
from smd.score import Phrase

_PLAIN_RGB: RGB = (0.20, 0.55, 0.53)


@dataclass(frozen=True, eq=False)
class Figure:
    """One skinned character of a USD stage.

    Attributes
    ----------
    name : its device where we wrote it, else its prim's name.
    triangles : (t, 3) int64 over the points of all its meshes.
    point_rgb : (p, 3) sRGB, each in [0, 1].
    joint_count : of its skeleton.
    phrases : what it performs, where the file says so; in time order.
    """

    name: str
    triangles: NDArray[np.int64]
    point_rgb: FloatArray
    joint_count: int
    phrases: tuple[Phrase, ...]
    _stage: Usd.Stage
    _skeleton: Any
    _targets: tuple[Any, ...]
    _prop: Any

    def points_m(self, time_code: float) -> FloatArray:
        """Return the positions of the points, ``(p, 3)``, metres, Y up."""
        transforms = self._skeleton.ComputeSkinningTransforms(time_code)
        animation = self._skeleton.GetAnimQuery()
        weights = animation.ComputeBlendShapeWeights(time_code) if animation else None
        world = self._world(time_code)
        return (
            np.concatenate(
                [_skinned(target, transforms, weights, time_code) for target in self._targets]
            )
            @ world[:3, :3]
            + world[3, :3]
        )

    def joints_m(self, time_code: float) -> FloatArray:
        """Return the positions of the joints, ``(j, 3)``, metres, Y up."""
        transforms = np.array(self._skeleton.ComputeJointSkelTransforms(time_code))
        world = self._world(time_code)
        return np.asarray(transforms[:, 3, :3] @ world[:3, :3] + world[3, :3])

    def front(self, time_code: float) -> FloatArray:
        """Return which way the body faces, ``(3,)``, not of unit length.

        The mean over the joints of where each has turned what was to the front when it was
        bound; characters are bound facing +Z.
        """
        turns = np.array(self._skeleton.ComputeSkinningTransforms(time_code))[:, :3, :3]
        world = self._world(time_code)[:3, :3]
        front_of_bind = np.array([0.0, 0.0, 1.0]) @ np.linalg.inv(world)
        return np.asarray((front_of_bind @ turns).mean(axis=0) @ world)

    def prop_m(self, time_code: float) -> FloatArray | None:
        """Return the position of its prop, ``(3,)``, metres, Y up; None where the file has none."""
        if not self._prop:
            return None
        world = np.array(self._prop.ComputeLocalToWorldTransform(time_code))
        return np.asarray((world @ _to_our_axes(self._stage))[3, :3])

    def _world(self, time_code: float) -> FloatArray:
        """Return the transform from the skeleton's space to metres, Y up, for row vectors."""
        prim = UsdGeom.Imageable(self._skeleton.GetPrim())
        world = np.array(prim.ComputeLocalToWorldTransform(time_code))
        return np.asarray(world @ _to_our_axes(self._stage))


@dataclass(frozen=True, eq=False)
class Scene:
    """The characters of a USD file, and what the file says about their performance.

    Attributes
    ----------
    figures : in the file's order.
    rate_hz : time codes a second.
    first_s, last_s : time of the first and the last time code, on the recording's clock.
    start_code : the first time code.
    """

    figures: tuple[Figure, ...]
    rate_hz: float
    first_s: float
    last_s: float
    start_code: float

    def time_code(self, time_s: float) -> float:
        """Return the time code of a time on the recording's clock, within the file's range."""
        within_s = min(max(time_s, self.first_s), self.last_s)
        return self.start_code + (within_s - self.first_s) * self.rate_hz


def read_scene(path: Path) -> Scene:
    """Return the characters of a USD file.

    Raises
    ------
    ExportError
        If the file is not USD, or no skinned character is in it.
    """
    if not path.is_file():
        raise ExportError(f"{path}: expected a USD file, found none")
    try:
        stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        raise ExportError(f"{path}: expected a USD file, got something else") from error
    try:
        figures = tuple(_figures(stage))
    except ExportError as error:
        raise ExportError(f"{path}: {error}") from error
    if not figures:
        raise ExportError(f"{path}: expected a skinned character (UsdSkel), found none")
    data = stage.GetRootLayer().customLayerData
    rate_hz = stage.GetTimeCodesPerSecond()
    start_s = float(data.get(START_KEY, stage.GetStartTimeCode() / rate_hz))
    span = stage.GetEndTimeCode() - stage.GetStartTimeCode()
    return Scene(
        figures=figures,
        rate_hz=rate_hz,
        first_s=start_s,
        last_s=start_s + span / rate_hz,
        start_code=stage.GetStartTimeCode(),
    )


def _figures(stage: Usd.Stage) -> list[Figure]:
    cache, figures = UsdSkel.Cache(), []
    for prim in stage.Traverse():
        if not prim.IsA(UsdSkel.Root):
            continue
        root = UsdSkel.Root(prim)
        cache.Populate(root, Usd.PrimDefaultPredicate)
        for binding in cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate):
            targets = [t for t in binding.GetSkinningTargets() if t.GetPrim().IsA(UsdGeom.Mesh)]
            if targets:
                skeleton = cache.GetSkelQuery(binding.GetSkeleton())
                figures.append(_figure(stage, prim, skeleton, targets))
    return figures


def _figure(stage: Usd.Stage, root: Usd.Prim, skeleton: Any, targets: list[Any]) -> Figure:
    triangles, colors, count = [], [], 0
    for target in targets:
        mesh = UsdGeom.Mesh(target.GetPrim())
        size = len(mesh.GetPointsAttr().Get())
        triangles.append(_triangulated(mesh) + count)
        colors.append(np.tile(_color(mesh), (size, 1)))
        count += size
    prop = stage.GetPrimAtPath(places(skeleton.GetPrim().GetName()).prop)
    return Figure(
        name=root.GetCustomDataByKey(DEVICE_KEY) or root.GetName(),
        triangles=np.concatenate(triangles),
        point_rgb=np.concatenate(colors),
        joint_count=len(skeleton.GetJointOrder()),
        phrases=phrases_of(root),
        _stage=stage,
        _skeleton=skeleton,
        _targets=tuple(targets),
        _prop=UsdGeom.Xformable(prop),
    )


def _skinned(target: Any, transforms: Any, weights: Any, time_code: float) -> FloatArray:
    """Return a mesh's points in the skeleton's space; ``weights`` are those of the animation."""
    points = UsdGeom.Mesh(target.GetPrim()).GetPointsAttr().Get(time_code)
    if weights and target.HasBlendShapes():
        shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(target.GetPrim()))
        own = shapes.ComputeSubShapeWeights(target.GetBlendShapeMapper().Remap(weights))
        indices = shapes.ComputeBlendShapePointIndices()
        offsets = shapes.ComputeSubShapePointOffsets()
        shapes.ComputeDeformedPoints(*own, indices, offsets, points)
    if target.IsRigidlyDeformed():
        matrix = np.array(target.ComputeSkinnedTransform(transforms, time_code))
        return np.array(points) @ matrix[:3, :3] + matrix[3, :3]
    target.ComputeSkinnedPoints(transforms, points, time_code)
    return np.array(points, dtype=np.float64)


def _triangulated(mesh: UsdGeom.Mesh) -> NDArray[np.int64]:
    """Return the mesh's faces as fans of triangles, ``(t, 3)``."""
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get())
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(), dtype=np.int64)
    first = np.cumsum(counts) - counts
    fans = []
    for k in range(1, int(counts.max()) - 1):
        face = first[counts > k + 1]
        fans.append(np.stack([corners[face], corners[face + k], corners[face + k + 1]], axis=-1))
    return np.concatenate(fans)


def _color(mesh: UsdGeom.Mesh) -> FloatArray:
    """Return one sRGB colour for a mesh: its display colour, its material's, or a plain one."""
    shown = mesh.GetDisplayColorPrimvar().Get()
    if shown:
        return srgb_from_linear(np.array(shown).mean(axis=0))
    material, _ = UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()
    surface = material.ComputeSurfaceSource()[0] if material else None
    diffuse = surface.GetInput("diffuseColor").Get() if surface else None
    return np.array(_PLAIN_RGB) if diffuse is None else srgb_from_linear(np.array(diffuse))


def _to_our_axes(stage: Usd.Stage) -> FloatArray:
    """Return the transform from the stage's world to metres, Y up, for row vectors."""
    matrix = np.eye(4) * UsdGeom.GetStageMetersPerUnit(stage)
    matrix[3, 3] = 1.0
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z:
        turn = np.array(Gf.Matrix4d(Gf.Rotation(Gf.Vec3d(1, 0, 0), -90), Gf.Vec3d(0)))
        matrix = matrix @ turn
    return np.asarray(matrix)
