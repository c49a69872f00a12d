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

from dataclasses import replace
from pathlib import Path

import numpy as np

from actions_library.importers.format import ImportOptions
from actions_library.importers.gltf_animations import read_animations
from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.gltf_meshes import read_meshes
from actions_library.importers.gltf_nodes import find_joints, joint_parents, read_nodes
from actions_library.importers.gltf_shapes import read_shapes
from actions_library.importers.imported import (
    Imported,
    checked_unit,
    skeleton_of,
    to_y_up,
)
from laban.faults import Fault
from smd.character.character import shape_names
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray


def read(path: Path, asked: ImportOptions) -> Imported:
    """Return the skeleton, meshes and animations of a glTF file."""
    file = GltfFile(path)
    nodes = read_nodes(file)
    change = np.eye(4)
    change[:3, :3] = to_y_up(asked.up or "y") * checked_unit(
        1.0 if asked.unit_m is None else asked.unit_m
    )
    joints = find_joints(file, nodes)
    parents = joint_parents(nodes, joints)
    rest = change @ nodes.rest()
    bind_world, inverse_binds = _binds(file, joints, parents, rest[joints])
    names = [str(file.node(node).get("name") or "") for node in joints]
    skeleton = skeleton_of(names, parents, rest[joints], bind_world)
    found = read_shapes(file)
    animations, left_out = read_animations(file, nodes, found, joints, parents, change)
    shapes = found.called_alike([animation.tracks for animation in animations])
    meshes, more = read_meshes(file, nodes.parent, joints, bind_world, inverse_binds, rest, shapes)
    kept = shape_names(meshes)
    animations = [replace(each, tracks=each.tracks.among(kept)) for each in animations]
    resting = Tracks(found.names, found.rest[None]).among(kept)
    return Imported(path, skeleton, tuple(meshes), tuple(animations), (*more, *left_out), resting)


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
                raise Fault(where, f"{count} matrices", flat.shape)
            inverses.append(np.swapaxes(flat[:count].reshape(-1, 4, 4), -1, -2))
        else:
            inverses.append(np.tile(np.eye(4), (count, 1, 1)))
        if np.abs(np.linalg.det(inverses[-1])).min() < 1e-18:
            raise Fault(f"skins[{i}]", "matrices with an inverse", "one without")
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
