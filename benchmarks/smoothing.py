"""What smoothing keeps and what it takes, by window: ``python -m benchmarks.smoothing``.

Budget: three minutes of one device, 60 samples a second out, within 0.1 s on one core.
"""

from __future__ import annotations

import time
from statistics import median

import numpy as np

from benchmarks.process import machine
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.resampling import interpolate_linear
from smd.geometry.rotations import quaternion_from_euler
from smd.geometry.savgol import smooth_values
from smd.smoothing import WINDOW_S, smooth

SOURCE_HZ = 90.0
WINDOWS_S = (0.1, 2 / 15, 1 / 6, 0.2, 7 / 30, 4 / 15, 0.3)
TREMORS_HZ = (8.0, 10.0, 12.0)
STROKES_S = (0.2, 0.3)


def along_x(time_s: FloatArray, x_m: FloatArray) -> Doodle:
    """Return a doodle that moves along X only."""
    position = np.zeros((len(time_s), 3))
    position[:, 0] = x_m
    return Doodle(time_s, position, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)))


def stroke(time_s: FloatArray, duration_s: float) -> FloatArray:
    """Return a minimum-jerk stroke of one metre that starts at time 0; peak speed 1.875 / T."""
    s = np.clip(time_s / duration_s, 0.0, 1.0)
    return 10 * s**3 - 15 * s**4 + 6 * s**5


def tremor_left(window_s: float, frequency_hz: float) -> float:
    """Return the share of a tremor's speed that smoothing leaves."""
    t = np.arange(0.0, 4.0, 1 / SOURCE_HZ)
    motion = smooth(along_x(t, np.sin(2 * np.pi * frequency_hz * t)), window_s=window_s)
    inside = slice(20, -20)
    phase = 2 * np.pi * frequency_hz * motion.time_s[inside]
    waves = np.stack([np.cos(phase), np.sin(phase)], axis=1)
    found = np.linalg.lstsq(waves, motion.velocity_m_s[inside, 0], rcond=None)[0]
    return float(np.linalg.norm(found) / (2 * np.pi * frequency_hz))


def stroke_left(window_s: float, duration_s: float) -> float:
    """Return the share of a stroke's peak speed that smoothing leaves, over 20 phases."""
    left = []
    for phase in np.linspace(0.0, 1.0, 20, endpoint=False) / SOURCE_HZ:
        t = np.arange(-0.6, 1.0, 1 / SOURCE_HZ) + phase
        speed = smooth(along_x(t + 1.0, stroke(t, duration_s)), window_s=window_s).velocity_m_s
        left.append(speed[:, 0].max() / (1.875 / duration_s))
    return float(np.mean(left))


def speed_noise(window_s: float) -> float:
    """Return the deviation of speed, in mm/s, that 1 mm of white noise at 90 Hz leaves."""
    t = np.arange(0.0, 120.0, 1 / SOURCE_HZ)
    noise = np.random.default_rng(0).normal(size=len(t))
    return float(smooth(along_x(t, noise), window_s=window_s).velocity_m_s[20:-20, 0].std())


def resampling_errors(jitter: float) -> tuple[list[float], list[float]]:
    """Return errors of speed, acceleration and jerk for straight and for cubic resampling.

    A hand that swings 0.2 m at 1 Hz, sampled at 90 Hz with steps uneven by ``jitter``; the
    error is the difference to smoothing the same swing sampled evenly.
    """
    rng = np.random.default_rng(1)
    steps = 1 + rng.uniform(-jitter, jitter, 2000)
    uneven = np.concatenate([[0.0], np.cumsum(steps)]) / SOURCE_HZ

    def swing(t: FloatArray) -> FloatArray:
        return np.asarray(0.1 * np.sin(2 * np.pi * t))

    grid = np.arange(0.0, 20.0, 1 / 120)
    inside = slice(20, -20)

    def derivatives(x_m: FloatArray) -> FloatArray:
        return smooth_values(x_m[:, None], 1 / 120, 12, 2)[1:, inside, 0]

    ideal = derivatives(swing(grid))
    straight = derivatives(interpolate_linear(uneven, swing(uneven), grid))
    motion = smooth(along_x(uneven, swing(uneven)))
    n = ideal.shape[1]
    cubic = np.stack([motion.velocity_m_s, motion.acceleration_m_s2, motion.jerk_m_s3])
    cubic = cubic[:, inside, 0][:, :n]

    def rms(error: FloatArray) -> list[float]:
        return [float(np.sqrt(np.mean(row**2))) for row in error]

    return rms(straight - ideal), rms(cubic - ideal)


def seconds_for_three_minutes(source_hz: float) -> float:
    """Return the median processor time of smoothing a hand that moves and turns all along."""
    t = np.arange(0.0, 180.0, 1 / source_hz)
    position = np.stack([np.sin(t), np.cos(2 * t), 0.1 * t], axis=1)
    angles = np.stack([t, np.sin(t), np.cos(1.3 * t)], axis=1)
    doodle = Doodle(t, position, quaternion_from_euler("YXZ", angles))
    times = []
    for _ in range(7):
        started = time.process_time()
        smooth(doodle)
        times.append(time.process_time() - started)
    return median(times)


def main() -> None:
    print(machine())
    print("\nshares of speed that are left, from 90 Hz; speed noise from 1 mm of white noise")
    print("window   tremor 8 Hz  10 Hz  12 Hz   stroke 0.2 s  0.3 s   noise mm/s")
    for window_s in WINDOWS_S:
        tremors = "  ".join(f"{tremor_left(window_s, f):5.2f}" for f in TREMORS_HZ)
        strokes = "  ".join(f"{stroke_left(window_s, d):5.2f}" for d in STROKES_S)
        mark = " *" if window_s == WINDOW_S else ""
        print(
            f"{window_s:.3f} s        {tremors}          {strokes}"
            f"        {speed_noise(window_s):6.1f}{mark}"
        )
    print("\nerror that uneven sampling adds (rms): speed mm/s, acceleration m/s2, jerk m/s3")
    for jitter in (0.2, 0.4):
        for name, (speed, acceleration, jerk) in zip(
            ("straight", "cubic"), resampling_errors(jitter), strict=True
        ):
            print(
                f"steps uneven by {jitter:.0%}, {name:8}: "
                f"{1000 * speed:7.3f}  {acceleration:7.4f}  {jerk:7.3f}"
            )
    print("\nthree minutes to 60 Hz, one core")
    for source_hz in (60.0, 90.0, 1000.0):
        print(f"from {source_hz:4.0f} Hz: {seconds_for_three_minutes(source_hz):.3f} s")


if __name__ == "__main__":
    main()
