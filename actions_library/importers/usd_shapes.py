"""The blend shapes of a USD file's meshes: offsets of points, at most as many as any file needs."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from pxr import UsdGeom, UsdSkel

from actions_library.importers.imported import MOST_OFFSETS, MOST_SHAPES
from actions_library.importers.usd_values import extremes, numbers, texts, whole_numbers
from laban.faults import Fault
from smd.character.blend_shape import BlendShape


class ShapeReader:
    """Reads blend shapes, a mesh at a time, and keeps count of them."""

    def __init__(self) -> None:
        self._shapes = self._offsets = self._between = 0

    @property
    def notes(self) -> list[str]:
        """What was left out."""
        if not self._between:
            return []
        return [f"{self._between} in-betweens of blend shapes are not kept"]

    def shapes(self, mesh: UsdGeom.Mesh, count: int) -> list[BlendShape]:
        """Return the blend shapes of a mesh of so many points, those that move any.

        Raises
        ------
        Fault
            If they do not fit the mesh, or there are too many.
        """
        binding, where = UsdSkel.BindingAPI(mesh), str(mesh.GetPath())
        names = texts(binding.GetBlendShapesAttr())
        paths = binding.GetBlendShapeTargetsRel().GetTargets()
        if len(names) != len(paths):
            raise Fault(where, f"{len(names)} targets of blend shapes", len(paths))
        self._shapes += len(names)
        if self._shapes > MOST_SHAPES:
            raise Fault(where, f"at most {MOST_SHAPES} shapes", self._shapes)
        found = []
        for name, path in zip(names, paths, strict=True):
            target = UsdSkel.BlendShape(mesh.GetPrim().GetStage().GetPrimAtPath(path))
            if not target:
                raise Fault(str(path), "a BlendShape", "none")
            shape = self._shape(name, target, count)
            if len(shape.indices):
                found.append(shape)
        return found

    def _shape(self, name: str, target: UsdSkel.BlendShape, count: int) -> BlendShape:
        where = str(target.GetPath())
        offsets = numbers(target.GetOffsetsAttr(), 3)
        if offsets is None or not np.isfinite(offsets).all():
            raise Fault(where, "finite offsets", "none" if offsets is None else "one that is not")
        self._offsets += len(offsets)
        if self._offsets > MOST_OFFSETS:
            raise Fault(where, f"at most {MOST_OFFSETS} offsets in all", self._offsets)
        points = whole_numbers(target.GetPointIndicesAttr())
        points = points if len(points) else np.arange(count)
        if len(points) != len(offsets):
            raise Fault(where, f"{len(points)} offsets", len(offsets))
        if len(points) and (points.min() < 0 or points.max() >= count):
            raise Fault(where, f"point indices from 0 to {count - 1}", extremes(points))
        self._between += len(target.GetInbetweens())
        own, place = np.unique(points, return_inverse=True)
        summed = np.zeros((len(own), 3))
        np.add.at(summed, place, offsets)
        moves = summed.any(axis=1)
        return BlendShape(name, own[moves], summed[moves])


def names_of_shapes(meshes: Iterable[UsdGeom.Mesh]) -> set[str]:
    """Return the names of all blend shapes that meshes have."""
    return {
        name for mesh in meshes for name in texts(UsdSkel.BindingAPI(mesh).GetBlendShapesAttr())
    }
