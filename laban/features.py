"""The 50 features of a movement from which Effort is read.

25 signals, each with its mean and standard deviation over the span [1]_: 18 in the moving
frame (left, up, front; linear and angular; speed, acceleration, jerk) and 7 of the path in the
world. `FEATURES` is the one table of them, in the order of the vector; ``python -m laban``
prints it for the docs.

Where the paper leaves a choice:

- A component's signal is its magnitude. The paper speaks of "local up speed". The signed mean of
  a stroke there and back is 0 whatever its quality, and its sign distinguishes up from down, which
  depends on the action and not the Effort.
- Euclidean acceleration and jerk are the norms of those vectors. The derivative of the speed
  would leave out the acceleration that bends a path, and its mean is 0 from rest to rest. Torsion
  and equi-affine acceleration are magnitudes too, so that a movement and its mirror image have
  the same features.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, section 5.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban.effort import LabanError
from laban.motion import FloatArray, RigidMotion
from laban.steps import Steps, finished

MIN_SAMPLES = 4
"""Fewer samples than this have no meaningful standard deviation."""

SLOW_SHARE = 0.25
"""Curvature is undefined where the speed is below this share of the span's RMS speed.

There the direction of the movement is noise: an error of acceleration enters curvature divided
by the speed squared. Samples are excluded by their speed alone and nothing is added to the
denominator, so the mean is unbiased: a circle's is 1/r for any timing.
"""

SLOW_M_S = 0.02
"""Nor is it defined below this speed, which is that of a smoothed hand at rest."""

STRAIGHT_TURN_RAD = 0.1
"""Torsion is undefined where the path is straight: where its curvature, continued over the whole
length of the span, would turn it by less than this. A straight line lies in every plane."""

EQUI_AFFINE_STEP_S = 1.0 / 30.0
"""Equi-affine acceleration is a difference over this time to either side.

Where the triple product changes sign, its sixth root has a vertical tangent: the derivative is
unbounded, and a difference of neighbours would grow with the sampling rate.
"""


@dataclass(frozen=True, slots=True)
class Feature:
    """One entry of the feature vector: its name, unit and formula."""

    name: str
    unit: str
    formula: str


_AXES = ("left", "up", "front")
_LINEAR = (
    ("speed", "m/s", "v"),
    ("acceleration", "m/s^2", "a"),
    ("jerk", "m/s^3", "j"),
)
_ANGULAR = (
    ("speed", "rad/s", "ω"),
    ("acceleration", "rad/s^2", "ω'"),
    ("jerk", "rad/s^3", "ω''"),
)
_PATH = (
    Feature("euclidean_speed", "m/s", "‖v‖"),
    Feature("euclidean_acceleration", "m/s^2", "‖a‖"),
    Feature("euclidean_jerk", "m/s^3", "‖j‖"),
    Feature("curvature", "1/m", "‖v × a‖ / ‖v‖^3"),
    Feature("torsion", "1/m", "abs(v · (a × j)) / ‖v × a‖^2"),
    Feature("equi_affine_speed", "m^(1/2)/s", "abs(v · (a × j))^(1/6)"),
    Feature("equi_affine_acceleration", "m^(1/2)/s^2", "abs(d/dt abs(v · (a × j))^(1/6))"),
)

SIGNALS: tuple[Feature, ...] = (
    *(
        Feature(f"local_{axis}_{name}", unit, f"abs((R^T {letter})·{axis})")
        for name, unit, letter in _LINEAR
        for axis in _AXES
    ),
    *(
        Feature(f"angular_{axis}_{name}", unit, f"abs({letter}·{axis})")
        for name, unit, letter in _ANGULAR
        for axis in _AXES
    ),
    *_PATH,
)
"""The 25 signals, in the order in which `effort_features` stacks them."""

FEATURES: tuple[Feature, ...] = tuple(
    Feature(f"{signal.name}_{statistic}", signal.unit, f"{statistic} of {signal.formula}")
    for signal in SIGNALS
    for statistic in ("mean", "sd")
)
"""The 50 features, in the order of the vector."""

FEATURE_NAMES: tuple[str, ...] = tuple(feature.name for feature in FEATURES)


def effort_features(motion: RigidMotion) -> FloatArray:
    """Return the feature vector of one span of movement.

    It is invariant when the world is moved or turned. Means and standard deviations are over
    time; those of curvature and torsion over the samples where these are defined (`SLOW_SHARE`,
    `SLOW_M_S`, `STRAIGHT_TURN_RAD`), and 0 without such samples, as for a straight line.

    Parameters
    ----------
    motion
        At least `MIN_SAMPLES` samples.

    Returns
    -------
    (50,) finite, none negative, in the order of `FEATURES`.

    Raises
    ------
    LabanError
        If there are fewer samples.
    """
    return finished(features_in_steps(motion))


def features_in_steps(motion: RigidMotion) -> Steps[FloatArray]:
    """Do what `effort_features` does, in steps."""
    if len(motion) < MIN_SAMPLES:
        raise LabanError(f"movement: expected at least {MIN_SAMPLES} samples, got {len(motion)}")
    local = np.abs(np.concatenate([_in_moving_frame(motion), _angular(motion)]))
    everywhere = np.stack([local.mean(axis=1), local.std(axis=1)], axis=1)
    yield
    path = _path_signals(motion)
    yield
    statistics = [_mean_and_sd(signal) for signal in path]
    return np.concatenate([everywhere.ravel(), np.ravel(statistics)])


def _mean_and_sd(signal: FloatArray) -> tuple[float, float]:
    """Return mean and standard deviation; both are 0 for an empty signal."""
    return (float(signal.mean()), float(signal.std())) if len(signal) else (0.0, 0.0)


def _in_moving_frame(motion: RigidMotion) -> FloatArray:
    """Return velocity, acceleration and jerk along left, up and front, ``(9, n)``."""
    x, y, z, w = motion.orientation_xyzw.T
    world_from_body = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    world = np.stack([motion.velocity_m_s, motion.acceleration_m_s2, motion.jerk_m_s3])
    return np.einsum("ijn,kni->kjn", world_from_body, world).reshape(9, -1)


def _angular(motion: RigidMotion) -> FloatArray:
    """Return angular velocity, acceleration and jerk about left, up and front, ``(9, n)``."""
    return np.concatenate(
        [
            motion.angular_velocity_rad_s.T,
            motion.angular_acceleration_rad_s2.T,
            motion.angular_jerk_rad_s3.T,
        ]
    )


def _path_signals(motion: RigidMotion) -> list[FloatArray]:
    """Return the 7 signals of the path in the order of `SIGNALS`, each where it is defined."""
    v, a, j = motion.velocity_m_s, motion.acceleration_m_s2, motion.jerk_m_s3
    speed = _length(v)
    v_cross_a = np.cross(v, a)
    bending = _length(v_cross_a)
    triple = np.abs(np.einsum("ni,ni->n", v_cross_a, j))

    moving = speed > max(SLOW_SHARE * np.sqrt(np.mean(speed**2)), SLOW_M_S)
    curvature = bending[moving] / speed[moving] ** 3
    step_s = motion.step_s
    path_m = float(np.sum(speed)) * step_s
    curved = curvature * path_m > STRAIGHT_TURN_RAD
    torsion = triple[moving][curved] / bending[moving][curved] ** 2

    equi_affine = triple ** (1.0 / 6.0)
    reach = min(max(1, round(EQUI_AFFINE_STEP_S / step_s)), (len(motion) - 1) // 2)
    difference = equi_affine[2 * reach :] - equi_affine[: -2 * reach]
    equi_affine_acceleration = np.abs(difference) / (2 * reach * step_s)
    return [
        speed,
        _length(a),
        _length(j),
        curvature,
        torsion,
        equi_affine,
        equi_affine_acceleration,
    ]


def _length(vector: FloatArray) -> FloatArray:
    """Return the lengths of ``(n, 3)``; several times as fast as numpy.linalg.norm here."""
    return np.sqrt(np.einsum("ni,ni->n", vector, vector))


def feature_table() -> str:
    """Return the features as a Markdown table, one row per signal."""
    rows = ["| # | signal | unit | formula |", "|---|---|---|---|"]
    for i, signal in enumerate(SIGNALS):
        formula = signal.formula.replace("|", "\\|")
        rows.append(f"| {2 * i}, {2 * i + 1} | `{signal.name}` | {signal.unit} | {formula} |")
    return "\n".join(rows) + "\n"
