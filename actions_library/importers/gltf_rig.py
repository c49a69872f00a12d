"""A glTF file without skin as a rig: whatever its animations move is a control."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from actions_library.importers.gltf_animations import channels_of, sampled, usual_rate_hz
from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.gltf_meshes import geometry_of
from actions_library.importers.gltf_nodes import PARTS, Nodes, read_nodes
from actions_library.importers.gltf_shapes import Shapes, read_shapes
from actions_library.importers.imported import (
    MOST_ANIMATIONS,
    MOST_POINTS,
    check_poses,
    checked_unit,
    to_y_up,
    unique_names,
)
from laban.faults import Fault, naming
from smd.character.blend_shape import BlendShape
from smd.character.rig import Controls
from smd.errors import ImportedFileError
from smd.geometry.arrays import FloatArray, IntArray

_BLOCK = 1 << 20  # points of several poses that are placed at once


class _Driven(NamedTuple):
    """Numbers of a node that something animates, and where they stand in a pose."""

    node: int
    path: str
    columns: slice


class _Piece(NamedTuple):
    """Points of a node, their shapes, and these shapes' places among the file's."""

    node: int
    points: FloatArray
    shapes: tuple[BlendShape, ...]
    places: tuple[int, ...]


class GltfRig:
    """A rig of a glTF file; `read_gltf_rig` makes one.

    Attributes
    ----------
    animations : by name, the file's own poses ``(n, d)``.
    rate_hz : frames a second of all of them.
    """

    def __init__(self, file: GltfFile, change: FloatArray) -> None:
        if file.count("skins"):
            raise Fault("skins", "a file without skeleton", file.count("skins"))
        self._nodes, self._change = read_nodes(file), change
        self._shapes = read_shapes(file)
        self._moved, names = _moved(file, self._nodes, self._shapes)
        self.rate_hz, self.animations = self._sampled(file, len(names))
        rest = np.concatenate([self._at_rest(each) for each in self._moved])
        every = np.concatenate([rest[None], *self.animations.values()])
        self._controls = Controls(unique_names(names), rest, every.min(axis=0), every.max(axis=0))
        self._pieces, self._triangles = _pieces(file, self._shapes)

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
        count = sum(len(piece.points) for piece in self._pieces)
        found = np.empty((len(given), count, 3))
        step = max(_BLOCK // count, 1)
        for start in range(0, len(given), step):
            found[start : start + step] = self._placed(given[start : start + step])
        return found

    def _placed(self, poses: FloatArray) -> FloatArray:
        n, order = len(poses), list(self._nodes.order)
        local = {part: np.tile(v, (n, 1, 1)) for part, v in self._nodes.local.items()}
        weights = np.tile(self._shapes.rest, (n, 1))
        for node, path, columns in self._moved:
            if path == "weights":
                weights[:, self._shapes.columns[node]] = poses[:, columns]
            else:
                local[path][:, node] = poses[:, columns]
        world = np.empty((n, len(order), 4, 4))
        world[:, order] = self._nodes.world(order, {p: v[:, order] for p, v in local.items()})
        places = []
        for piece in self._pieces:
            points = np.tile(piece.points, (n, 1, 1))
            for shape, place in zip(piece.shapes, piece.places, strict=True):
                points[:, shape.indices] += weights[:, place, None, None] * shape.offsets_m
            matrix = self._change @ world[:, piece.node, :3]
            turned = np.einsum("nxy,npy->npx", matrix[..., :3], points)
            places.append(turned + matrix[:, None, :, 3])
        return np.concatenate(places, axis=1)

    def _at_rest(self, moved: _Driven) -> FloatArray:
        if moved.path == "weights":
            return self._shapes.rest[self._shapes.columns[moved.node]]
        return self._nodes.local[moved.path][moved.node]

    def _sampled(self, file: GltfFile, width: int) -> tuple[float, Mapping[str, FloatArray]]:
        """Return a rate, and each animation's poses at it."""
        chain = {*range(file.count("nodes"))}
        every = [
            channels_of(file, f"animations[{i}]", i, chain, self._shapes)
            for i in range(file.count("animations"))
        ]
        rate_hz = usual_rate_hz([channel.times for channels in every for channel in channels])
        at = {(each.node, each.path): each.columns for each in self._moved}
        rest = np.concatenate([self._at_rest(each) for each in self._moved])
        found: dict[str, FloatArray] = {}
        poses = 0
        for i, channels in enumerate(every):
            if not channels:
                continue
            start_s = min(channel.times[0] for channel in channels)
            end_s = max(channel.times[-1] for channel in channels)
            frames = max(np.round((end_s - start_s) * rate_hz), 1.0) + 1.0
            check_poses(f"animations[{i}]", frames, width, poses)
            poses += int(frames) * width
            at_s = np.minimum(start_s + np.arange(int(frames)) / rate_hz, end_s)
            values = np.tile(rest, (len(at_s), 1))
            for each in channels:
                own = sampled(each.times, each.values, at_s, each.manner, each.path)
                values[:, at[each.node, each.path]] = own
            name = str(file.item("animations", i).get("name") or f"animation_{i}")
            values.flags.writeable = False
            found[unique_names([*found, name])[-1]] = values
        return rate_hz, MappingProxyType(found)


def read_gltf_rig(
    path: Path | str, *, up: str | None = None, unit_m: float | None = None
) -> GltfRig:
    """Read a glTF file without skin as a rig: numbers of nodes that are animated are controls.

    They are parts of transforms (``<node>.rotation[3]``, xyzw) and weights of morph targets. Rest
    values are the nodes' own; ranges are those of the animations.

    Parameters
    ----------
    path
        Of the file.
    up, unit_m
        As in `actions_library.importers.import_file`.

    Raises
    ------
    ImportedFileError
        If it is no glTF file, has a skin, animates nothing, or has no mesh.
    """
    path = Path(path)
    with naming(path, ImportedFileError):
        if not path.is_file():
            raise Fault("", "a glTF file", "none")
        unit = checked_unit(1.0 if unit_m is None else unit_m)
        return GltfRig(GltfFile(path), to_y_up(up or "y") * unit)


def _moved(file: GltfFile, nodes: Nodes, shapes: Shapes) -> tuple[list[_Driven], list[str]]:
    """Return what any animation moves, node by node, and the names of its numbers."""
    if file.count("animations") > MOST_ANIMATIONS:
        raise Fault("animations", f"at most {MOST_ANIMATIONS}", file.count("animations"))
    chain = {*range(len(nodes.order))}
    targets = {
        (channel.node, channel.path)
        for i in range(file.count("animations"))
        for channel in channels_of(file, f"animations[{i}]", i, chain, shapes)
    }
    if not targets:
        raise Fault("", "animated nodes", "none")
    called = unique_names([str(file.node(i).get("name") or "") for i in range(len(chain))], "node")
    found: list[_Driven] = []
    names: list[str] = []
    for node, path in sorted(targets):
        if path == "weights":
            own = list(shapes.names[shapes.columns[node]])
        else:
            own = [f"{called[node]}.{path}[{k}]" for k in range(PARTS[path])]
        found.append(_Driven(node, path, slice(len(names), len(names) + len(own))))
        names += own
    return found, names


def _pieces(file: GltfFile, shapes: Shapes) -> tuple[list[_Piece], IntArray]:
    """Return the points of all nodes with a mesh, and their faces."""
    found: list[_Piece] = []
    faces: list[IntArray] = []
    place = {name: k for k, name in enumerate(shapes.names)}
    count = 0
    for node in range(file.count("nodes")):
        item = file.node(node)
        if "mesh" not in item:
            continue
        mesh = file.item("meshes", file.index(item["mesh"], "meshes", f"nodes[{node}]"))
        primitives: Any = mesh.get("primitives", [])
        for k, primitive in enumerate(primitives if isinstance(primitives, list) else []):
            where = f"meshes[{item['mesh']}].primitives[{k}]"
            geometry = geometry_of(file, primitive, where)
            if geometry is None:
                continue
            points, triangles = geometry
            own = shapes.of(file, node, primitive, len(points), where)
            places = tuple(place[shape.name] for shape in own)
            found.append(_Piece(node, points, own, places))
            faces.append(triangles + count)
            count += len(points)
            if count > MOST_POINTS:
                raise Fault(where, f"at most {MOST_POINTS} points in all", count)
    if not found:
        raise Fault("", "a mesh", "none")
    return found, np.concatenate(faces)
