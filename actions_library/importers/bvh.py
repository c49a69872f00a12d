"""BVH: Biovision's hierarchy and motion text [1]_.

A tree of joints with offsets, then a row of numbers per frame, in the order in which the joints
name their channels. Rotations multiply in that order; position channels take the offset's place.
End sites are kept as joints that do not move. Neither unit nor up axis is written down: both are
guessed from the skeleton's size and from where its head is, unless they are given.

References
----------
.. [1] M. Meredith, S. Maddock, "Motion Capture File Formats Explained", University of Sheffield,
   Department of Computer Science, CS-01-11, 2001.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from actions_library.importers.imported import (
    MOST_BYTES,
    MOST_FRAMES,
    MOST_JOINTS,
    Animation,
    Imported,
    checked_unit,
    fault,
    skeleton_of,
    to_y_up,
)
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    multiply,
    quaternion_about,
    quaternion_from_matrix,
    rotate,
    sign_continuous,
)

UNITS_M = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048, "CMU": 0.0254 / 0.45}
"""Units that files are found in; CMU's is 1 / 0.45 inch."""

PERSON_M = 1.7
"""How tall a skeleton is taken to be where nobody says its unit."""

_CHANNELS = {f"{axis}{kind}" for axis in "XYZ" for kind in ("position", "rotation")}
_DEEPEST = 512


@dataclass
class _Hierarchy:
    """The joints of a file, as they are read."""

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[list[float]] = field(default_factory=list)
    channels: list[list[str]] = field(default_factory=list)


def read(path: Path, *, up: str | None, unit_m: float | None) -> Imported:
    """Return the skeleton and the one animation of a BVH file."""
    if path.stat().st_size > MOST_BYTES:
        raise fault(path, "", f"at most {MOST_BYTES} bytes", path.stat().st_size)
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = text.splitlines()
    start = next((i for i, line in enumerate(lines) if line.strip() == "MOTION"), None)
    first = next((line.strip() for line in lines if line.strip()), "")
    if first != "HIERARCHY":
        raise fault(path, "line 1", "HIERARCHY", repr(first[:40]))
    if start is None:
        raise fault(path, f"line {len(lines)}", "MOTION", "the end of the file")
    tree = _hierarchy(path, lines[:start])
    values, frame_s = _motion(path, lines, start, sum(map(len, tree.channels)))
    offsets = np.array(tree.offsets)
    place = offsets.copy()
    for j, parent in enumerate(tree.parents):
        if parent >= 0:
            place[j] += place[parent]
    turn = to_y_up(path, up or _guessed_up(tree, place))
    place = place @ turn.T
    unit = checked_unit(path, _guessed_unit(place) if unit_m is None else unit_m)
    rest = np.tile(np.eye(4), (len(place), 1, 1))
    rest[:, :3, :3], rest[:, :3, 3] = turn, unit * place
    skeleton = skeleton_of(path, tree.names, tree.parents, rest, rest)
    rotation, translation = _poses(tree, offsets, values)
    roots = [j for j, parent in enumerate(tree.parents) if parent < 0]
    whole = quaternion_from_matrix(turn)
    rotation[:, roots] = multiply(whole, rotation[:, roots])
    translation[:, roots] = rotate(whole, translation[:, roots])
    rate_hz = round(1.0 / frame_s, 3)
    animation = Animation(path.stem, rate_hz, sign_continuous(rotation), unit * translation)
    return Imported(path, skeleton, (), (animation,))


def _hierarchy(path: Path, lines: list[str]) -> _Hierarchy:
    """Return the joints that the lines before MOTION name, parents first."""
    tree, pending = _Hierarchy(), ""
    stack: list[int] = []
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words == ["HIERARCHY"]:
            continue
        where, word = f"line {number}", words[0]
        if word in ("ROOT", "JOINT") or words[:2] == ["End", "Site"]:
            if (word == "ROOT") == bool(stack):
                raise fault(
                    path, where, "ROOT outside and JOINT inside of braces", line.strip()[:60]
                )
            pending = " ".join(words[1:]) if word != "End" else f"{tree.names[stack[-1]]}_end"
        elif word == "{":
            if not pending or len(stack) > _DEEPEST or len(tree.names) >= MOST_JOINTS:
                raise fault(path, where, "a joint's name before its brace", "none, or too many")
            tree.names.append(pending)
            tree.parents.append(stack[-1] if stack else -1)
            tree.offsets.append([])
            tree.channels.append([])
            stack.append(len(tree.names) - 1)
            pending = ""
        elif word == "}":
            if not stack:
                raise fault(path, where, "as many { as }", "one } more")
            if not tree.offsets[stack[-1]]:
                raise fault(path, where, f"OFFSET of {tree.names[stack[-1]]!r}", "none")
            stack.pop()
        elif word == "OFFSET" and stack:
            tree.offsets[stack[-1]] = _numbers(path, where, words[1:], 3)
        elif word == "CHANNELS" and stack:
            tree.channels[stack[-1]] = _channels(path, where, words[1:])
        else:
            raise fault(path, where, "ROOT, JOINT, End Site, OFFSET, CHANNELS, { or }", line[:60])
    if stack:
        raise fault(path, f"line {len(lines)}", f"}} of {tree.names[stack[-1]]!r}", "MOTION")
    if not tree.names:
        raise fault(path, "", "ROOT", "no joint")
    return tree


def _numbers(path: Path, where: str, words: list[str], count: int) -> list[float]:
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) != count or not np.isfinite(values).all():
        raise fault(path, where, f"{count} finite numbers", " ".join(words)[:60] or "none")
    return values


def _channels(path: Path, where: str, words: list[str]) -> list[str]:
    count = int(words[0]) if words and re.fullmatch(r"\d{1,2}", words[0]) else -1
    names = words[1:]
    if len(names) != count or not set(names) <= _CHANNELS or len(set(names)) != len(names):
        expected = "a count and as many of Xposition … Zrotation, each once"
        raise fault(path, where, expected, " ".join(words)[:80] or "none")
    return names


def _motion(path: Path, lines: list[str], start: int, width: int) -> tuple[FloatArray, float]:
    """Return the rows of numbers ``(n, width)`` and the seconds from one to the next."""
    body = [(i, line) for i, line in enumerate(lines[start + 1 :], start + 2) if line.strip()]
    heads = {"Frames:": "a count", "Frame Time:": "seconds"}
    given = []
    for (key, what), row in zip(heads.items(), [*body[:2], None, None], strict=False):
        number, line = row or (len(lines), "")
        value = line.strip().removeprefix(key).strip()
        if not line.strip().startswith(key) or not re.fullmatch(r"[-+.\deE]+", value):
            raise fault(path, f"line {number}", f"{key} and {what}", repr(line.strip()[:40]))
        given.append(_numbers(path, f"line {number}", [value], 1)[0])
    frames, frame_s = given
    if frames != int(frames) or not 1 <= frames <= MOST_FRAMES:
        raise fault(path, "Frames", f"1 to {MOST_FRAMES}", f"{frames:g}")
    if not 1e-4 <= frame_s <= 10.0:
        raise fault(path, "Frame Time", "0.0001 to 10 seconds", f"{frame_s:g}")
    rows = body[2:]
    try:
        values = np.array(" ".join(line for _, line in rows).split(), dtype=np.float64)
    except ValueError as error:
        raise fault(path, "MOTION", "numbers", str(error)[:80]) from None
    if len(values) != int(frames) * width:
        for number, line in rows:
            if len(line.split()) != width:
                raise fault(path, f"line {number}", f"{width} numbers", len(line.split()))
        raise fault(path, "MOTION", f"{int(frames)} frames", len(rows))
    values = values.reshape(int(frames), width)
    bad = ~np.isfinite(values).all(axis=1)
    if bad.any():
        raise fault(path, f"frame {int(np.argmax(bad))}", "finite numbers", "one that is not")
    return values, frame_s


def _poses(
    tree: _Hierarchy, offsets: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return local rotations ``(n, j, 4)`` and translations ``(n, j, 3)``, in the file's axes."""
    n = len(values)
    rotation = np.tile(IDENTITY_XYZW, (n, len(offsets), 1))
    translation = np.tile(offsets, (n, 1, 1))
    column = 0
    for j, channels in enumerate(tree.channels):
        for channel in channels:
            axis, value = "XYZ".index(channel[0]), values[:, column]
            if channel.endswith("position"):
                translation[:, j, axis] = value
            else:
                turn = quaternion_about(np.eye(3)[axis], np.radians(value))
                rotation[:, j] = multiply(rotation[:, j], turn)
            column += 1
    return rotation, translation


def _guessed_up(tree: _Hierarchy, place: FloatArray) -> str:
    """Return the axis along which the head is farthest from the first joint, y or z."""
    named = [j for j, name in enumerate(tree.names) if re.search(r"head|neck", name, re.I)]
    way = place[named[-1]] - place[0] if named else np.ptp(place, axis=0) * [0.0, 1.2, 1.0]
    axis = "z" if abs(way[2]) > abs(way[1]) else "y"
    return axis if way["xyz".index(axis)] >= 0.0 else f"-{axis}"


def _guessed_unit(place: FloatArray) -> float:
    """Return the unit in which a skeleton is nearest to a person's height."""
    height = max(float(np.ptp(place[:, 1])), 1e-9)
    return min(UNITS_M.values(), key=lambda unit: abs(np.log(unit * height / PERSON_M)))
