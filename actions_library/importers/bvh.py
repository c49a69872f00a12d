"""BVH: Biovision's hierarchy and motion text [1]_.

A tree of joints with offsets, then a row of numbers per frame, in the order in which the joints
name their channels. Rotations multiply in that order; position channels take the offset's place.
End sites are kept as joints that do not move. Neither unit nor up axis is written down: both are
guessed from the skeleton's size and from where its head is, unless they are given.

A file is gone through line by line and never held whole.

References
----------
.. [1] M. Meredith, S. Maddock, "Motion Capture File Formats Explained", University of Sheffield,
   Department of Computer Science, CS-01-11, 2001.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from actions_library.importers.format import ImportOptions
from actions_library.importers.imported import (
    DEEPEST,
    MOST_BYTES,
    MOST_JOINTS,
    Animation,
    Imported,
    check_poses,
    checked_unit,
    skeleton_of,
    to_y_up,
)
from laban.faults import Fault
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
_MOST_LINES, _LONGEST_LINE = 1_000_000, 1 << 20
_BLOCK = 1 << 20  # characters of motion that become numbers at once

Lines = Iterator[tuple[int, str]]
"""Numbers and texts of the lines that are not blank, from 1."""


@dataclass
class _Hierarchy:
    """The joints of a file, as they are read."""

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[list[float]] = field(default_factory=list)
    channels: list[list[str]] = field(default_factory=list)


def read(path: Path, asked: ImportOptions) -> Imported:
    """Return the skeleton and the one animation of a BVH file."""
    if path.stat().st_size > MOST_BYTES:
        raise Fault("", f"at most {MOST_BYTES} bytes", path.stat().st_size)
    lines = _lines(path)
    tree = _hierarchy(lines)
    values, frame_s = _motion(lines, tree)
    offsets = np.array(tree.offsets)
    place = offsets.copy()
    for j, parent in enumerate(tree.parents):
        if parent >= 0:
            place[j] += place[parent]
    turn = to_y_up(asked.up or _guessed_up(tree, place))
    place = place @ turn.T
    unit = checked_unit(_guessed_unit(place) if asked.unit_m is None else asked.unit_m)
    rest = np.tile(np.eye(4), (len(place), 1, 1))
    rest[:, :3, :3], rest[:, :3, 3] = turn, unit * place
    skeleton = skeleton_of(tree.names, tree.parents, rest, rest)
    rotation, translation = _poses(tree, offsets, values)
    roots = [j for j, parent in enumerate(tree.parents) if parent < 0]
    whole = quaternion_from_matrix(turn)
    rotation[:, roots] = multiply(whole, rotation[:, roots])
    translation[:, roots] = rotate(whole, translation[:, roots])
    rate_hz = round(1.0 / frame_s, 3)
    animation = Animation(path.stem, rate_hz, sign_continuous(rotation), unit * translation)
    return Imported(path, skeleton, (), (animation,))


def _lines(path: Path) -> Lines:
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for number in range(1, _MOST_LINES + 2):
            line = file.readline(_LONGEST_LINE)
            if not line:
                return
            if number > _MOST_LINES or len(line) == _LONGEST_LINE:
                expected = f"at most {_MOST_LINES} lines of {_LONGEST_LINE} characters"
                raise Fault(f"line {number}", expected, "more")
            if not line.isspace():
                yield number, line.strip()


def _hierarchy(lines: Lines) -> _Hierarchy:
    """Return the joints that the lines before MOTION name, parents first."""
    number, first = next(lines, (1, ""))
    if first.upper() != "HIERARCHY":
        raise Fault(f"line {number}", "HIERARCHY", repr(first[:40]))
    tree, pending = _Hierarchy(), None
    stack: list[int] = []
    for where, line in _statements(lines):
        words = line.split()
        word = words[0].upper()
        if word == "MOTION":
            if stack:
                raise Fault(where, f"}} of {tree.names[stack[-1]]!r}", "MOTION")
            if not tree.names:
                raise Fault(where, "ROOT", "no joint")
            return tree
        if word in ("ROOT", "JOINT") or line.upper().startswith("END SITE"):
            if (word == "ROOT") == bool(stack):
                raise Fault(where, "ROOT outside and JOINT inside of braces", line[:60])
            pending = " ".join(words[1:]) if word != "END" else f"{tree.names[stack[-1]]}_end"
        elif word == "{":
            if pending is None:
                raise Fault(where, "ROOT, JOINT or End Site before a brace", "none")
            if len(stack) >= DEEPEST or len(tree.names) >= MOST_JOINTS:
                expected = f"at most {MOST_JOINTS} joints, {DEEPEST} one below another"
                raise Fault(where, expected, "another brace")
            tree.names.append(pending or f"joint_{len(tree.names)}")
            tree.parents.append(stack[-1] if stack else -1)
            tree.offsets.append([])
            tree.channels.append([])
            stack.append(len(tree.names) - 1)
            pending = None
        elif word == "}":
            if not stack:
                raise Fault(where, "as many { as }", "one } more")
            if not tree.offsets[stack[-1]]:
                raise Fault(where, f"OFFSET of {tree.names[stack[-1]]!r}", "none")
            stack.pop()
        elif word == "OFFSET" and stack:
            tree.offsets[stack[-1]] = _numbers(where, words[1:], 3)
        elif word == "CHANNELS" and stack:
            tree.channels[stack[-1]] = _channels(where, words[1:])
        else:
            raise Fault(where, "ROOT, JOINT, End Site, OFFSET, CHANNELS, { or }", line[:60])
    raise Fault("", "MOTION", "the end of the file")


def _statements(lines: Lines) -> Iterator[tuple[str, str]]:
    """Yield where statements are and what they say: a brace is one wherever it stands."""
    for number, line in lines:
        for part in re.findall(r"[{}]|[^{}\s][^{}]*", line):
            yield f"line {number}", part


def _numbers(where: str, words: list[str], count: int) -> list[float]:
    try:
        values = [float(word) for word in words if "_" not in word]
    except ValueError:
        values = []
    if len(values) != count or not np.isfinite(values).all():
        raise Fault(where, f"{count} finite numbers", " ".join(words)[:60] or "none")
    return values


def _channels(where: str, words: list[str]) -> list[str]:
    count = int(words[0]) if words and re.fullmatch(r"[0-9]{1,2}", words[0]) else -1
    names = [word.capitalize() for word in words[1:]]
    if len(names) != count or not set(names) <= _CHANNELS or len(set(names)) != len(names):
        expected = "a count and as many of Xposition … Zrotation, each once"
        raise Fault(where, expected, " ".join(words)[:80] or "none")
    return names


def _motion(lines: Lines, tree: _Hierarchy) -> tuple[FloatArray, float]:
    """Return the rows of numbers ``(n, channels)`` and the seconds from one to the next."""
    frames = _said(lines, r"Frames\s*:", "Frames: and a count")
    if frames != int(frames) or frames < 1:
        raise Fault("Frames", "a whole number from 1", f"{frames:g}")
    check_poses("Frames", frames, len(tree.names))
    frame_s = _said(lines, r"Frame\s+Time\s*:", "Frame Time: and seconds")
    if not 1e-4 <= frame_s <= 10.0:
        raise Fault("Frame Time", "0.0001 to 10 seconds", f"{frame_s:g}")
    width = sum(map(len, tree.channels))
    values = _values(lines, int(frames), width).reshape(int(frames), width)
    bad = ~np.isfinite(values).all(axis=1)
    if bad.any():
        raise Fault(f"frame {int(np.argmax(bad))}", "finite numbers", "one that is not")
    return values, frame_s


def _said(lines: Lines, key: str, expected: str) -> float:
    """Return the number behind a key, which the next line has to name."""
    number, line = next(lines, (0, ""))
    found = re.fullmatch(key + r"\s*([-+.0-9eE]+)", line, re.IGNORECASE)
    if not found:
        where = f"line {number}" if number else "the end of the file"
        raise Fault(where, expected, repr(line[:40]))
    return _numbers(f"line {number}", [found[1]], 1)[0]


def _values(lines: Lines, frames: int, width: int) -> FloatArray:
    """Return the numbers that follow, if they are as many as frames and channels ask for."""
    parts: list[FloatArray] = []
    total, uneven = 0, ""
    for block in _blocks(lines):
        words = " ".join(line for _, line in block).split()
        if not uneven and len(words) != width * len(block):
            counts = ((number, len(line.split())) for number, line in block)
            uneven = next(f"line {n}: {count} numbers" for n, count in counts if count != width)
        total += len(words)
        if total > frames * width:
            break
        try:
            parts.append(np.array(words, dtype=np.float64))
        except ValueError as error:
            where = f"MOTION, from line {block[0][0]}"
            raise Fault(where, "numbers", str(error)[:80]) from None
    if total != frames * width:
        found = uneven or (f"{total // width} rows" if width else "numbers without a channel")
        more = " or more" if total > frames * width else ""
        raise Fault("MOTION", f"{frames} frames of {width} numbers", found + more)
    return np.concatenate(parts) if parts else np.empty(0)


def _blocks(lines: Lines) -> Iterator[list[tuple[int, str]]]:
    """Yield the lines, some thousands at a time."""
    block, size = [], 0
    for number, line in lines:
        block.append((number, line))
        size += len(line)
        if size > _BLOCK:
            yield block
            block, size = [], 0
    if block:
        yield block


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
