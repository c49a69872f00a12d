"""Tokenizer: from a smooth motion to runs of tokens, along the prop's own axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.rotations import inverse, normalized, rotate
from smd.geometry.runs import runs_of_true
from smd.recognition.alphabet import DIRECTIONS, NONE, unit_directions
from smd.recognition.tokens import Token, TokenRun, bins_of_codes, code_of_bins


@dataclass(frozen=True, slots=True)
class Thresholds:
    """Thresholds of the movement that becomes tokens.

    Attributes
    ----------
    still : the paper's epsilon, 0.05. Its sum of squares needs one unit, so speed is counted in
        figure heights per second: a figurine that moves by its own height moves as visibly as one
        that turns by a radian. Alone, it is 0.039 m/s for a figurine of 0.175 m, or 0.22 rad/s.
    moving_on : movement that has begun lasts until its speed falls to this share of that speed; if
        it were lower, the drift of a resting hand would count.
    onset : a movement begins where its speed has risen to this share of its peak, and ends where it
        has fallen to it, as far as the rise and the fall are unbroken; so a slow gesture is not cut
        shorter than a quick one.
    turning_rad_s : rotation begins at this speed and lasts until it falls to epsilon. A hand that
        walks a figurine wobbles faster than epsilon, so the onset must be higher.
    lever_heights : distance from the prop's centre, in figure heights, at which people hold the
        prop to turn it. Translation that rotation about such a point explains is removed: half a
        height reaches every point of the figurine.
    swing_m : an arm's length. Rotation no faster than that of an arm that swings about the
        shoulder on the same path is removed.
    stay_rad : another direction must be nearer than the current one by this angle to replace it.
    shortest_s : only longer runs are kept ("repeated more than twice" at 60 Hz, section 4.3).
    """

    still: float = 0.05
    moving_on: float = 0.5
    onset: float = 0.05
    turning_rad_s: float = 0.8
    lever_heights: float = 0.5
    swing_m: float = 0.7
    stay_rad: float = np.radians(8.0)
    shortest_s: float = 2.0 / 60.0


DEFAULT_THRESHOLDS = Thresholds()


def tokenize(
    motion: RigidMotion,
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
    drawing: BoolArray | None = None,
    thresholds: Thresholds = DEFAULT_THRESHOLDS,
) -> tuple[TokenRun, ...]:
    """Cut a motion into runs of one token each (section 4.1 of the paper [1]_).

    The prop's velocity is taken along its own axes and its angular velocity in the body's, so it
    does not matter where the user stands and faces. Each is quantized to the nearest of 26
    directions, or to none if it is too slow or explained by the other one (rotation about a point
    beside the prop's centre moves it; an arm that swings turns it).

    Parameters
    ----------
    motion
        Smooth, with derivatives; n samples.
    figure_height_m
        Height of the figurine that the prop stands for.
    drawing
        ``(n,)``, false where the user did not mean to draw; such samples are STILL. None where
        nothing says so: then all movement counts.

    Returns
    -------
    tuple of TokenRun
        Covers every sample; neighbours have different tokens.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    """
    if len(motion) == 0:
        return ()
    velocity = rotate(inverse(motion.orientation_xyzw), motion.velocity_m_s)
    turning = motion.angular_velocity_rad_s
    on = np.ones(len(motion), bool) if drawing is None else np.asarray(drawing, bool)

    # The hand twists as well as swings on its way, so all turning is compared with the path.
    speed_m_s = np.linalg.norm(velocity, axis=-1)
    meant_turning = _shortened(turning, speed_m_s / thresholds.swing_m)
    epsilon = np.sqrt(thresholds.still)
    turning_levels = (thresholds.turning_rad_s, min(epsilon, thresholds.turning_rad_s))
    rotation = _bins(meant_turning, turning_levels, on, thresholds)
    lever_m = thresholds.lever_heights * figure_height_m
    meant_velocity = _beyond_lever(velocity, turning * (rotation != NONE)[:, None], lever_m)
    moving_m_s = epsilon * figure_height_m
    moving_levels = (moving_m_s, thresholds.moving_on * moving_m_s)
    translation = _bins(meant_velocity, moving_levels, on, thresholds)

    samples_per_s = (len(motion) - 1) / max(motion.time_s[-1] - motion.time_s[0], 1e-9)
    # + 1e-9: 2/60 s at 60 Hz is 1.999…96 samples, and a run must be longer than that.
    shortest = int(thresholds.shortest_s * samples_per_s + 1e-9) + 1
    starts, codes = _long_runs(code_of_bins(translation, rotation), shortest)
    return _runs(motion, starts, codes, figure_height_m)


def _shortened(vector: FloatArray, by: FloatArray) -> FloatArray:
    """Return vectors shortened by ``by (n,)``, at most to zero."""
    length = np.linalg.norm(vector, axis=-1)
    return normalized(vector) * np.maximum(length - by, 0.0)[:, None]


def _beyond_lever(velocity: FloatArray, turning: FloatArray, lever_m: float) -> FloatArray:
    """Return the velocity that turning about no point within ``lever_m`` explains.

    Turning moves points across its axis alone: what goes along the axis is meant.
    """
    axis = normalized(turning)
    along = np.sum(velocity * axis, axis=-1, keepdims=True) * axis
    return along + _shortened(velocity - along, lever_m * np.linalg.norm(turning, axis=-1))


def _bins(
    vector: FloatArray, levels: tuple[float, float], on: BoolArray, thresholds: Thresholds
) -> IntArray:
    """Return each vector's bin; it begins above the first level and ends below the second."""
    length = np.where(on, np.linalg.norm(vector, axis=-1), 0.0)
    strong = length > levels[0]
    held = _from_onset(length, _joined_to(strong, length > levels[1]), thresholds.onset)
    source = _nearest_in_run(strong, held)
    bins = np.full(len(vector), NONE)
    where = np.flatnonzero(held)
    if len(where):
        first = np.flatnonzero(np.diff(where, prepend=-2) > 1)
        bins[where] = _steady_directions(vector[source[where]], first, thresholds.stay_rad)
    return bins


def _joined_to(strong: BoolArray, weak: BoolArray) -> BoolArray:
    """Return the runs of ``weak`` that hold a sample of ``strong``: hysteresis both ways in time.

    A gesture so begins where it leaves rest, not where it reaches the threshold.
    """
    first, last = runs_of_true(weak).T
    count = np.concatenate([[0], np.cumsum(strong)])
    kept = count[last] > count[first]
    change = np.zeros(len(weak) + 1, np.int64)
    change[first[kept]] += 1
    change[last[kept]] -= 1
    return np.cumsum(change[:-1]) > 0


def _from_onset(length: FloatArray, held: BoolArray, onset: float) -> BoolArray:
    """Return the runs of ``held``, widened while ``length`` falls, to a share of each one's peak.

    A loop over samples, but only over those added.
    """
    widened = held.copy()
    speed = length.tolist()
    first, last = runs_of_true(held).T.tolist()
    for i, (begin, end) in enumerate(zip(first, last, strict=True)):
        floor = onset * max(speed[begin:end])
        earliest, latest = last[i - 1] if i else 0, [*first, len(speed)][i + 1]
        while begin > earliest and floor < speed[begin - 1] < speed[begin]:
            begin -= 1
        while end < latest and floor < speed[end] < speed[end - 1]:
            end += 1
        widened[begin:end] = True
    return widened


def _nearest_in_run(strong: BoolArray, held: BoolArray) -> IntArray:
    """Return for each sample the last strong one of its run, or the first one to come.

    The direction of a slow sample is mostly noise; it takes that of the movement it belongs to.
    """
    n = len(strong)
    index = np.arange(n)
    before = np.maximum.accumulate(np.where(strong, index, -1))
    after = np.minimum.accumulate(np.where(strong, index, n)[::-1])[::-1]
    run_start = np.maximum.accumulate(np.where(held & ~np.roll(held, 1), index, 0))
    return np.where(before >= run_start, before, np.minimum(after, n - 1))


def _steady_directions(vector: FloatArray, first: IntArray, stay_rad: float) -> IntArray:
    """Return the nearest bin of each vector ``(m, 3)``, keeping the current one while it is close.

    ``first`` lists the samples at which a new run begins, with nothing to keep.
    """
    cosine = normalized(vector) @ unit_directions().T
    cosine[:, NONE] = -1.0
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    nearest = np.argmin(angle, axis=-1)
    limit = (np.min(angle, axis=-1) + stay_rad).tolist()
    fresh = np.zeros(len(vector), bool)
    fresh[first] = True
    # A change needs a sample that is nearest to another bin than the one before it, so only the
    # samples where the nearest bin is not the current one are looked at, in plain Python.
    angles, nearests, is_fresh = angle.tolist(), nearest.tolist(), fresh.tolist()
    current, bins = NONE, []
    for row, best, most, new in zip(angles, nearests, limit, is_fresh, strict=True):
        if best != current and (new or row[current] > most):
            current = best
        bins.append(current)
    return np.array(bins, dtype=np.int64)


def _long_runs(code: IntArray, shortest: int) -> tuple[IntArray, IntArray]:
    """Return where each run begins and its code, once runs below ``shortest`` are absorbed.

    A stretch of short runs is shared between the long ones around it, half each. Where no run is
    long, the longest one takes all.
    """
    begin = np.flatnonzero(np.diff(code, prepend=code[0] - 1))
    end = np.append(begin[1:], len(code))
    kept = np.flatnonzero(end - begin >= shortest)
    if len(kept) == 0:
        kept = np.array([int(np.argmax(end - begin))])
    starts = np.concatenate([[0], (end[kept[:-1]] + begin[kept[1:]]) // 2])
    codes = code[begin[kept]]
    changed = np.diff(codes, prepend=codes[0] - 1) != 0
    return starts[changed], codes[changed]


def _runs(
    motion: RigidMotion, starts: IntArray, codes: IntArray, figure_height_m: float
) -> tuple[TokenRun, ...]:
    """Return the runs with their times and how far the prop went and turned in each."""
    step_s = (motion.time_s[-1] - motion.time_s[0]) / max(len(motion) - 1, 1)
    speed = np.linalg.norm(motion.velocity_m_s, axis=-1) / figure_height_m
    rate = np.linalg.norm(motion.angular_velocity_rad_s, axis=-1)
    travel = (np.add.reduceat(speed, starts) * step_s).tolist()
    turn = (np.add.reduceat(rate, starts) * step_s).tolist()
    bounds = np.append(starts, len(motion))
    time_s = np.append(motion.time_s[starts], motion.time_s[-1] + step_s).tolist()
    runs = []
    bins = (each.tolist() for each in bins_of_codes(codes))
    for i, (moving, turning) in enumerate(zip(*bins, strict=True)):
        translation, rotation = DIRECTIONS[moving], DIRECTIONS[turning]
        runs.append(
            TokenRun(
                token=Token(translation, rotation),
                first=int(bounds[i]),
                last=int(bounds[i + 1]),
                start_s=time_s[i],
                end_s=time_s[i + 1],
                travel_heights=travel[i] if any(translation) else 0.0,
                turn_rad=turn[i] if any(rotation) else 0.0,
            )
        )
    return tuple(runs)
