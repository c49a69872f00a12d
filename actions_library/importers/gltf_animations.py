"""The animations of a glTF file, sampled evenly at the rate of their keys."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from actions_library.importers.gltf_file import GltfFile
from actions_library.importers.gltf_nodes import PARTS, Nodes
from actions_library.importers.gltf_shapes import Shapes
from actions_library.importers.imported import (
    MOST_ANIMATIONS,
    Animation,
    check_poses,
    rigid,
)
from laban.faults import Fault
from smd.character.tracks import NO_TRACKS, Tracks
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import normalized, sign_continuous, slerp

RATES_HZ = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0)
"""Rates that animations are sampled at: the nearest to their keys' spacing."""

DEFAULT_RATE_HZ = 30.0
"""Where no channel has more than two keys."""

_BLOCK = 100_000  # poses that become matrices at once


@dataclass(frozen=True, eq=False)
class _Track:
    """A channel: what it moves, and its keys."""

    node: int
    path: str
    times: FloatArray
    values: FloatArray
    manner: str


def read_animations(
    file: GltfFile,
    nodes: Nodes,
    shapes: Shapes,
    joints: Sequence[int],
    parents: Sequence[int],
    change: FloatArray,
) -> tuple[list[Animation], list[str]]:
    """Return the animations of the joints and shapes, and which ones were left out.

    Parameters
    ----------
    parents
        By joint, its parent's place among the joints.
    change
        ``(4, 4)`` from the file's axes and unit to ours.
    """
    chain = nodes.above(joints)
    animations: list[Animation] = []
    notes: list[str] = []
    poses, count = 0, file.count("animations")
    if count > MOST_ANIMATIONS:
        raise Fault("animations", f"at most {MOST_ANIMATIONS}", count)
    for i in range(count):
        where = f"animations[{i}]"
        name = str(file.item("animations", i).get("name") or f"animation_{i}")
        tracks = _tracks(file, where, i, {*chain}, shapes)
        if not tracks:
            notes.append(f"animation {name!r} moves no joint: left out")
            continue
        start_s, end_s = min(t.times[0] for t in tracks), max(t.times[-1] for t in tracks)
        rate_hz = _rate_hz([track.times for track in tracks])
        frames = max(np.round((end_s - start_s) * rate_hz), 1.0) + 1.0
        check_poses(where, frames, len(chain) + len(shapes.names), poses)
        poses += int(frames) * (len(chain) + len(shapes.names))
        at_s = np.minimum(start_s + np.arange(int(frames)) / rate_hz, end_s)
        local = _moved(nodes, chain, tracks, at_s)
        if np.abs(local["scale"]).min() < 1e-6:
            notes.append(f"animation {name!r} scales joints to nothing: left out")
            continue
        rotation, translation = _posed(file, where, nodes, chain, joints, parents, local, change)
        weights = _weights(shapes, tracks, at_s)
        animations.append(Animation(name, rate_hz, rotation, translation, weights))
    return animations, notes


def _tracks(file: GltfFile, where: str, i: int, chain: set[int], shapes: Shapes) -> list[_Track]:
    """Return the channels of an animation that move joints, nodes above them, or shapes."""
    found: dict[tuple[int, str], _Track] = {}
    for sampler, target in file.channels(i):
        path = target["path"]
        if "node" not in target or path not in {*PARTS, "weights"}:
            continue
        node = file.index(target["node"], "nodes", where)
        if (node, path) in found:
            raise Fault(f"{where}, node {node}", f"one channel of {path}", "two")
        if path == "weights":
            if node not in shapes.columns:
                raise Fault(f"{where}, node {node}", "morph targets of its weights", "none")
            own = shapes.columns[node]
            found[node, path] = _track(file, where, sampler, node, path, own.stop - own.start)
        elif path in PARTS and node in chain:
            found[node, path] = _track(file, where, sampler, node, path, PARTS[path])
    return list(found.values())


def _track(
    file: GltfFile, where: str, sampler: dict[str, Any], node: int, path: str, width: int
) -> _Track:
    """Return a channel whose values are so wide, its keys checked."""
    manner = sampler.get("interpolation", "LINEAR")
    if manner not in ("LINEAR", "STEP", "CUBICSPLINE"):
        raise Fault(where, "LINEAR, STEP or CUBICSPLINE", repr(manner)[:40])
    times = file.accessor(sampler.get("input"), f"{where}: input")[:, 0]
    values = file.accessor(sampler.get("output"), f"{where}: output")
    place = f"{where}, node {node}, {path}"
    if path == "weights" and values.shape[1] == 1:  # single numbers, all of a key in a row
        values = values.reshape(-1, width) if values.size % width == 0 else values
    each = 3 if manner == "CUBICSPLINE" else 1
    if values.shape != (each * len(times), width) or not len(times):
        expected = f"{each * len(times)} values of {width} numbers"
        raise Fault(place, expected, values.shape)
    if not (np.isfinite(times).all() and np.isfinite(values).all()):
        raise Fault(place, "finite keys", "one that is not")
    if (np.diff(times) <= 0.0).any():
        bad = float(times[int(np.argmax(np.diff(times) <= 0.0)) + 1])
        raise Fault(f"{where}, node {node}", "times that increase", f"{bad:g} s")
    return _Track(node, path, times, values, manner)


def _moved(
    nodes: Nodes, chain: Sequence[int], tracks: Sequence[_Track], at_s: FloatArray
) -> dict[str, FloatArray]:
    """Return the parts of nodes' transforms at some times, ``(n, k, c)`` each."""
    local = {
        part: np.tile(values[list(chain)], (len(at_s), 1, 1))
        for part, values in nodes.local.items()
    }
    at = {node: k for k, node in enumerate(chain)}
    for track in tracks:
        if track.path in local:
            moved = sampled(track.times, track.values, at_s, track.manner, track.path)
            local[track.path][:, at[track.node]] = moved
    return local


def _posed(
    file: GltfFile,
    where: str,
    nodes: Nodes,
    chain: Sequence[int],
    joints: Sequence[int],
    parents: Sequence[int],
    local: dict[str, FloatArray],
    change: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return the joints' local rotations and translations, a block of frames at a time."""
    place = {node: k for k, node in enumerate(chain)}
    at = [place[joint] for joint in joints]
    step = max(_BLOCK // len(chain), 1)
    blocks = []
    for first in range(0, len(local["scale"]), step):
        block = {part: values[first : first + step] for part, values in local.items()}
        world = change @ nodes.world(chain, block)[:, at]
        blocks.append(rigid(where, world, parents))
    rotation = np.concatenate([q for q, _ in blocks])
    translation = np.concatenate([t for _, t in blocks])
    return sign_continuous(rotation) if len(blocks) > 1 else rotation, translation


def _weights(shapes: Shapes, tracks: Sequence[_Track], at_s: FloatArray) -> Tracks:
    """Return the weights of all shapes at some times; none where all rest at 0."""
    moving = [track for track in tracks if track.path == "weights"]
    if not moving and not shapes.rest.any():
        return NO_TRACKS
    weights = np.tile(shapes.rest, (len(at_s), 1))
    for track in moving:
        own = sampled(track.times, track.values, at_s, track.manner, track.path)
        weights[:, shapes.columns[track.node]] = own
    return Tracks(shapes.names, weights)


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
