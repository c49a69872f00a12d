"""A USD file without skeleton as a rig: whatever it animates is a control, its meshes the surface.

A pose is written over the file's own values in the session's layer, which is stronger than all
others, and USD evaluates what follows: transforms, points, whatever its schemas say.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdSkel

from actions_library.importers.imported import checked_unit, to_y_up
from actions_library.importers.usd_animation import frame_codes
from actions_library.importers.usd_ground import is_seen, mesh_of
from actions_library.importers.usd_layers import check_layers, check_used, first_line
from actions_library.importers.usd_values import numbers
from laban.faults import Fault, naming
from smd.character.rig import Controls
from smd.errors import CharacterError, ImportedFileError
from smd.geometry.arrays import FloatArray, IntArray

MOST_CONTROLS, MOST_VALUES = 100_000, 30_000_000
"""Of a file: controls, and controls times frames."""

_QUATERNIONS = (Gf.Quatf, Gf.Quatd, Gf.Quath)


@dataclass(frozen=True, eq=False)
class _Animated:
    """An attribute that a file animates: how its values become numbers, and numbers values."""

    attribute: Usd.Attribute
    kind: type
    shape: tuple[int, ...]
    dtype: np.dtype[Any]

    @classmethod
    def of(cls, attribute: Usd.Attribute, code: float) -> _Animated | None:
        """Return an attribute as one, if its values are fractions or arrays of them.

        Raises
        ------
        Fault
            If one layer says that it is of a type, and another has values of another.
        """
        value, declared = attribute.Get(code), attribute.GetTypeName()
        if type(value) is not type(declared.defaultValue):
            where = str(attribute.GetPath())
            raise Fault(where, f"values of its type {declared}", type(value).__name__)
        if isinstance(value, _QUATERNIONS):
            return cls(attribute, type(value), (4,), np.dtype(np.float64))
        try:
            found = np.array(value)
        except (TypeError, ValueError):
            return None
        if found.dtype.kind != "f":
            return None
        return cls(attribute, type(value), found.shape, found.dtype)

    @property
    def names(self) -> list[str]:
        """Names of its numbers: the attribute's path, and a place where there are several."""
        path = str(self.attribute.GetPath())
        size = int(np.prod(self.shape))
        return [f"{path}[{k}]" for k in range(size)] if self.shape else [path]

    def numbers(self, code: float | None) -> FloatArray | None:
        """Return its numbers at a time code, or by default; None where it has no such value."""
        value = self.attribute.Get(Usd.TimeCode.Default() if code is None else code)
        if type(value) is not self.kind:
            return None
        if isinstance(value, _QUATERNIONS):
            return np.array([*value.GetImaginary(), value.GetReal()])
        found = np.array(value, dtype=np.float64)
        return found.ravel() if found.shape == self.shape else None

    def value(self, found: FloatArray) -> Any:
        """Return the value that has these numbers."""
        if not self.shape:
            return float(found[0])
        if self.kind in _QUATERNIONS:
            return self.kind(float(found[3]), *map(float, found[:3]))
        if hasattr(self.kind, "FromNumpy"):
            return self.kind.FromNumpy(found.reshape(self.shape).astype(self.dtype))
        return self.kind(*map(float, found))


class UsdRig:
    """A rig whose surface USD evaluates; `read_usd_rig` makes one.

    Attributes
    ----------
    animations : the file's own poses ``(n, d)``, the only ones, by the name of the file.
    rate_hz : its frames a second.
    notes : what the file animates that is no control, one line each.
    """

    def __init__(self, stage: Usd.Stage, name: str, change: FloatArray) -> None:
        self._stage, self._change = stage, change
        found, self.notes = _animated(stage)
        times = sorted({t for each in found for t in each.attribute.GetTimeSamples()})
        names = [name for each in found for name in each.names]
        if len(names) > MOST_CONTROLS:
            raise Fault("", f"at most {MOST_CONTROLS} controls", len(names))
        self.rate_hz, codes = frame_codes("", stage, times, 1)
        if len(codes) * len(names) > MOST_VALUES:
            most = f"at most {MOST_VALUES} frames times controls"
            raise Fault("", most, len(codes) * len(names))
        poses = np.concatenate([_over_time(each, codes) for each in found], axis=1)
        poses.flags.writeable = False
        self.animations: Mapping[str, FloatArray] = MappingProxyType({name: poses})
        at_rest = [each.numbers(None) for each in found]
        starts = np.cumsum([0, *(len(each.names) for each in found)])
        rest = poses[0].copy()
        for value, start in zip(at_rest, starts, strict=False):
            if value is not None and np.isfinite(value).all():
                rest[start : start + len(value)] = value
        every = np.concatenate([poses, rest[None]])
        self._controls = Controls(tuple(names), rest, every.min(axis=0), every.max(axis=0))
        self._code = float(codes[0])
        self._meshes, points, self._triangles = _meshes(stage, self._code)
        self._points = np.concatenate(points)
        counts = [len(own) for own in points]
        self._owner = np.repeat(np.arange(len(counts)), counts)
        ends = np.cumsum(counts).tolist()
        self._formed = [  # those whose points change, and where these are among all
            (mesh, slice(end - count, end))
            for mesh, count, end in zip(self._meshes, counts, ends, strict=True)
            if mesh.GetPointsAttr().ValueMightBeTimeVarying()
        ]
        self._specs = [
            (_override(stage, each.attribute), each, slice(start, start + len(each.names)))
            for each, start in zip(found, starts.tolist(), strict=False)
        ]

    @property
    def controls(self) -> Controls:
        """What poses it."""
        return self._controls

    @property
    def triangles(self) -> IntArray:
        """Faces ``(t, 3)`` of all its meshes' points."""
        return self._triangles

    def surface_m(self, poses: ArrayLike) -> FloatArray:
        """Return the points of its meshes, as `smd.character.rig.ControlRig.surface_m` does."""
        given = self._controls.poses(poses)
        found = np.empty((len(given), len(self._points), 3))
        for row, pose in zip(found, given, strict=True):
            with Sdf.ChangeBlock():
                for spec, animated, columns in self._specs:
                    spec.default = animated.value(pose[columns])
            row[:] = self._evaluated()
        return found

    def _evaluated(self) -> FloatArray:
        """Return the points of all meshes ``(p, 3)`` as the stage has them now."""
        cache = UsdGeom.XformCache(self._code)
        for mesh, rows in self._formed:
            points = numbers(mesh.GetPointsAttr(), 3, time=self._code)
            count = rows.stop - rows.start
            if points is None or len(points) != count or not np.isfinite(points).all():
                got = 0 if points is None else len(points)
                raise CharacterError(f"{mesh.GetPath()}: expected {count} finite points, got {got}")
            self._points[rows] = points
        world = np.array([cache.GetLocalToWorldTransform(m.GetPrim()) for m in self._meshes])
        own = world[self._owner]  # of rows
        placed = np.einsum("pc,pcd->pd", self._points, own[:, :3, :3]) + own[:, 3, :3]
        return np.asarray(placed @ self._change.T)


def read_usd_rig(path: Path | str, *, up: str | None = None, unit_m: float | None = None) -> UsdRig:
    """Read a USD file without skeleton as a rig: any animated number is a control.

    Rest values are the attributes' default values, or those of the first frame; ranges are those of
    the animation. The surface is all visible meshes.

    Parameters
    ----------
    path
        Of the file.
    up, unit_m
        As in `actions_library.importers.import_file`.

    Raises
    ------
    ImportedFileError
        If it is no USD file, has a skeleton, animates nothing, shows no mesh, or changes the type
        or the size of a value, or the faces of a mesh.
    """
    path = Path(path)
    with naming(path, ImportedFileError):
        if not path.is_file():
            raise Fault("", "a USD file", "none")
        check_layers(path)
        try:
            stage = Usd.Stage.Open(str(path), Usd.Stage.LoadAll)
            check_used(path, stage)
            axis = up or str(UsdGeom.GetStageUpAxis(stage)).lower()
            unit = UsdGeom.GetStageMetersPerUnit(stage) if unit_m is None else unit_m
            return UsdRig(stage, path.stem, to_y_up(axis) * checked_unit(unit))
        except (Tf.ErrorException, UnicodeDecodeError) as error:
            raise Fault("", "a USD file", first_line(error)) from None


def _animated(stage: Usd.Stage) -> tuple[list[_Animated], tuple[str, ...]]:
    """Return what a stage animates, and what of it is no number."""
    found, notes = [], []
    for prim in stage.Traverse():
        if prim.IsA(UsdSkel.Skeleton):
            raise Fault(str(prim.GetPath()), "a file without skeleton", "one")
        for attribute in prim.GetAuthoredAttributes():
            if not attribute.ValueMightBeTimeVarying():
                continue
            animated = _Animated.of(attribute, attribute.GetTimeSamples()[0])
            if animated is None:
                notes.append(f"{attribute.GetPath()} is animated, but no number")
            else:
                found.append(animated)
    if not found:
        raise Fault("", "animated numbers", "none")
    return found, tuple(notes)


def _over_time(animated: _Animated, codes: FloatArray) -> FloatArray:
    """Return an attribute's numbers at time codes ``(n, k)``."""
    rows = []
    for code in codes.tolist():
        row = animated.numbers(code)
        if row is None or not np.isfinite(row).all():
            where = f"{animated.attribute.GetPath()}, time code {code:g}"
            expected = f"{len(animated.names)} finite numbers, as at first"
            raise Fault(where, expected, repr(animated.attribute.Get(code))[:60])
        rows.append(row)
    return np.array(rows)


def _meshes(stage: Usd.Stage, code: float) -> tuple[list[UsdGeom.Mesh], list[FloatArray], IntArray]:
    """Return the meshes that are seen, the points of each, and the faces of all."""
    meshes: list[UsdGeom.Mesh] = []
    places: list[FloatArray] = []
    faces: list[IntArray] = []
    count = 0
    cache = UsdGeom.XformCache(code)
    for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
        if not prim.IsA(UsdGeom.Mesh) or not is_seen(UsdGeom.Imageable(prim)):
            continue
        mesh = UsdGeom.Mesh(prim)
        for topology in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()):
            if topology.ValueMightBeTimeVarying():
                raise Fault(str(topology.GetPath()), "the same faces at all times", "others")
        points, triangles = mesh_of(mesh, code)
        if not len(triangles):
            continue
        mirrored = np.linalg.det(np.array(cache.GetLocalToWorldTransform(prim))[:3, :3]) < 0.0
        faces.append((triangles[:, ::-1] if mirrored else triangles) + count)
        meshes.append(mesh)
        places.append(points)
        count += len(points)
    if not meshes:
        raise Fault("", "a mesh that is seen", "none")
    return meshes, places, np.concatenate(faces)


def _override(stage: Usd.Stage, attribute: Usd.Attribute) -> Sdf.AttributeSpec:
    """Return the session's own opinion of an attribute, to be given values."""
    layer = stage.GetSessionLayer()
    prim = Sdf.CreatePrimInLayer(layer, attribute.GetPrim().GetPath())
    return Sdf.AttributeSpec(prim, attribute.GetName(), attribute.GetTypeName())
