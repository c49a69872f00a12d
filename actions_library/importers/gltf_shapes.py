"""The morph targets of a glTF file: their names and their weights at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.imported import unique_names
from laban.faults import Fault
from smd.geometry.arrays import FloatArray

_MOST_SHAPES = 4096


@dataclass(frozen=True, eq=False)
class Shapes:
    """The morph targets of all of a file's nodes.

    Attributes
    ----------
    names : unique.
    rest : (s,) weights where nothing animates them.
    columns : by node with a mesh that has targets, the places of its own among all.
    """

    names: tuple[str, ...]
    rest: FloatArray
    columns: dict[int, slice]


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
        if len(names) + count > _MOST_SHAPES:
            raise Fault(where, f"at most {_MOST_SHAPES} morph targets", "more")
        columns[node] = slice(len(names), len(names) + count)
        weights = item.get("weights", mesh.get("weights", [0.0] * count))
        rest += file.numbers(weights, count, f"{where}.weights").tolist()
        names += _names(mesh, count)
    return Shapes(unique_names(names, "shape"), np.array(rest), columns)


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
