"""The meshes of a glTF file, bound to its joints, a colour a mesh."""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.gltf_shapes import Shapes
from actions_library.importers.imported import (
    MOST_OFFSETS,
    MOST_POINTS,
    MOST_TRIANGLES,
    bound,
    bound_shape,
    strongest,
    unique_names,
)
from laban.faults import Fault
from smd.character.blend_shape import BlendShape
from smd.character.character import Mesh
from smd.geometry.arrays import FloatArray, IntArray

MOST_COLORS = 12
"""Of a file: textures are not kept, but their colours are, each a mesh of its own."""

_MOST_PIXELS, _MOST_PIXELS_IN_ALL = 1 << 26, 1 << 28
_SIDE = 1024  # of a picture that is kept: more than enough for a colour a triangle
_FORMATS = ("PNG", "JPEG", "WEBP")  # others may start programs: EPS is drawn by one
_GREY = (0.9, 0.9, 0.9)


def read_meshes(
    file: GltfFile,
    parent: Sequence[int],
    joints: list[int],
    bind: FloatArray,
    inverse_binds: list[FloatArray],
    rest: FloatArray,
    shapes: Shapes,
) -> tuple[list[Mesh], list[str]]:
    """Return the meshes that joints move, in the bind pose, and what was left out.

    Parameters
    ----------
    parent
        Of each node.
    joints
        Nodes that are joints.
    bind
        ``(j, 4, 4)`` where they stood when bound.
    inverse_binds
        Of each skin's joints.
    rest
        ``(n, 4, 4)`` each node's matrix at rest.
    shapes
        The file's morph targets.
    """
    parts: list[_Part] = []
    notes: list[str] = []
    loose = points_so_far = faces_so_far = offsets_so_far = 0
    at_of = {node: j for j, node in enumerate(joints)}
    pictures = _Pictures(file)
    for node in range(file.count("nodes")):
        item = file.node(node)
        if "mesh" not in item:
            continue
        mesh = file.item("meshes", file.index(item["mesh"], "meshes", f"nodes[{node}]"))
        holder = node
        while holder >= 0 and holder not in at_of:
            holder = parent[holder]
        if "skin" not in item and holder < 0:
            loose += 1
            continue
        primitives = mesh.get("primitives", [])
        if not isinstance(primitives, list):
            raise Fault(f"meshes[{item['mesh']}]", "a list of primitives", "none")
        for k, primitive in enumerate(primitives):
            where = f"meshes[{item['mesh']}].primitives[{k}]"
            geometry = _geometry(file, primitive, where)
            if geometry is None:
                continue
            points, triangles = geometry
            points_so_far, faces_so_far = points_so_far + len(points), faces_so_far + len(triangles)
            if points_so_far > MOST_POINTS or faces_so_far > MOST_TRIANGLES:
                most = f"at most {MOST_POINTS} points and {MOST_TRIANGLES} triangles in all"
                raise Fault(where, most, f"{points_so_far} and {faces_so_far}")
            formed = shapes.of(file, node, primitive, len(points), where)
            if "skin" in item:
                skin = file.index(item["skin"], "skins", f"nodes[{node}]")
                indices, weights = _influences(file, primitive, len(points), where)
                own = [at_of[j] for j in file.item("skins", skin)["joints"]]
                if indices.max(initial=0) >= len(own):
                    raise Fault(where, f"joints below {len(own)}", indices.max())
                matrices = bind[own] @ inverse_binds[skin]
                points = bound(points, weights, indices, matrices)
                formed = tuple(bound_shape(shape, weights, indices, matrices) for shape in formed)
                indices = np.asarray(own, dtype=np.int64)[indices]
            else:
                at = at_of[holder]
                way = bind[at] @ np.linalg.inv(rest[holder]) @ rest[node]
                points = points @ way[:3, :3].T + way[:3, 3]
                formed = tuple(
                    replace(shape, offsets_m=shape.offsets_m @ way[:3, :3].T) for shape in formed
                )
                indices = np.full((len(points), 4), at, dtype=np.int64)
                weights = np.tile([1.0, 0.0, 0.0, 0.0], (len(points), 1))
            name = str(item.get("name") or mesh.get("name") or f"mesh_{node}")
            rgb = _colors(file, primitive, triangles, pictures, where)
            parts.append(_Part(name, points, triangles, indices, weights, rgb, formed))
            offsets_so_far += sum(len(shape.indices) for shape in formed)
            if offsets_so_far > MOST_OFFSETS:
                raise Fault(where, f"at most {MOST_OFFSETS} offsets in all", offsets_so_far)
    if loose:
        notes.append(f"{loose} meshes that no joint moves are not kept")
    absent = [str(source) for source, pixels in pictures.found.items() if pixels is None]
    if absent:
        notes.append(f"pictures of textures are missing: {', '.join(absent)}")
    return _by_color(parts), notes


class _Part(NamedTuple):
    """A primitive's points, triangles, influences, sRGB colour of each triangle, and shapes."""

    name: str
    points: FloatArray
    triangles: IntArray
    indices: IntArray
    weights: FloatArray
    rgb: FloatArray
    shapes: tuple[BlendShape, ...]


def _by_color(parts: list[_Part]) -> list[Mesh]:
    """Return a mesh for each of the few colours that stand for all of a file's triangles."""
    if not parts:
        return []
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    triangles = np.concatenate([p.triangles + s for p, s in zip(parts, starts, strict=False)])
    points, indices, weights = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("points", "indices", "weights")
    )
    of, palette = _few(np.concatenate([part.rgb for part in parts]))
    owner = np.repeat(np.arange(len(parts)), [len(part.triangles) for part in parts])
    cuts = []
    for color in np.unique(of):
        here = of == color
        largest = int(np.bincount(owner[here]).argmax())
        used, faces = np.unique(triangles[here], return_inverse=True)
        kept = (points[used], faces.reshape(-1, 3), indices[used], weights[used])
        shapes = _shapes_of(parts, starts.tolist(), used)
        cuts.append(Mesh(parts[largest].name, *kept, _linear(palette[color]), shapes))
    names = unique_names([mesh.name for mesh in cuts])
    return [replace(mesh, name=name) for mesh, name in zip(cuts, names, strict=True)]


def _shapes_of(
    parts: Sequence[_Part], starts: Sequence[int], used: IntArray
) -> tuple[BlendShape, ...]:
    """Return what shapes make of some points of all parts; a part's points have a start."""
    found: dict[str, list[tuple[IntArray, FloatArray]]] = {}
    for part, start in zip(parts, starts, strict=False):
        for shape in part.shapes:
            place = np.searchsorted(used, shape.indices + start)
            place = np.minimum(place, len(used) - 1)
            here = used[place] == shape.indices + start
            if here.any():
                found.setdefault(shape.name, []).append((place[here], shape.offsets_m[here]))
    return tuple(
        BlendShape(name, *(np.concatenate(side) for side in zip(*moved, strict=True)))
        for name, moved in found.items()
    )


def _few(rgb: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return which of a few colours stands for each one, and these ``(c, 3)``."""
    from PIL import Image

    image = Image.fromarray((255.0 * rgb[None]).round().astype(np.uint8))
    few = image.quantize(MOST_COLORS, Image.Quantize.MAXCOVERAGE)
    palette = np.array(few.getpalette(), dtype=np.float64)[: 3 * MOST_COLORS].reshape(-1, 3)
    return np.asarray(few)[0].astype(np.int64), palette / 255.0


def _linear(srgb: FloatArray) -> tuple[float, float, float]:
    r, g, b = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).tolist()
    return r, g, b


def _encoded(linear: FloatArray) -> FloatArray:
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def _geometry(file: GltfFile, primitive: Any, where: str) -> tuple[FloatArray, IntArray] | None:
    """Return the points and triangles of a primitive; None where it draws lines or points."""
    if not isinstance(primitive, dict) or not isinstance(primitive.get("attributes"), dict):
        raise Fault(where, "attributes", "none")
    if primitive.get("mode", 4) not in (4, 5, 6):
        return None
    points = file.accessor(primitive["attributes"].get("POSITION"), where)
    if points.shape[1] != 3 or not np.isfinite(points).all() or not len(points):
        raise Fault(where, "finite points", "none, or some that are not")
    if "indices" in primitive:
        order = file.accessor(primitive["indices"], where)[:, 0].astype(np.int64)
    else:
        order = np.arange(len(points))
    if len(order) < 3 or order.max() >= len(points):
        raise Fault(where, f"indices below {len(points)}", order.max(initial=0))
    mode = primitive.get("mode", 4)
    if mode == 4:
        return points, order[: len(order) // 3 * 3].reshape(-1, 3)
    if mode == 6:  # a fan
        ends = np.stack([order[1:-1], order[2:]], axis=-1)
        return points, np.column_stack([np.full(len(ends), order[0]), ends])
    strip = np.stack([order[:-2], order[1:-1], order[2:]], axis=-1)
    strip[1::2, :2] = strip[1::2, 1::-1]
    return points, strip


def _influences(
    file: GltfFile, primitive: dict[str, Any], count: int, where: str
) -> tuple[IntArray, FloatArray]:
    """Return the four strongest joints of each point and their weights."""
    attributes, indices, weights = primitive["attributes"], [], []
    for k in range(8):
        if f"JOINTS_{k}" not in attributes:
            break
        indices.append(file.accessor(attributes[f"JOINTS_{k}"], where))
        weights.append(file.accessor(attributes.get(f"WEIGHTS_{k}"), where))
    if not indices:
        raise Fault(where, "JOINTS_0 and WEIGHTS_0", "none")
    all_indices, all_weights = np.hstack(indices).astype(np.int64), np.hstack(weights)
    if all_indices.shape != all_weights.shape or len(all_indices) != count:
        raise Fault(where, f"joints and weights of {count} points", len(all_indices))
    # Some exporters divide by a sum of zero: such a point goes with its first joint.
    weights_01 = np.clip(np.nan_to_num(all_weights, posinf=0.0, neginf=0.0), 0.0, 1.0)
    return strongest(all_indices, weights_01)


def _colors(
    file: GltfFile,
    primitive: dict[str, Any],
    triangles: IntArray,
    pictures: _Pictures,
    where: str,
) -> FloatArray:
    """Return each triangle's sRGB colour ``(t, 3)``: the material's, times its texture's there."""
    if "material" not in primitive:
        return np.full((len(triangles), 3), _GREY)
    surface = file.item("materials", primitive["material"]).get("pbrMetallicRoughness", {})
    if not isinstance(surface, dict):
        return np.full((len(triangles), 3), _GREY)
    factor = file.numbers(surface.get("baseColorFactor", [1.0] * 4), 4, where)[:3]
    texture = surface.get("baseColorTexture")
    plain = np.tile(_encoded(factor), (len(triangles), 1))
    if not isinstance(texture, dict):
        return plain
    key = f"TEXCOORD_{texture.get('texCoord', 0)}"
    source = file.item("textures", texture.get("index")).get("source")
    if key not in primitive["attributes"] or source is None:
        return plain
    pixels = pictures.pixels(source)
    if pixels is None:
        return plain
    uv = file.accessor(primitive["attributes"][key], where)
    if len(uv) <= triangles.max() or not np.isfinite(uv).all():
        raise Fault(where, "a texture place for each point", len(uv))
    middle = np.mod(uv[triangles].mean(axis=1), 1.0)
    row = np.minimum((middle[:, 1] * len(pixels)).astype(int), len(pixels) - 1)
    column = np.minimum((middle[:, 0] * pixels.shape[1]).astype(int), pixels.shape[1] - 1)
    return np.asarray(pixels[row, column] / 255.0 * _encoded(factor))


class _Pictures:
    """The pictures of a file, each read once."""

    def __init__(self, file: GltfFile) -> None:
        self.file = file
        self.found: dict[int, Any] = {}
        self._size = 0

    def pixels(self, source: Any) -> Any:
        """Return a picture's pixels ``(h, w, 3)`` uint8; None where its file is not there."""
        at = self.file.index(source, "images", "textures")
        if at not in self.found:
            self.found[at] = self._read(at)
        return self.found[at]

    def _read(self, at: int) -> Any:
        from PIL import Image

        item, where = self.file.item("images", at), f"images[{at}]"
        if "bufferView" in item:
            data: bytes | None = bytes(self.file.view(item["bufferView"], where)[0])
        else:
            data = self.file.content(item.get("uri"), f"{where}.uri", needed=False)
        if data is None:
            return None
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # ours is below
                image = Image.open(io.BytesIO(data), formats=_FORMATS)
        except (OSError, Image.DecompressionBombError):
            raise Fault(where, f"a picture, {_FORMATS}", "another") from None
        with image:
            size = image.width * image.height
            self._size += size
            if size > _MOST_PIXELS or self._size > _MOST_PIXELS_IN_ALL:
                most = f"at most {_MOST_PIXELS} pixels, {_MOST_PIXELS_IN_ALL} in all"
                raise Fault(where, most, f"{size}, {self._size}")
            try:
                image.draft("RGB", (_SIDE, _SIDE))
                small = image.convert("RGB")
                small.thumbnail((_SIDE, _SIDE))
            # Damage shows in as many ways as there are decoders.
            except (
                OSError,
                SyntaxError,
                ValueError,
                struct.error,
                zlib.error,
                MemoryError,
            ) as error:
                raise Fault(where, "a whole picture", str(error)[:80]) from None
        return np.asarray(small)
