"""The morph targets of a glTF file: their names, their weights at rest, and their offsets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.imported import MOST_OFFSETS, MOST_SHAPES, unique_names
from laban.faults import Fault
from smd.character.blend_shape import BlendShape
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Shapes:
    """The morph targets of all of a file's nodes.

    Attributes
    ----------
    names : of each; unique, until `called_alike` lets those that move as one share theirs.
    given : as the file has them.
    rest : (s,) weights where nothing animates them.
    columns : by node with a mesh that has targets, the places of its own among all.
    """

    names: tuple[str, ...]
    given: tuple[str, ...]
    rest: FloatArray
    columns: dict[int, slice]

    def called_alike(self, tracks: Sequence[Tracks]) -> Shapes:
        """Return these, where those of one given name share it if they always weigh the same.

        A face of several meshes has a smile in each of them. No mesh has a name twice.

        Parameters
        ----------
        tracks
            Weights of each animation, of these names; or of none where all rest.
        """
        rest = np.concatenate([self.rest[None], *(t.of(self.names) for t in tracks if t.names)])
        of_node = np.zeros(len(self.names), dtype=np.int64)
        for node, columns in self.columns.items():
            of_node[columns] = node
        names = list(self.names)
        for name in set(self.given):
            own = [k for k, given in enumerate(self.given) if given == name]
            apart = len({*of_node[own].tolist()}) == len(own)
            if apart and (rest[:, own] == rest[:, own[:1]]).all():
                for k in own:
                    names[k] = names[own[0]]
        return replace(self, names=tuple(names))

    def of(
        self, file: GltfFile, node: int, primitive: dict[str, Any], count: int, where: str
    ) -> tuple[BlendShape, ...]:
        """Return the shapes of a node's primitive of so many points, those that move any."""
        if node not in self.columns:
            return ()
        names = self.names[self.columns[node]]
        found: list[BlendShape] = []
        moved = 0
        for k, (name, target) in enumerate(zip(names, primitive["targets"], strict=True)):
            place = f"{where}.targets[{k}]"
            if not isinstance(target, dict):
                raise Fault(place, "an object", type(target).__name__)
            if "POSITION" not in target:
                continue
            offsets = file.accessor(target["POSITION"], place)
            if offsets.shape != (count, 3):
                raise Fault(place, f"{count} offsets of 3 numbers", offsets.shape)
            if not np.isfinite(offsets).all():
                raise Fault(place, "finite offsets", "one that is not")
            shape = BlendShape.sparse(name, offsets)
            moved += len(shape.indices)
            if moved > MOST_OFFSETS:
                raise Fault(place, f"at most {MOST_OFFSETS} offsets in all", moved)
            if len(shape.indices):
                found.append(shape)
        return tuple(found)


def read_shapes(file: GltfFile) -> Shapes:
    """Return the morph targets, node by node."""
    names: list[str] = []
    rest: list[float] = []
    columns: dict[int, slice] = {}
    for node in range(file.count("nodes")):
        item = file.node(node)
        if "mesh" not in item:
            continue
        index = file.index(item["mesh"], "meshes", f"nodes[{node}]")
        mesh, where = file.item("meshes", index), f"meshes[{index}]"
        count = _targets(file, mesh, where)
        if not count:
            continue
        if len(names) + count > MOST_SHAPES:
            raise Fault(where, f"at most {MOST_SHAPES} morph targets", "more")
        columns[node] = slice(len(names), len(names) + count)
        weights = item.get("weights", mesh.get("weights", [0.0] * count))
        rest += file.numbers(weights, count, f"{where}.weights").tolist()
        names += _names(mesh, count)
    return Shapes(unique_names(names, "shape"), tuple(names), np.array(rest), columns)


def _targets(file: GltfFile, mesh: dict[str, object], where: str) -> int:
    """Return how many morph targets each of a mesh's primitives has."""
    primitives = mesh.get("primitives", [])
    found = primitives if isinstance(primitives, list) else []
    targets = [p.get("targets", []) if isinstance(p, dict) else [] for p in found]
    counts = {len(t) if isinstance(t, list) else -1 for t in targets}
    if len(counts) > 1 or -1 in counts:
        raise Fault(where, "as many targets in each primitive", sorted(counts))
    return counts.pop() if counts else 0


def _names(mesh: dict[str, object], count: int) -> list[str]:
    """Return the names that most programs write beside a mesh, or numbers behind its own."""
    extras = mesh.get("extras")
    given = extras.get("targetNames") if isinstance(extras, dict) else None
    if isinstance(given, list) and len(given) == count:
        return [str(name) for name in given]
    return [f"{mesh.get('name') or 'shape'}_{k}" for k in range(count)]
