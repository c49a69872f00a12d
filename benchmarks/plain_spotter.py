"""What one would write in an afternoon: nearest neighbours by warping, in windows that slide.

Each class is looked for in windows of 0.7, 1 and 1.4 times its usual duration, every 0.1 s, whose
way is about as long as its examples'. A window is compared by dynamic time warping of position
(centred and scaled) and orientation with the examples, and counts where the nearest is nearer than
a threshold, one for all classes: the one that best parts examples of one class from halves of two
classes put together. Of windows that overlap the best stays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import savgol_filter

from benchmarks.tally import Named
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import normalized, rotate
from smd.recognition.alignment import distance_table
from smd.recognition.warping import Templates

SAMPLES, BAND = 32, 0.15
SCALES, STEP_S = (0.7, 1.0, 1.4), 0.1
LEAST_WAY, MOST_WAY = 0.4, 2.5
"""Shares of the shortest and of the longest example's way between which a window's must be."""

AXES = 0.5
"""What the prop's axes count beside its positions, which are scaled to a spread of 1."""

SMOOTHED_S = 0.15
SPLICED, SEED = 300, 0


class PlainSpotter:
    """Finds actions by their examples.

    Parameters
    ----------
    examples
        Of each action, at least two of some action, at even times from 0 s on.
    """

    def __init__(self, examples: Mapping[str, Sequence[Doodle]]) -> None:
        self.names = tuple(examples)
        smoothed = {name: [_smoothed(one) for one in own] for name, own in examples.items()}
        courses = {
            name: np.concatenate([_course(each) for each in own]) for name, own in smoothed.items()
        }
        self._examples = Templates(tuple(courses.values()), BAND)
        self._usual_s = {
            name: float(np.median([each.duration_s for each in own]))
            for name, own in smoothed.items()
        }
        ways = {name: [_way_m(each)[-1] for each in own] for name, own in smoothed.items()}
        self._ways_m = {
            name: (LEAST_WAY * min(each), MOST_WAY * max(each)) for name, each in ways.items()
        }
        alike = [_others_nearest(each) for each in courses.values() if len(each) > 1]
        spliced = _spliced(list(smoothed.values()))
        unlike = distance_table(spliced, np.concatenate(list(courses.values())), band=BAND)
        self.threshold = parting_threshold(np.concatenate(alike), unlike.min(axis=1))

    def spot(self, doodle: Doodle) -> list[Named]:
        """Return what was found, in time order.

        Where a doodle says when it was drawn, only windows count of which at least half was.
        """
        found: list[tuple[float, Named]] = []
        if doodle.duration_s <= min(SCALES) * min(self._usual_s.values()):
            return []
        whole = _smoothed(doodle)
        way_m = _way_m(whole)
        for index, name in enumerate(self.names):
            for scale in SCALES:
                length_s = scale * self._usual_s[name]
                starts_s = np.arange(whole.time_s[0], whole.time_s[-1] - length_s, STEP_S)
                ends_s = starts_s + length_s
                way = np.interp(ends_s, whole.time_s, way_m) - np.interp(
                    starts_s, whole.time_s, way_m
                )
                least_m, most_m = self._ways_m[name]
                kept = (way > least_m) & (way < most_m) & _mostly_drawn(doodle, starts_s, ends_s)
                if not kept.any():
                    continue
                near = self._nearest(index, _courses(whole, starts_s[kept], ends_s[kept]))
                found += [
                    (distance, Named(name, start_s, end_s))
                    for distance, start_s, end_s in zip(
                        near.tolist(), starts_s[kept].tolist(), ends_s[kept].tolist(), strict=True
                    )
                    if np.isfinite(distance)
                ]
        return best_apart(found)

    def _nearest(self, index: int, courses: FloatArray) -> FloatArray:
        """Return how far courses are from an action's nearest example; infinity above threshold."""
        action = np.full(len(courses), index)
        near = np.full(len(courses), np.inf)
        left = self._examples.at_least(courses, action) <= self.threshold
        near[left] = self._examples.nearest(
            courses[left], action[left], np.full(int(left.sum()), self.threshold)
        )
        return near


def best_apart(found: Sequence[tuple[float, Named]]) -> list[Named]:
    """Return what does not overlap anything nearer, in time order."""
    kept: list[Named] = []
    for _, one in sorted(found):
        if all(one.end_s <= each.start_s or one.start_s >= each.end_s for each in kept):
            kept.append(one)
    return sorted(kept, key=lambda each: each.start_s)


def parting_threshold(alike: FloatArray, unlike: FloatArray) -> float:
    """Return the distance of those seen that best tells the like from the unlike, by F1.

    Both count the same, however many of each were seen; of equals the smallest is returned.
    """
    seen = np.unique(np.concatenate([alike, unlike]))
    right = np.searchsorted(np.sort(alike), seen, side="right") / len(alike)
    wrong = np.searchsorted(np.sort(unlike), seen, side="right") / len(unlike)
    return float(seen[np.argmax(2.0 * right / (right + 1.0 + wrong))])


def _smoothed(doodle: Doodle) -> Doodle:
    """Return a doodle at even times through parabolas of 0.15 s."""
    rate_hz = (len(doodle) - 1) / doodle.duration_s
    width = min(max(int(SMOOTHED_S * rate_hz) | 1, 5), (len(doodle) - 1) | 1)
    position_m, orientation = (
        savgol_filter(each, width, 2, axis=0)
        for each in (doodle.position_m, doodle.orientation_xyzw)
    )
    return Doodle(doodle.time_s, position_m, normalized(orientation), doodle.device)


def _way_m(doodle: Doodle) -> FloatArray:
    """Return ``(n,)``, how far a doodle has gone until each sample."""
    steps_m = np.linalg.norm(np.diff(doodle.position_m, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps_m)])


def _course(doodle: Doodle) -> FloatArray:
    """Return ``(1, SAMPLES, 9)``, the course of a whole doodle."""
    return _courses(doodle, doodle.time_s[:1], doodle.time_s[-1:])


def _courses(doodle: Doodle, starts_s: FloatArray, ends_s: FloatArray) -> FloatArray:
    """Return ``(w, SAMPLES, 9)``: positions and two axes of windows, at even times."""
    at_s = starts_s[:, None] + (ends_s - starts_s)[:, None] * np.linspace(0.0, 1.0, SAMPLES)
    both = np.concatenate([doodle.position_m, doodle.orientation_xyzw], axis=1)
    columns = np.stack([np.interp(at_s, doodle.time_s, each) for each in both.T], axis=-1)
    position_m, orientation_xyzw = columns[..., :3], normalized(columns[..., 3:])
    centred = position_m - position_m.mean(axis=1, keepdims=True)
    spread = np.sqrt(np.square(centred).sum(axis=2).mean(axis=1)) + 1e-9
    axes = [
        rotate(orientation_xyzw, np.broadcast_to(axis, centred.shape))
        for axis in ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    ]
    return np.concatenate([centred / spread[:, None, None], *(AXES * each for each in axes)], -1)


def _others_nearest(courses: FloatArray) -> FloatArray:
    """Return how far each example of a class is from the nearest other one."""
    table = distance_table(courses, courses, band=BAND)
    np.fill_diagonal(table, np.inf)
    return np.asarray(table.min(axis=1))


def _spliced(classes: Sequence[Sequence[Doodle]]) -> FloatArray:
    """Return courses of what no class is: the end of one and, from there, the begin of another."""
    rng = np.random.default_rng(SEED)
    courses = []
    for _ in range(SPLICED):
        one, other = (classes[i] for i in rng.permutation(len(classes))[:2])
        a, b = one[int(rng.integers(len(one)))], other[int(rng.integers(len(other)))]
        a = a.selected(np.arange(len(a) // 2, len(a)))
        b = b.selected(np.arange(max(len(b) // 2, 2)))
        position_m = [a.position_m, b.position_m + a.position_m[-1] - b.position_m[0]]
        step_s = a.duration_s / (len(a) - 1)
        time_s = [a.time_s - a.time_s[0], b.time_s - b.time_s[0] + a.duration_s + step_s]
        whole = Doodle(
            np.concatenate(time_s),
            np.concatenate(position_m),
            np.concatenate([a.orientation_xyzw, b.orientation_xyzw]),
        )
        courses.append(_course(whole))
    return np.concatenate(courses)


def _mostly_drawn(doodle: Doodle, starts_s: FloatArray, ends_s: FloatArray) -> FloatArray:
    """Return whether at least half of each window was drawn, or nothing says so."""
    if doodle.drawing is None:
        return np.ones(len(starts_s), bool)
    drawn_s = np.concatenate([[0.0], np.cumsum(np.diff(doodle.time_s) * doodle.drawing[:-1])])
    until_s, before_s = (np.interp(at_s, doodle.time_s, drawn_s) for at_s in (ends_s, starts_s))
    return np.asarray(2.0 * (until_s - before_s) >= ends_s - starts_s)
