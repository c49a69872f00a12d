"""Qualities, which the 50 features lack: sizes, the path's geometry, its smoothness and rhythm.

Space is geometry (is the path straight, round, flat, longer than its reach?). Flow is the
proportion of rotation and translation, and the smoothness. Time and Weight generalize better to
other people if speed is taken relative to the movement's own size. Positive quantities that span
orders of magnitude are logarithms, with a floor for what is noise.
"""

from __future__ import annotations

import math

import numpy as np

from laban.body import body_extent_m, body_rate, body_speed
from laban.features import Feature
from laban.motion import FloatArray, RigidMotion
from laban.steps import Steps, finished

SPECTRUM_HZ, SPECTRUM_SHARE = 10.0, 0.05
"""The speed's spectrum is used up to this frequency, while it is above this share of its peak."""

SUBMOVEMENT_SHARE = 0.2
"""A peak of the speed counts as a submovement above this share of the highest."""

SLOW_SHARE = 0.2
"""Slow is below this share of the highest speed."""

CHORD_S = 0.1
"""The path's direction is that of a chord over this time, and accelerations, and the speed whose
peaks are counted, are means over this time: a tracker's noise turns neighbouring samples, and makes
peaks of its own.
"""

REST_M_S2 = 0.3
"""Nearly twice the body acceleration of a body at rest, averaged over `CHORD_S`, for a tracker
whose noise is 1 mm and 0.5 degrees a sample (tests/smd/test_effort.py). It is added in quadrature,
as noise adds, so accelerations far below it cannot be told apart.
"""

MOVING_SHARE, MOVING_M_S = 0.1, 0.02
"""A chord has a direction above this share of the chords' RMS speed, and above this speed."""

PEAK_POWER = 8
"""Power of the speed in the weights of the time of its peak: half the speed has hardly a weight."""

ARRIVAL_S = 0.25
"""How long a movement takes to arrive."""

QUALITIES: tuple[Feature, ...] = (
    Feature("log_duration", "log s", "log T"),
    Feature("log_path", "log m", "log L, L the length of the path"),
    Feature("log_extent", "log m", "log of the RMS distance from the mean position"),
    Feature("log_path_over_reach", "", "log (L / max ‖p - p_0‖)"),
    Feature("log_straightness", "", "log (‖p_T - p_0‖ / L)"),
    Feature("log_turning", "log rad", "log (Θ + 0.3), Θ what chords of 0.1 s turn on the way"),
    Feature("log_turning_per_length", "log rad/m", "log ((Θ + 0.3) / L)"),
    Feature("log_turning_rate", "log rad/s", "log ((Θ + 0.3) / T)"),
    Feature("log_roundness", "", "log (σ_2 / σ_1 + 0.02), σ the path's principal spreads"),
    Feature("log_flatness", "", "log (σ_3 / σ_1 + 0.02)"),
    Feature("log_rotation_rate", "log rad/s", "log (mean ‖ω‖ + 0.1)"),
    Feature("log_rotation_over_speed", "log rad/m", "log ((mean ‖ω‖ + 0.1) / (mean ‖v‖ + 0.01))"),
    Feature("log_rotation", "log rad", "log (∫ ‖ω‖ dt + 0.1)"),
    Feature("spectral_arc_length", "", "minus the length of the spectrum of s up to 10 Hz"),
    Feature("log_dimensionless_jerk", "", "log (∫ s''^2 dt T^3 / max s^2)"),
    Feature("log_submovements", "", "log (1 + peaks of s, averaged over 0.1 s)"),
    Feature("log_submovement_rate", "log 1/s", "log ((1 + peaks) / T)"),
    Feature("time_to_peak", "", "mean time, weighed by the 8th power of s over 0.1 s, / T"),
    Feature("log_peak_speed", "log m/s", "log max s"),
    Feature("log_rms_speed", "log m/s", "log rms s"),
    Feature("log_peak_acceleration", "log m/s^2", "log of the 98th percentile of s'"),
    Feature("log_rms_acceleration", "log m/s^2", "log rms s'"),
    Feature("log_peak_over_mean_speed", "", "log (max s / mean s)"),
    Feature("log_speed_variation", "", "log (sd s / mean s)"),
    Feature("log_acceleration_variation", "", "log (98th percentile of s' / rms s')"),
    Feature("log_acceleration_over_speed", "log 1/s", "log (rms s' / rms s)"),
    Feature("log_jerk_over_acceleration", "log 1/s", "log (rms s'' / rms s')"),
    Feature("slow_share", "", "share of the time in which s < 0.2 max s"),
    Feature("log_speed_range", "", "log of the 10th percentile of s over the 90th"),
    Feature("log_speed_over_extent", "log 1/s", "log (mean s / E)"),
    Feature("log_acceleration_over_extent", "log 1/s^2", "log (rms s' / E)"),
    Feature("log_arrival", "", "log (rms s' of the last 0.25 s / rms s')"),
)
"""Each a number, in the order in which `movement_qualities` gives them: the path's, the rotation's
and, of the whole body (`laban.body`), those of its speed s, acceleration s', jerk s'' and extent E,
all RMS over its parts: s^2 = ‖v‖^2 + (0.1 m)^2 ‖ω‖^2; s' of means over 0.1 s, at rest 0.3 m/s^2."""


def movement_qualities(motion: RigidMotion) -> FloatArray:
    """Return the qualities of one span of movement.

    They are invariant when the world is moved or turned.

    Parameters
    ----------
    motion
        At least `laban.features.MIN_SAMPLES` samples, without still ends.

    Returns
    -------
    (32,) finite, in the order of `QUALITIES`.

    References
    ----------
    .. [1] S. Balasubramanian, A. Melendez-Calderon, A. Roby-Brami, E. Burdet, "On the analysis of
       movement smoothness", Journal of NeuroEngineering and Rehabilitation 12, 2015 (spectral arc
       length, dimensionless jerk).
    """
    return finished(qualities_in_steps(motion))


def qualities_in_steps(motion: RigidMotion) -> Steps[FloatArray]:
    """Do what `movement_qualities` does, in steps."""
    turning_rad = _turning_rad(motion.position_m, motion.step_s)
    of_path = _of_path(motion, turning_rad)
    yield
    speed = body_speed(motion)
    smoothness = spectral_arc_length(speed, motion.step_s)
    yield
    of_speed = yield from _of_speed(motion, speed)
    values = {"spectral_arc_length": smoothness, **of_path, **of_speed}
    return np.array([values[quality.name] for quality in QUALITIES])


def _of_path(motion: RigidMotion, turning_rad: float) -> dict[str, float]:
    """Return the qualities of the path, which turns by so much, and of the rotation."""
    position, step_s = motion.position_m, motion.step_s
    duration_s = step_s * len(motion)
    speed, rate = _length(motion.velocity_m_s), _length(motion.angular_velocity_rad_s)
    mean_speed, mean_rate = float(speed.mean()), float(rate.mean())
    path_m = max(mean_speed * duration_s, 1e-4)

    centred = position - position.mean(axis=0)
    spread = np.sqrt(np.maximum(np.linalg.eigvalsh(centred.T @ centred / len(centred)), 0.0))[::-1]
    longest = max(float(spread[0]), 1e-4)
    from_start = position - position[0]
    reach_m = max(float(_length(from_start).max()), 1e-3)
    net_m = max(float(np.linalg.norm(from_start[-1])), 1e-3)
    turning = turning_rad + 0.3
    rotation = mean_rate + 0.1
    return _logs(
        log_duration=duration_s,
        log_path=path_m,
        log_extent=max(float(np.sqrt(spread @ spread)), 1e-4),
        log_path_over_reach=path_m / reach_m,
        log_straightness=net_m / path_m,
        log_turning=turning,
        log_turning_per_length=turning / path_m,
        log_turning_rate=turning / duration_s,
        log_roundness=float(spread[1]) / longest + 0.02,
        log_flatness=float(spread[2]) / longest + 0.02,
        log_rotation_rate=rotation,
        log_rotation_over_speed=rotation / (mean_speed + 0.01),
        log_rotation=mean_rate * duration_s + 0.1,
    )


def _of_speed(motion: RigidMotion, speed: FloatArray) -> Steps[dict[str, float]]:
    """Return the qualities of the body's speed and its derivatives but the spectrum's, in steps."""
    step_s = motion.step_s
    duration_s = step_s * len(motion)
    reach = round(0.5 * CHORD_S / step_s)
    acceleration = np.hypot(
        body_rate(
            _averaged(motion.acceleration_m_s2, reach),
            _averaged(motion.angular_acceleration_rad_s2, reach),
        ),
        REST_M_S2,
    )
    jerk = body_rate(motion.jerk_m_s3, motion.angular_jerk_rad_s3)
    rms_speed, rms_jerk = max(_rms(speed), 1e-4), max(_rms(jerk), 1e-4)
    rms_acceleration = _rms(acceleration)
    yield
    in_order = np.sort(speed)
    mean_speed, peak = max(float(speed.mean()), 1e-4), max(float(in_order[-1]), 1e-4)
    low, high = _percentile(in_order, 0.1), _percentile(in_order, 0.9)
    peak_acceleration = _percentile(np.sort(acceleration), 0.98)
    extent_m = max(body_extent_m(motion), 1e-4)

    even = _averaged(speed, reach)
    inner = even[1:-1]
    is_peak = (inner > even[:-2]) & (inner >= even[2:]) & (inner > SUBMOVEMENT_SHARE * peak)
    peaks = 1 + int(np.count_nonzero(is_peak))
    arriving = acceleration[-max(round(ARRIVAL_S / step_s), 1) :]
    return {
        "time_to_peak": _time_to_peak(even),
        "slow_share": float(np.searchsorted(in_order, SLOW_SHARE * peak)) / len(speed),
        **_logs(
            log_dimensionless_jerk=rms_jerk**2 * duration_s**4 / peak**2,
            log_submovements=peaks,
            log_submovement_rate=peaks / duration_s,
            log_peak_speed=peak,
            log_rms_speed=rms_speed,
            log_peak_acceleration=peak_acceleration,
            log_rms_acceleration=rms_acceleration,
            log_peak_over_mean_speed=peak / mean_speed,
            log_speed_variation=max(float(speed.std()), 1e-4) / mean_speed,
            log_acceleration_variation=peak_acceleration / rms_acceleration,
            log_acceleration_over_speed=rms_acceleration / rms_speed,
            log_jerk_over_acceleration=rms_jerk / rms_acceleration,
            log_speed_range=(low + 0.01) / (high + 0.01),
            log_speed_over_extent=mean_speed / extent_m,
            log_acceleration_over_extent=rms_acceleration / extent_m,
            log_arrival=_rms(arriving) / rms_acceleration,
        ),
    }


def _turning_rad(position: FloatArray, step_s: float) -> float:
    """Return the total turning of a path, measured between its chords over `CHORD_S`.

    Every chord is compared with the one that begins where it ends. If either is too short to have
    a direction, the pair counts 0.
    """
    k = max(round(CHORD_S / step_s), 1)
    if len(position) <= 2 * k:
        return 0.0
    chord = position[k:] - position[:-k]
    length = _length(chord)
    least = max(MOVING_M_S * k * step_s, MOVING_SHARE * _rms(length))
    product = np.einsum("ni,ni->n", chord[:-k], chord[k:])
    lengths = length[:-k] * length[k:]
    moving = (length[:-k] > least) & (length[k:] > least)
    cosine = np.divide(product, lengths, out=np.ones_like(product), where=moving)
    per_s = float(np.arccos(np.clip(cosine, -1.0, 1.0)).mean()) / (k * step_s)
    return per_s * step_s * len(position)


def _time_to_peak(speed: FloatArray) -> float:
    """Return when a speed is highest, as a share of the time.

    The time of the highest sample would jump where two peaks are nearly as high, as in a run.
    """
    weight = (speed / max(float(speed.max()), 1e-12)) ** PEAK_POWER
    total = max(float(weight.sum()), 1e-12)
    return float(weight @ np.arange(len(speed))) / total / (len(speed) - 1)


def _averaged(signal: FloatArray, reach: int) -> FloatArray:
    """Return the moving average over ``reach`` samples to either side, without incomplete ends.

    ``signal (n,)`` or ``(n, k)``; a short one is returned as it is.
    """
    width = 2 * reach + 1
    if len(signal) < width + 2:
        return signal
    total = np.cumsum(np.concatenate([np.zeros_like(signal[:1]), signal]), axis=0)
    return np.asarray((total[width:] - total[:-width]) / width)


def _percentile(in_order: FloatArray, share: float) -> float:
    """Return a percentile of a sorted signal, interpolated linearly."""
    place = share * (len(in_order) - 1)
    before = min(int(place), len(in_order) - 2)
    return float(in_order[before] + (place - before) * (in_order[before + 1] - in_order[before]))


def _logs(**values: float) -> dict[str, float]:
    """Return logarithms of positive numbers."""
    return {name: math.log(value) for name, value in values.items()}


def _rms(signal: FloatArray) -> float:
    return math.sqrt(float(signal @ signal) / len(signal))


def _length(vector: FloatArray) -> FloatArray:
    return np.sqrt(np.einsum("ni,ni->n", vector, vector))


def spectral_arc_length(speed: FloatArray, step_s: float) -> float:
    """Return minus the length of the normalised spectrum of a speed: 0 would be perfectly smooth.

    Both the spectrum's height and the band in which it is above `SPECTRUM_SHARE` are scaled to 1.
    """
    count = 1 << (int(np.ceil(np.log2(len(speed)))) + 4)
    rates_hz = np.arange(count // 2 + 1) / (count * step_s)
    height = np.abs(np.fft.rfft(speed, count))
    if height[0] <= 0.0:
        return 0.0
    height = height[rates_hz <= SPECTRUM_HZ] / height.max()
    last = int(np.flatnonzero(height >= SPECTRUM_SHARE)[-1])
    if last == 0:
        return 0.0
    return -float(np.sum(np.hypot(1.0 / last, np.diff(height[: last + 1]))))


def quality_table() -> str:
    """Return the qualities as a Markdown table."""
    rows = ["| quality | unit | formula |", "|---|---|---|"]
    rows += [f"| `{q.name}` | {q.unit or '–'} | {q.formula} |" for q in QUALITIES]
    return "\n".join(rows) + "\n"
