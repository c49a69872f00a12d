"""What the 50 features leave out: sizes, the geometry of the path, its smoothness and rhythm.

Space is geometry (is the path straight, round, flat, longer than its reach?), Flow is how
turning and going share a movement and how smoothly it goes on, and Time and Weight are told
from another person's better where speed is seen beside the movement's own size. What is positive
and spans magnitudes is a logarithm, with a floor below which it is not told apart.
"""

from __future__ import annotations

import numpy as np

from laban.features import Feature
from laban.motion import FloatArray, RigidMotion

SPECTRUM_HZ, SPECTRUM_SHARE = 10.0, 0.05
"""The speed's spectrum is followed up to this rate, while it is above this share of its peak."""

SUBMOVEMENT_SHARE = 0.2
"""A peak of the speed counts as a submovement above this share of the highest."""

SLOW_SHARE = 0.2
"""Slow is below this share of the highest speed."""

MOVING_SHARE, MOVING_M_S = 0.1, 0.005
"""The path's direction is known above this share of the RMS speed, and above this speed."""

QUALITIES: tuple[Feature, ...] = (
    Feature("log_duration", "log s", "log T"),
    Feature("log_path", "log m", "log L, L the length of the path"),
    Feature("log_extent", "log m", "log E, E the RMS distance from the mean position"),
    Feature("log_path_over_reach", "", "log (L / max ‖p - p_0‖)"),
    Feature("log_straightness", "", "log (‖p_T - p_0‖ / L)"),
    Feature("log_turning", "log rad", "log (Θ + 0.3), Θ = ∫ ‖v × a‖ / ‖v‖^2 dt"),
    Feature("log_turning_per_length", "log rad/m", "log ((Θ + 0.3) / L)"),
    Feature("log_turning_rate", "log rad/s", "log ((Θ + 0.3) / T)"),
    Feature("log_roundness", "", "log (σ_2 / σ_1 + 0.02), σ the path's principal spreads"),
    Feature("log_flatness", "", "log (σ_3 / σ_1 + 0.02)"),
    Feature("spectral_arc_length", "", "minus the length of the speed's spectrum up to 10 Hz"),
    Feature("log_dimensionless_jerk", "", "log (∫ ‖j‖^2 dt T^3 / max ‖v‖^2)"),
    Feature("log_submovements", "", "log (1 + peaks of ‖v‖)"),
    Feature("log_submovement_rate", "log 1/s", "log ((1 + peaks of ‖v‖) / T)"),
    Feature("time_to_peak", "", "time of the highest ‖v‖ / T"),
    Feature("log_peak_speed", "log m/s", "log max ‖v‖"),
    Feature("log_rms_speed", "log m/s", "log rms ‖v‖"),
    Feature("log_peak_acceleration", "log m/s^2", "log of the 98th percentile of ‖a‖"),
    Feature("log_peak_over_mean_speed", "", "log (max ‖v‖ / mean ‖v‖)"),
    Feature("log_speed_variation", "", "log (sd ‖v‖ / mean ‖v‖)"),
    Feature("log_acceleration_over_speed", "log 1/s", "log (rms ‖a‖ / rms ‖v‖)"),
    Feature("log_jerk_over_acceleration", "log 1/s", "log (rms ‖j‖ / rms ‖a‖)"),
    Feature("log_rotation_rate", "log rad/s", "log (mean ‖ω‖ + 0.02)"),
    Feature("log_rotation_over_speed", "log rad/m", "log ((mean ‖ω‖ + 0.02) / (mean ‖v‖ + 0.01))"),
    Feature("log_rotation", "log rad", "log (∫ ‖ω‖ dt + 0.05)"),
    Feature("slow_share", "", "share of the time in which ‖v‖ < 0.2 max ‖v‖"),
    Feature("log_speed_range", "", "log of the 10th percentile of ‖v‖ over the 90th"),
    Feature("log_speed_over_extent", "log 1/s", "log (mean ‖v‖ / E)"),
    Feature("log_acceleration_over_extent", "log 1/s^2", "log (rms ‖a‖ / E)"),
)
"""Each a number, in the order in which `movement_qualities` gives them."""


def movement_qualities(motion: RigidMotion) -> FloatArray:
    """Return the qualities of one span of movement.

    They do not change when the world is moved or turned.

    Parameters
    ----------
    motion
        At least `laban.features.MIN_SAMPLES` samples, without still ends.

    Returns
    -------
    (29,) finite, in the order of `QUALITIES`.

    References
    ----------
    .. [1] S. Balasubramanian, A. Melendez-Calderon, A. Roby-Brami, E. Burdet, "On the analysis of
       movement smoothness", Journal of NeuroEngineering and Rehabilitation 12, 2015 (spectral arc
       length, dimensionless jerk).
    """
    v, a, position = motion.velocity_m_s, motion.acceleration_m_s2, motion.position_m
    speed, acceleration, jerk, rate = (
        np.sqrt(np.einsum("ni,ni->n", x, x))
        for x in (v, a, motion.jerk_m_s3, motion.angular_velocity_rad_s)
    )
    step_s = float(motion.time_s[-1] - motion.time_s[0]) / (len(motion) - 1)
    duration_s = step_s * len(motion)
    path_m = max(float(speed.sum()) * step_s, 1e-4)
    rms_speed, rms_acceleration, rms_jerk = (
        max(float(np.sqrt(np.mean(x * x))), 1e-4) for x in (speed, acceleration, jerk)
    )
    mean_speed, peak = max(float(speed.mean()), 1e-4), max(float(speed.max()), 1e-4)

    centred = position - position.mean(axis=0)
    spread = np.sqrt(np.maximum(np.linalg.eigvalsh(centred.T @ centred / len(centred)), 0.0))[::-1]
    extent_m = max(float(np.sqrt(np.sum(spread * spread))), 1e-4)
    longest = max(float(spread[0]), 1e-4)
    from_start = position - position[0]
    reach_m = max(float(np.sqrt(np.einsum("ni,ni->n", from_start, from_start).max())), 1e-3)
    net_m = max(float(np.linalg.norm(from_start[-1])), 1e-3)

    moving = speed > max(MOVING_SHARE * rms_speed, MOVING_M_S)
    bending = np.sqrt(np.sum(np.cross(v[moving], a[moving]) ** 2, axis=-1))
    turning = float(np.sum(bending / speed[moving] ** 2)) * step_s + 0.3
    rotation = float(rate.mean()) + 0.02
    inner = speed[1:-1]
    is_peak = (inner > speed[:-2]) & (inner >= speed[2:]) & (inner > SUBMOVEMENT_SHARE * peak)
    peaks = 1 + int(is_peak.sum())
    low, high = np.percentile(speed, [10.0, 90.0])

    logs = {
        "log_duration": duration_s,
        "log_path": path_m,
        "log_extent": extent_m,
        "log_path_over_reach": path_m / reach_m,
        "log_straightness": net_m / path_m,
        "log_turning": turning,
        "log_turning_per_length": turning / path_m,
        "log_turning_rate": turning / duration_s,
        "log_roundness": spread[1] / longest + 0.02,
        "log_flatness": spread[2] / longest + 0.02,
        "log_dimensionless_jerk": rms_jerk**2 * duration_s**4 / peak**2,
        "log_submovements": peaks,
        "log_submovement_rate": peaks / duration_s,
        "log_peak_speed": peak,
        "log_rms_speed": rms_speed,
        "log_peak_acceleration": max(float(np.percentile(acceleration, 98.0)), 1e-4),
        "log_peak_over_mean_speed": peak / mean_speed,
        "log_speed_variation": max(float(speed.std()), 1e-4) / mean_speed,
        "log_acceleration_over_speed": rms_acceleration / rms_speed,
        "log_jerk_over_acceleration": rms_jerk / rms_acceleration,
        "log_rotation_rate": rotation,
        "log_rotation_over_speed": rotation / (mean_speed + 0.01),
        "log_rotation": float(rate.sum()) * step_s + 0.05,
        "log_speed_range": (low + 0.01) / (high + 0.01),
        "log_speed_over_extent": mean_speed / extent_m,
        "log_acceleration_over_extent": rms_acceleration / extent_m,
    }
    values = {name: float(np.log(value)) for name, value in logs.items()}
    values["spectral_arc_length"] = spectral_arc_length(speed, step_s)
    values["time_to_peak"] = float(np.argmax(speed)) / (len(speed) - 1)
    values["slow_share"] = float(np.mean(speed < SLOW_SHARE * peak))
    return np.array([values[quality.name] for quality in QUALITIES])


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
