"""Few keys: the frames to write, so that interpolation between them stays close to all others.

A SkelAnimation has the rotations of all joints in one array a time sample, so a key is a pose of
the whole body, and the weights of all shapes. What is at keys is exact.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exporters.bounds import joint_boxes
from smd.character.character import Character
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses, mixed
from smd.character.tracks import NO_TRACKS, Tracks
from smd.errors import ExportError
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.rotations import matrix_from_quaternion, slerp

_BATCH = 4096  # frames that are measured at once: 8 corners of 27 joints then take 21 MB
_SHORT = 4  # gaps up to this are tried from all frames at once, since most are no longer

Mix = Callable[[Poses, Poses, FloatArray], Poses]
"""A way to interpolate between poses: ``share (n,)`` of the way from the first to the second."""


def slerped(a: Poses, b: Poses, share: FloatArray) -> Poses:
    """Return poses between two, as USD interpolates time samples: at constant angular speed."""
    share = share[:, None]
    straight = a.translation_m + share[..., None] * (b.translation_m - a.translation_m)
    return Poses(slerp(a.rotation_xyzw, b.rotation_xyzw, share), straight)


MIXES: tuple[Mix, ...] = (slerped, mixed)
"""How readers interpolate: USD, and Blender between the keys that it makes of time samples."""


def key_frames(
    character: Character, poses: Poses, within_m: float, tracks: Tracks = NO_TRACKS
) -> IntArray:
    """Return the frames to keep, the first and the last among them, in order.

    From each key the next is as far away as it may be: the gap doubles until it is too wide, then
    the widest good one is sought between. Where a gap that is good has only good gaps inside it,
    no choice has fewer keys. Gaps are measured as USD interpolates; where Blender's way leads
    further away than that, a key is added.

    Parameters
    ----------
    character
        Its skin is measured: the corners of a box around what each joint moves.
    poses
        ``(n, …)``.
    within_m
        Greatest distance of any point of the skin from where it is at each frame, in the world and
        however a reader interpolates (`MIXES`).
    tracks
        ``(n, …)``, of which the weights of shapes count; any reader interpolates them linearly.

    Raises
    ------
    ExportError
        If the distance is not positive.
    """
    if not (np.isfinite(within_m) and within_m > 0):
        raise ExportError(f"keys_within_m: expected a positive number, found {within_m!r}")
    drift = _Drift(character, poses, tracks)
    last = len(drift) - 1
    short = _short_gaps(drift, within_m)
    keys = [0]
    while keys[-1] < last:
        here = keys[-1]
        keys.append(here + (int(short[here]) or _long_gap(drift, here, within_m)))
    return _mended(drift, np.array(keys), within_m)


def drift_m(
    character: Character, poses: Poses, keys: IntArray, tracks: Tracks = NO_TRACKS
) -> FloatArray:
    """Return how far the skin is at most from where it is at each frame, ``(n,)``, with keys alone.

    It is the greatest over all `MIXES`; 0 at keys.
    """
    drift = _Drift(character, poses, tracks)
    between = np.setdiff1d(np.arange(len(drift)), keys)
    found = np.zeros(len(drift))
    found[between] = _at(drift, keys, between)
    return found


class _Drift:
    """How far the skin strays when poses and weights between two frames are interpolated."""

    def __init__(self, character: Character, poses: Poses, tracks: Tracks) -> None:
        self._skeleton = character.skeleton
        self._corners_m = np.swapaxes(joint_boxes(character, tracks), -1, -2)  # (j, 3, 8)
        self._poses = poses
        weights = tracks.among(character.shapes)
        reach = _shape_reach_m(character)
        self._formed_m = weights.over(len(poses.rotation_xyzw)).value * [
            reach[name] for name in weights.names
        ]
        self._meant = self._placed(poses)

    def __len__(self) -> int:
        return len(self._poses.rotation_xyzw)

    def of(self, first: IntArray, last: IntArray, frame: IntArray, mix: Mix) -> FloatArray:
        """Return the greatest distance of a point at frames between two others, ``(k,)``, metres.

        All are ``(k,)``: frame i is reached between ``first[i]`` and ``last[i]``.
        """
        found = np.zeros(len(frame))
        for start in range(0, len(frame), _BATCH):
            part = slice(start, start + _BATCH)
            found[part] = self._part(first[part], last[part], frame[part], mix)
        return found

    def _part(self, first: IntArray, last: IntArray, frame: IntArray, mix: Mix) -> FloatArray:
        share = (frame - first) / (last - first)
        shown = self._placed(mix(self._at(first), self._at(last), share))
        turned, moved = (a - b[frame] for a, b in zip(shown, self._meant, strict=True))
        # Affine in the point, so that no point of a box is further away than one of its corners.
        apart = turned @ self._corners_m + moved[..., None]
        moved_m = np.sqrt(np.einsum("njxc,njxc->njc", apart, apart).max(axis=(1, 2)))
        return np.asarray(moved_m + self._part_formed(first, last, frame, share[:, None]))

    def _part_formed(
        self, first: IntArray, last: IntArray, frame: IntArray, share: FloatArray
    ) -> FloatArray:
        """Return how far shapes alone stray at most: joints turn that, and make it no longer."""
        a, b = self._formed_m[first], self._formed_m[last]
        return np.abs(a + share * (b - a) - self._formed_m[frame]).sum(axis=-1)

    def _at(self, frame: IntArray) -> Poses:
        return Poses(*(part[frame] for part in self._poses))

    def _placed(self, poses: Poses) -> tuple[FloatArray, FloatArray]:
        """Return matrices ``(n, j, 3, 3)`` and positions ``(n, j, 3)`` in the world."""
        rotation, position_m = forward_kinematics(self._skeleton, *poses)
        return matrix_from_quaternion(rotation), position_m


def _shape_reach_m(character: Character) -> dict[str, float]:
    """Return how far each shape moves any point at weight 1."""
    found: dict[str, float] = dict.fromkeys(character.shapes, 0.0)
    for mesh in character.meshes:
        for shape in mesh.shapes:
            longest = np.linalg.norm(shape.offsets_m, axis=-1).max(initial=0.0)
            found[shape.name] = max(found[shape.name], float(longest))
    return found


def _good(drift: _Drift, first: IntArray, gap: int, within_m: float) -> BoolArray:
    """Return whether each gap of one width, from ``first (k,)`` on, keeps within a distance."""
    inside = np.arange(1, gap)
    starts = np.repeat(first, len(inside))
    frames = starts + np.tile(inside, len(first))
    found = drift.of(starts, starts + gap, frames, slerped).reshape(len(first), gap - 1)
    return np.asarray((found <= within_m).all(axis=1))


def _short_gaps(drift: _Drift, within_m: float) -> IntArray:
    """Return the widest good gap from each frame on, ``(n,)``; 0 where it is `_SHORT` or wider."""
    last = len(drift) - 1
    widest = np.zeros(len(drift), dtype=np.int64)
    open_ = np.arange(last)
    for gap in range(2, _SHORT + 1):
        ends = open_ + gap > last
        good = np.zeros(len(open_), dtype=bool)
        good[~ends] = _good(drift, open_[~ends], gap, within_m)
        widest[open_[~good]] = gap - 1
        open_ = open_[good]
    return widest


def _long_gap(drift: _Drift, first: int, within_m: float) -> int:
    """Return a good gap from a frame on, found by doubling one of `_SHORT` and halving."""

    def good(gap: int) -> bool:
        return bool(_good(drift, np.array([first]), gap, within_m)[0])

    most = len(drift) - 1 - first
    low, high = _SHORT, 2 * _SHORT
    while high <= most and good(high):
        low, high = high, 2 * high
    high = min(high, most + 1)  # too wide, or past the end
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if good(middle) else (low, middle)
    return low


def _mended(drift: _Drift, keys: IntArray, within_m: float) -> IntArray:
    """Return keys and more of them, until every way to interpolate keeps within a distance."""
    while True:
        between = np.setdiff1d(np.arange(len(drift)), keys)
        found, gap = _at(drift, keys, between), np.searchsorted(keys, between)
        worst = np.zeros(len(keys))
        np.maximum.at(worst, gap, found)
        added = between[(found > within_m) & (found == worst[gap])]
        if len(added) == 0:
            return keys
        keys = np.union1d(keys, added)


def _at(drift: _Drift, keys: IntArray, between: IntArray) -> FloatArray:
    """Return the greatest distance at frames that are no keys, however they are interpolated."""
    right = np.searchsorted(keys, between)
    first, last = keys[right - 1], keys[right]
    return np.max([drift.of(first, last, between, mix) for mix in MIXES], axis=0)
