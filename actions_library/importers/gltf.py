"""glTF 2.0 and GLB: skins, animations and skinned meshes [1]_.

All skins of a file share one tree of nodes, so their joints become one skeleton; what hangs from a
joint without a skin goes with it. Joints stand in the world, with the transforms of the nodes
above them; scale is folded into places. The bind pose is the largest skin's own, stood where the
file's rest pose has the skeleton's first joint. Animations are sampled evenly, at the rate of
their keys.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification",
   https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.gltf_meshes import read_meshes
from actions_library.importers.imported import (
    MOST_FRAMES,
    Animation,
    Imported,
    checked_unit,
    fault,
    rigid,
    skeleton_of,
    to_y_up,
)
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    matrix_from_quaternion,
    normalized,
    sign_continuous,
    slerp,
)

RATES_HZ = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0)
"""Rates that animations are sampled at: the nearest to their keys' spacing."""

DEFAULT_RATE_HZ = 30.0
"""Where no channel has more than two keys."""

_PATHS = {"translation": 3, "rotation": 4, "scale": 3}


Moving = dict[int, dict[str, FloatArray]]
"""By node, what of its translation, rotation and scale moves, ``(n, c)`` each."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """The nodes of a file: a forest, parents first.

    Attributes
    ----------
    order : indices of the file's nodes.
    parent : by node, its parent, -1 for a root.
    local : by node, translation (3,), rotation (4,) and scale (3,) at rest.
    """

    order: tuple[int, ...]
    parent: dict[int, int]
    local: dict[int, dict[str, FloatArray]]

    def world(self, moving: Moving | None = None) -> dict[int, FloatArray]:
        """Return each node's matrix in the world, ``(4, 4)``, or ``(n, 4, 4)`` where it moves."""
        found: dict[int, FloatArray] = {}
        for node in self.order:
            own = {**self.local[node], **((moving or {}).get(node, {}))}
            matrix = _matrix(own["translation"], own["rotation"], own["scale"])
            parent = self.parent[node]
            found[node] = matrix if parent < 0 else found[parent] @ matrix
        return found


def read(path: Path, *, up: str | None, unit_m: float | None) -> Imported:
    """Return the skeleton, meshes and animations of a glTF file."""
    file = GltfFile(path)
    nodes = _nodes(file)
    change = np.eye(4)
    change[:3, :3] = to_y_up(path, up or "y") * checked_unit(
        path, 1.0 if unit_m is None else unit_m
    )
    joints = _joints(file, nodes)
    parents = [_joint_above(node, nodes, joints) for node in joints]
    rest = {node: change @ matrix for node, matrix in nodes.world().items()}
    rest_world = np.array([rest[node] for node in joints])
    bind_world, inverse_binds = _binds(file, joints, parents, rest_world)
    names = [str(file.node(node).get("name") or "") for node in joints]
    skeleton = skeleton_of(path, names, parents, rest_world, bind_world)
    meshes, notes = read_meshes(file, nodes.parent, joints, bind_world, inverse_binds, rest)
    animations = []
    for i in range(file.count("animations")):
        animation = _animation(file, i, nodes, joints, parents, change)
        if isinstance(animation, str):
            notes.append(animation)
        else:
            animations.append(animation)
    return Imported(path, skeleton, tuple(meshes), tuple(animations), tuple(notes))


def _matrix(t: FloatArray, q: FloatArray, s: FloatArray) -> FloatArray:
    """Return matrices of translation, rotation and scale, over any leading axes."""
    shape = np.broadcast_shapes(t.shape[:-1], q.shape[:-1], s.shape[:-1])
    matrix = np.zeros((*shape, 4, 4))
    matrix[..., :3, :3] = matrix_from_quaternion(normalized(q)) * s[..., None, :]
    matrix[..., :3, 3] = t
    matrix[..., 3, 3] = 1.0
    return matrix


def _nodes(file: GltfFile) -> Nodes:
    """Return the forest of nodes; each has one parent at most, and none is its own ancestor."""
    count = file.count("nodes")
    parent = dict.fromkeys(range(count), -1)
    for i in range(count):
        for child in file.indices(file.node(i), "children", "nodes", f"nodes[{i}]"):
            if parent[child] >= 0 or child == i:
                raise fault(file.path, f"nodes[{i}]", "a tree", f"node {child} twice in it")
            parent[child] = i
    order = [i for i in range(count) if parent[i] < 0]
    for node in order:  # grows while it is gone through
        order += file.indices(file.node(node), "children", "nodes", f"nodes[{node}]")
    if len(order) != count:
        inside = min(set(range(count)) - set(order))
        raise fault(file.path, f"nodes[{inside}]", "a tree", "a cycle")
    return Nodes(tuple(order), parent, {i: _local(file, i) for i in range(count)})


def _local(file: GltfFile, i: int) -> dict[str, FloatArray]:
    node, where = file.node(i), f"nodes[{i}]"
    if "matrix" in node:
        matrix = file.numbers(node["matrix"], 16, f"{where}.matrix").reshape(4, 4).T
        rotation, translation = rigid(file.path, where, matrix[None], [-1])
        scale = np.linalg.norm(matrix[:3, :3], axis=0)
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            scale = -scale
        return {"translation": translation[0], "rotation": rotation[0], "scale": scale}
    default = {"translation": [0.0] * 3, "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0] * 3}
    return {
        key: file.numbers(node.get(key, default[key]), size, f"{where}.{key}")
        for key, size in _PATHS.items()
    }


def _joints(file: GltfFile, nodes: Nodes) -> list[int]:
    """Return the nodes that are joints, parents first.

    Those of all skins; in a file without one, those that are animated, and all below them.
    """
    wanted: set[int] = set()
    for i in range(file.count("skins")):
        found = file.indices(file.item("skins", i), "joints", "nodes", f"skins[{i}]")
        if len(set(found)) != len(found) or not found:
            expected, what = "nodes, each once", "one twice" if found else "none"
            raise fault(file.path, f"skins[{i}].joints", expected, what)
        wanted |= set(found)
    if not wanted:
        for i in range(file.count("animations")):
            for _, target in file.channels(i):
                if "node" in target:
                    wanted.add(file.index(target["node"], "nodes", f"animations[{i}]"))
        for node in nodes.order:
            if nodes.parent[node] in wanted and "mesh" not in file.node(node):
                wanted.add(node)
    if not wanted:
        raise fault(file.path, "", "a skin or an animation of nodes", "neither")
    return [node for node in nodes.order if node in wanted]


def _joint_above(node: int, nodes: Nodes, joints: list[int]) -> int:
    """Return the place among the joints of the nearest one above a node; -1 without one."""
    above = nodes.parent[node]
    while above >= 0 and above not in joints:
        above = nodes.parent[above]
    return joints.index(above) if above >= 0 else -1


def _binds(
    file: GltfFile, joints: list[int], parents: list[int], rest: FloatArray
) -> tuple[FloatArray, list[FloatArray]]:
    """Return where joints stood when they were bound ``(j, 4, 4)``, and each skin's inverse binds.

    The largest skin says where its joints stood, in its mesh's own space; that space is put where
    the skeleton's first joint of that skin is at rest. Other joints stand as at rest from there.
    """
    inverses = []
    for i in range(file.count("skins")):
        skin = file.item("skins", i)
        count = len(skin["joints"])
        if "inverseBindMatrices" in skin:
            where = f"skins[{i}].inverseBindMatrices"
            flat = file.accessor(skin["inverseBindMatrices"], where)
            if flat.shape[1:] != (16,) or len(flat) < count:
                raise fault(file.path, where, f"{count} matrices", flat.shape)
            inverses.append(np.swapaxes(flat[:count].reshape(-1, 4, 4), -1, -2))
        else:
            inverses.append(np.tile(np.eye(4), (count, 1, 1)))
        if np.abs(np.linalg.det(inverses[-1])).min() < 1e-18:
            raise fault(file.path, f"skins[{i}]", "matrices with an inverse", "one without")
    if not inverses:
        return rest, inverses
    largest = max(range(len(inverses)), key=lambda i: len(inverses[i]))
    own = [joints.index(node) for node in file.item("skins", largest)["joints"]]
    stood = dict(zip(own, np.linalg.inv(inverses[largest]), strict=True))
    first = min(own)
    here = rest[first] @ np.linalg.inv(stood[first])
    bind = rest.copy()
    for j, parent in enumerate(parents):
        if j in stood:
            bind[j] = here @ stood[j]
        elif parent >= 0:
            bind[j] = bind[parent] @ np.linalg.inv(rest[parent]) @ rest[j]
    return bind, inverses


def _animation(
    file: GltfFile,
    i: int,
    nodes: Nodes,
    joints: list[int],
    parents: list[int],
    change: FloatArray,
) -> Animation | str:
    """Return an animation of the joints, or why it is left out."""
    name = str(file.item("animations", i).get("name") or f"animation_{i}")
    tracks: list[tuple[int, str, FloatArray, FloatArray, str]] = []
    for sampler, target in file.channels(i):
        if target.get("path") in _PATHS and "node" in target:
            tracks.append(_track(file, i, sampler, target))
    if not tracks:
        return f"animation {name!r} moves no joint: left out"
    if any(path == "scale" and np.abs(values).min() < 1e-6 for _, path, _, values, _ in tracks):
        return f"animation {name!r} scales joints to nothing: left out"
    start_s = min(times[0] for _, _, times, _, _ in tracks)
    end_s = max(times[-1] for _, _, times, _, _ in tracks)
    rate_hz = _rate_hz([times for _, _, times, _, _ in tracks])
    frames = max(round((end_s - start_s) * rate_hz), 1) + 1
    if frames > MOST_FRAMES:
        raise fault(file.path, f"animations[{i}]", f"at most {MOST_FRAMES} frames", frames)
    at_s = np.minimum(start_s + np.arange(frames) / rate_hz, end_s)
    moving: Moving = {}
    for node, path, times, values, manner in tracks:
        moving.setdefault(node, {})[path] = sampled(times, values, at_s, manner, path)
    world = nodes.world(moving)
    poses = np.stack([np.broadcast_to(world[n], (frames, 4, 4)) for n in joints], axis=1)
    rotation, translation = rigid(file.path, f"animations[{i}]", change @ poses, parents)
    return Animation(name, rate_hz, rotation, translation)


def _track(
    file: GltfFile, i: int, sampler: dict[str, Any], target: dict[str, Any]
) -> tuple[int, str, FloatArray, FloatArray, str]:
    """Return a channel: its node, path, key times, key values and interpolation."""
    where = f"animations[{i}]"
    node = file.index(target["node"], "nodes", where)
    path, manner = target["path"], sampler.get("interpolation", "LINEAR")
    if manner not in ("LINEAR", "STEP", "CUBICSPLINE"):
        raise fault(file.path, where, "LINEAR, STEP or CUBICSPLINE", repr(manner)[:40])
    times = file.accessor(sampler.get("input"), f"{where}: input")[:, 0]
    values = file.accessor(sampler.get("output"), f"{where}: output")
    each = 3 if manner == "CUBICSPLINE" else 1
    if values.shape != (each * len(times), _PATHS[path]) or not len(times):
        expected = f"{each * len(times)} values of {_PATHS[path]} numbers"
        raise fault(file.path, f"{where}, node {node}, {path}", expected, values.shape)
    if not (np.isfinite(times).all() and np.isfinite(values).all()):
        raise fault(file.path, f"{where}, node {node}, {path}", "finite keys", "one that is not")
    if (np.diff(times) <= 0.0).any():
        bad = float(times[int(np.argmax(np.diff(times) <= 0.0)) + 1])
        raise fault(file.path, f"{where}, node {node}", "times that increase", f"{bad:g} s")
    return node, path, times, values, manner


def _rate_hz(times: list[FloatArray]) -> float:
    """Return the rate nearest to the usual spacing of keys."""
    steps = [np.diff(t) for t in times if len(t) > 2]
    if not steps:
        return DEFAULT_RATE_HZ
    usual = 1.0 / float(np.median(np.concatenate(steps)))
    return min(RATES_HZ, key=lambda rate: abs(np.log(rate / usual)))


def sampled(
    times: FloatArray, values: FloatArray, at_s: FloatArray, manner: str, path: str
) -> FloatArray:
    """Return a channel's values at some times, held before its first and after its last key.

    Parameters
    ----------
    times
        ``(k,)`` increasing.
    values
        ``(k, c)``; for cubic splines ``(3 k, c)``: in-tangent, value, out-tangent of each key.
    """
    after = np.clip(np.searchsorted(times, at_s, side="right"), 1, max(len(times) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(times) - 1)
    step = np.where(after > before, times[after] - times[before], 1.0)
    share = np.clip((at_s - times[before]) / step, 0.0, 1.0)
    if manner == "CUBICSPLINE":
        tangent_in, value, tangent_out = values.reshape(len(times), 3, -1).transpose(1, 0, 2)
        u, d = share[:, None], step[:, None]
        found = (
            (2 * u**3 - 3 * u**2 + 1) * value[before]
            + d * (u**3 - 2 * u**2 + u) * tangent_out[before]
            + (3 * u**2 - 2 * u**3) * value[after]
            + d * (u**3 - u**2) * tangent_in[after]
        )
        return normalized(found) if path == "rotation" else np.asarray(found)
    if manner == "STEP":
        return values[np.where(share >= 1.0, after, before)]
    if path == "rotation":
        q = sign_continuous(normalized(values))
        return slerp(q[before], q[after], share)
    return np.asarray(values[before] + share[:, None] * (values[after] - values[before]))
