"""The nodes of a glTF file: a forest of transforms, some of them joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.imported import MOST_JOINTS, rigid
from laban.faults import Fault
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import matrix_from_quaternion, normalized

PARTS = {"translation": 3, "rotation": 4, "scale": 3}
"""Of a node's transform, and how many numbers each has."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """The nodes of a file.

    Attributes
    ----------
    order : indices of the file's nodes, parents first.
    parent : by node, its parent, -1 for a root.
    local : by part of the transform, its value of each node at rest, ``(n, c)``.
    """

    order: tuple[int, ...]
    parent: tuple[int, ...]
    local: dict[str, FloatArray]

    def above(self, joints: Sequence[int]) -> list[int]:
        """Return joints with all nodes above them, parents first."""
        wanted: set[int] = set()
        for joint in joints:
            node = joint
            while node >= 0 and node not in wanted:
                wanted.add(node)
                node = self.parent[node]
        return [node for node in self.order if node in wanted]

    def world(self, nodes: Sequence[int], local: dict[str, FloatArray]) -> FloatArray:
        """Return matrices in the world ``(…, k, 4, 4)`` of nodes that hold all above them.

        Parameters
        ----------
        nodes
            k of them, parents first.
        local
            Parts of their transforms, ``(…, k, c)``.
        """
        t, q, s = (local[part] for part in PARTS)
        matrix = np.zeros((*t.shape[:-1], 4, 4))
        matrix[..., :3, :3] = matrix_from_quaternion(normalized(q)) * s[..., None, :]
        matrix[..., :3, 3] = t
        matrix[..., 3, 3] = 1.0
        at = {node: k for k, node in enumerate(nodes)}
        for k, node in enumerate(nodes):
            if self.parent[node] >= 0:
                held = matrix[..., at[self.parent[node]], :, :]
                matrix[..., k, :, :] = held @ matrix[..., k, :, :]
        return matrix

    def rest(self) -> FloatArray:
        """Return each node's matrix in the world at rest, ``(n, 4, 4)``."""
        order = list(self.order)
        found = np.empty((len(order), 4, 4))
        found[order] = self.world(order, {part: v[order] for part, v in self.local.items()})
        return found


def read_nodes(file: GltfFile) -> Nodes:
    """Return the forest of nodes; each has one parent at most, and none is its own ancestor."""
    count = file.count("nodes")
    parent = [-1] * count
    children = []
    for i in range(count):
        children.append(file.indices(file.node(i), "children", "nodes", f"nodes[{i}]"))
        for child in children[i]:
            if parent[child] >= 0 or child == i:
                raise Fault(f"nodes[{i}]", "a tree", f"node {child} twice in it")
            parent[child] = i
    order = [i for i in range(count) if parent[i] < 0]
    for node in order:  # grows while it is gone through
        order += children[node]
    if len(order) != count:
        inside = min(set(range(count)) - set(order))
        raise Fault(f"nodes[{inside}]", "a tree", "a cycle")
    each = [_local(file, i) for i in range(count)]
    local = {
        part: np.array([own[part] for own in each]).reshape(count, size)
        for part, size in PARTS.items()
    }
    return Nodes(tuple(order), tuple(parent), local)


def _local(file: GltfFile, i: int) -> dict[str, FloatArray]:
    node, where = file.node(i), f"nodes[{i}]"
    if "matrix" in node:
        matrix = file.numbers(node["matrix"], 16, f"{where}.matrix").reshape(4, 4).T
        rotation, translation = rigid(where, matrix[None], [-1])
        scale = np.linalg.norm(matrix[:3, :3], axis=0)
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            scale = -scale
        return {"translation": translation[0], "rotation": rotation[0], "scale": scale}
    default = {"translation": [0.0] * 3, "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0] * 3}
    return {
        part: file.numbers(node.get(part, default[part]), size, f"{where}.{part}")
        for part, size in PARTS.items()
    }


def find_joints(file: GltfFile, nodes: Nodes) -> list[int]:
    """Return the nodes that are joints, parents first.

    Those of all skins; in a file without one, those that are animated, and all below them.
    """
    wanted: set[int] = set()
    for i in range(file.count("skins")):
        found = file.indices(file.item("skins", i), "joints", "nodes", f"skins[{i}]")
        if len(set(found)) != len(found) or not found:
            expected, what = "nodes, each once", "one twice" if found else "none"
            raise Fault(f"skins[{i}].joints", expected, what)
        wanted |= set(found)
    if not wanted:
        for i in range(file.count("animations")):
            for _, target in file.channels(i):
                if "node" in target and target["path"] in PARTS:
                    wanted.add(file.index(target["node"], "nodes", f"animations[{i}]"))
        for node in nodes.order:
            if nodes.parent[node] in wanted and "mesh" not in file.node(node):
                wanted.add(node)
    if not wanted:
        raise Fault("", "a skin or an animation of nodes", "neither")
    if len(wanted) > MOST_JOINTS:
        raise Fault("", f"at most {MOST_JOINTS} joints", len(wanted))
    return [node for node in nodes.order if node in wanted]


def joint_parents(nodes: Nodes, joints: Sequence[int]) -> list[int]:
    """Return the place among the joints of the nearest one above each; -1 without one."""
    at = {node: j for j, node in enumerate(joints)}
    nearest: dict[int, int] = {-1: -1}
    for node in nodes.order:
        above = nodes.parent[node]
        nearest[node] = at.get(above, nearest[above])
    return [nearest[node] for node in joints]
