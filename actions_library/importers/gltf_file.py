"""A glTF file's JSON and binary data, every index and length checked before it is used."""

from __future__ import annotations

import base64
import struct
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

import numpy as np

from actions_library.importers.imported import MOST_BYTES
from laban.faults import Fault
from laban.json_node import parse_json
from smd.geometry.arrays import FloatArray

_COMPONENTS = {
    "5120": "i1",
    "5121": "u1",
    "5122": "<i2",
    "5123": "<u2",
    "5125": "<u4",
    "5126": "<f4",
}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_MOST_VALUES = 1 << 24
_MOST_WORK, _WORK_PER_ACCESSOR = 1 << 26, 400
_MOST_ITEMS = 1 << 22  # of JSON: lists, objects and what they hold
_MOST_NODES = 1 << 16
_SUPPORTED = {
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_node_visibility",
    "EXT_texture_webp",
}
"""Extensions without which a file reads the same here, or nearly: colours may be others. All
materials' may be required too."""
_JSON, _BIN = 0x4E4F534A, 0x004E4942


class GltfFile:
    """A file that was opened: ask it for items, accessors and images.

    Raises
    ------
    Fault
        If it is no glTF 2.0, or, when something is asked for, if that is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if path.stat().st_size > MOST_BYTES:
            raise Fault("", f"at most {MOST_BYTES} bytes", path.stat().st_size)
        data = path.read_bytes()
        self._binary: bytes | None = None
        if data[:4] == b"glTF" or path.suffix.lower() == ".glb":
            data = self._chunks(data)
        self.document = self._parsed(data)
        version = self.document.get("asset", {})
        version = version.get("version") if isinstance(version, dict) else None
        if version is None or not str(version).startswith("2."):
            raise Fault("asset.version", "2.0", repr(version)[:40])
        required = self.document.get("extensionsRequired", [])
        for name in map(str, required if isinstance(required, list) else [required]):
            if name not in _SUPPORTED and not name.startswith("KHR_materials_"):
                expected = "no extension that changes how a file is read"
                raise Fault("extensionsRequired", expected, repr(name)[:60])
        if self.count("nodes") > _MOST_NODES:
            raise Fault("nodes", f"at most {_MOST_NODES}", self.count("nodes"))
        self._buffers: dict[int, bytes] = {}
        self._work = 0

    def _chunks(self, data: bytes) -> bytes:
        """Return the JSON of a GLB, and keep its binary chunk."""
        if len(data) < 20 or data[:4] != b"glTF":
            raise Fault("", "glTF at the start of a GLB", repr(data[:4]))
        version, length = struct.unpack_from("<II", data, 4)
        if version != 2 or length > len(data):
            raise Fault("header", f"version 2, {length} bytes", f"{len(data)} bytes")
        parts: dict[int, bytes] = {}
        at = 12
        while at + 8 <= length:
            size, kind = struct.unpack_from("<II", data, at)
            if at + 8 + size > length:
                raise Fault(f"chunk at byte {at}", f"{size} bytes", length - at - 8)
            parts.setdefault(kind, data[at + 8 : at + 8 + size])
            at += 8 + size
        if _JSON not in parts:
            raise Fault("", "a JSON chunk", "none")
        self._binary = parts.get(_BIN)
        return parts[_JSON]

    def _parsed(self, data: bytes) -> dict[str, Any]:
        items = sum(data.count(mark) for mark in (b",", b"{", b"["))
        if items > _MOST_ITEMS:
            raise Fault("", f"JSON of at most {_MOST_ITEMS} items", items)
        document = parse_json(data).value
        if not isinstance(document, dict):
            raise Fault("", "a JSON object", type(document).__name__)
        return document

    def count(self, kind: str) -> int:
        """Return how many items of a kind there are."""
        items = self.document.get(kind, [])
        if not isinstance(items, list):
            raise Fault(kind, "a list", type(items).__name__)
        return len(items)

    def item(self, kind: str, i: Any) -> dict[str, Any]:
        """Return one item of a kind."""
        found = self.document[kind][self.index(i, kind, kind)]
        if not isinstance(found, dict):
            raise Fault(f"{kind}[{i}]", "an object", type(found).__name__)
        return found

    def node(self, i: int) -> dict[str, Any]:
        """Return a node."""
        return self.item("nodes", i)

    def index(self, i: Any, kind: str, where: str) -> int:
        """Return an index of an item of a kind, if it is one."""
        count = self.count(kind)
        if type(i) is not int or not 0 <= i < count:
            raise Fault(where, f"an index of {kind} below {count}", repr(i)[:40])
        return i

    def indices(self, item: dict[str, Any], key: str, kind: str, where: str) -> list[int]:
        """Return a list of indices; none where the key is absent."""
        found = item.get(key, [])
        if not isinstance(found, list):
            raise Fault(f"{where}.{key}", "a list", type(found).__name__)
        return [self.index(i, kind, f"{where}.{key}") for i in found]

    def numbers(self, value: Any, count: int, where: str) -> FloatArray:
        """Return so many finite numbers."""
        good = isinstance(value, list) and len(value) == count
        good = good and all(type(v) in (int, float) for v in value)
        try:
            array = np.array(value, dtype=np.float64) if good else np.full(count, np.nan)
        except OverflowError:  # a whole number beyond the largest float
            array = np.full(count, np.inf)
        if not np.isfinite(array).all():
            raise Fault(where, f"{count} finite numbers", repr(value)[:60])
        return array

    def channels(self, i: int) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        """Yield the sampler and the target of an animation's channels."""
        animation, where = self.item("animations", i), f"animations[{i}]"
        samplers, channels = animation.get("samplers", []), animation.get("channels", [])
        if not isinstance(samplers, list) or not isinstance(channels, list):
            raise Fault(where, "lists of samplers and channels", "something else")
        for channel in channels:
            at: Any = channel.get("sampler") if isinstance(channel, dict) else None
            good = type(at) is int and 0 <= at < len(samplers) and isinstance(samplers[at], dict)
            target = channel.get("target") if good else None
            if not isinstance(target, dict):
                raise Fault(where, "channels with a sampler and a target", repr(at)[:40])
            yield samplers[at], {**target, "path": str(target.get("path"))}

    def accessor(self, i: Any, where: str) -> FloatArray:
        """Return an accessor's values ``(count, width)``, normalised integers as shares."""
        item = self.item("accessors", self.index(i, "accessors", where))
        where = f"accessors[{i}]"
        count = self._whole(item, "count", where)
        # As text, since a key may be anything, a list too.
        kind, component = str(item.get("type")), str(item.get("componentType"))
        if kind not in _WIDTHS or component not in _COMPONENTS:
            raise Fault(where, "a known type", f"{kind!r} of {component!r}"[:60])
        width, dtype = _WIDTHS[kind], np.dtype(_COMPONENTS[component])
        if count * width > _MOST_VALUES:
            raise Fault(where, f"at most {_MOST_VALUES} numbers", count * width)
        # A small file may ask for the same numbers again and again.
        self._work += count * width + _WORK_PER_ACCESSOR
        if self._work > _MOST_WORK:
            raise Fault(where, f"at most {_MOST_WORK} numbers in all", "more")
        if "bufferView" in item:
            values = self._values(item["bufferView"], item, count, width, dtype, where).copy()
        else:
            values = np.zeros((count, width), dtype)
        if "sparse" in item:
            self._replace_sparse(values, item["sparse"], dtype, where)
        found = values.astype(np.float64)
        if item.get("normalized") and dtype.kind in "iu":
            found = np.maximum(found / np.iinfo(dtype).max, -1.0)
        return found

    def _replace_sparse(self, values: Any, sparse: Any, dtype: np.dtype[Any], where: str) -> None:
        where = f"{where}.sparse"
        parts = [sparse.get(key) if isinstance(sparse, dict) else None for key in _SPARSE]
        if not all(isinstance(part, dict) for part in parts):
            raise Fault(where, "indices and values", "something else")
        at, new = parts
        count = self._whole(sparse, "count", where)
        component = str(at.get("componentType"))  # type: ignore[union-attr]
        if count > len(values) or component not in ("5121", "5123", "5125"):
            raise Fault(where, f"at most {len(values)} unsigned indices", count)
        kind = np.dtype(_COMPONENTS[component])
        view = at.get("bufferView"), new.get("bufferView")  # type: ignore[union-attr]
        rows = self._values(view[0], at or {}, count, 1, kind, where)[:, 0].astype(np.int64)
        if len(rows) and rows.max() >= len(values):
            raise Fault(where, f"indices below {len(values)}", int(rows.max()))
        values[rows] = self._values(view[1], new or {}, count, values.shape[1], dtype, where)

    def _values(
        self,
        view: Any,
        item: dict[str, Any],
        count: int,
        width: int,
        dtype: np.dtype[Any],
        where: str,
    ) -> Any:
        """Return ``(count, width)`` values of a buffer view, without a copy."""
        data, stride = self.view(view, where)
        offset = self._whole(item, "byteOffset", where, 0)
        each = width * dtype.itemsize
        stride = stride or each
        end = offset + (stride * (count - 1) + each if count else 0)
        if stride < each or end > len(data):
            raise Fault(where, f"{end} bytes in its buffer view", len(data))
        return np.ndarray((count, width), dtype, data, offset, (stride, dtype.itemsize))

    def view(self, i: Any, where: str) -> tuple[bytes | memoryview, int]:
        """Return a buffer view's bytes and its stride, 0 where there is none."""
        item = self.item("bufferViews", self.index(i, "bufferViews", where))
        where = f"bufferViews[{i}]"
        data = self._buffer(item.get("buffer"), where)
        offset = self._whole(item, "byteOffset", where, 0)
        length = self._whole(item, "byteLength", where)
        if offset + length > len(data):
            raise Fault(where, f"{offset + length} bytes in its buffer", len(data))
        return memoryview(data)[offset : offset + length], self._whole(item, "byteStride", where, 0)

    def _whole(self, item: dict[str, Any], key: str, where: str, default: int | None = None) -> int:
        value = item.get(key, default)
        if type(value) is not int or value < 0:
            raise Fault(f"{where}.{key}", "a whole number from 0", repr(value)[:40])
        return value

    def _buffer(self, i: Any, where: str) -> bytes:
        at = self.index(i, "buffers", where)
        if at not in self._buffers:
            item = self.item("buffers", at)
            if "uri" in item:
                data = self.content(item["uri"], f"buffers[{at}].uri")
                self._buffers[at] = data or b""
            elif at == 0 and self._binary is not None:
                self._buffers[at] = self._binary
            else:
                raise Fault(f"buffers[{at}]", "a uri or a binary chunk", "neither")
            length = self._whole(item, "byteLength", f"buffers[{at}]")
            if length > len(self._buffers[at]):
                found = len(self._buffers[at])
                raise Fault(f"buffers[{at}]", f"{length} bytes", found)
        return self._buffers[at]

    def content(self, uri: Any, where: str, *, needed: bool = True) -> bytes | None:
        """Return what a URI leads to: data within it, or a file in this one's folder.

        None where that file is missing and not needed.
        """
        if not isinstance(uri, str):
            raise Fault(where, "text", repr(uri)[:40])
        if uri.startswith("data:"):
            head, comma, text = uri.partition(",")
            if not comma or not head.endswith(";base64"):
                raise Fault(where, "data in base64", head[:60])
            try:
                return base64.b64decode(text, validate=True)
            except ValueError as error:
                raise Fault(where, "base64", str(error)) from None
        name = unquote(uri)
        parts = PurePosixPath(name).parts
        folder = self.path.parent.resolve()
        outside = ".." in parts or "\\" in name or ":" in name or name.startswith("/")
        try:
            target = folder.joinpath(*parts).resolve()
            there = target.is_file()
        except (OSError, ValueError):  # a name too long, or with a zero byte
            raise Fault(where, "a file's name", repr(uri)[:80]) from None
        if outside or not target.is_relative_to(folder):
            raise Fault(where, "a file in the same folder", repr(uri)[:80])
        if not there:
            if not needed:
                return None
            raise Fault(where, "a file", f"none: {name[:80]}")
        if target.stat().st_size > MOST_BYTES:
            raise Fault(where, f"at most {MOST_BYTES} bytes", target.stat().st_size)
        try:
            return target.read_bytes()
        except OSError as error:
            raise Fault(where, "a file to read", error.strerror) from None


_SPARSE = ("indices", "values")
