"""Size: a movement outside of the range of training sizes is read at a size within.

A VR hand travels six times as far as a hand that guides a robot, without meaning more by it. The
size of a movement relative to the training movements is estimated from all of its entries: it is
the factor that makes it most like them (generalised least squares, the entries' covariance half
diagonal). Within the usual range a size is kept, since strong movements go further than light
ones. One far beyond carries no information, and is replaced by the usual one.

References
----------
.. [1] P. J. Huber, E. M. Ronchetti, "Robust Statistics", 2nd edition, 2009, section 4.8
   (redescending estimators: why far outliers should not count).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laban.body import BODY_RADIUS_M
from laban.description import DESCRIPTION_NAMES, FLOORS
from laban.features import FEATURES, SIGNALS
from laban.motion import FloatArray
from laban.qualities import REST_M_S2
from laban.steps import Steps, finished

ROUNDS = 3
"""Iterations of the size estimate, each from the movement resized by the one before: entries of
whole bodies do not grow in proportion, because turning has no size."""

LARGEST = 2.5
"""Bound of the logarithm of a size, a factor of twelve: further out is no movement."""

USUAL_SPREADS = 2.0
"""Sizes are kept up to about so many standard deviations of the training sizes."""

DIAGONAL = 0.5
"""Share of the diagonal in the covariance (shrinkage): there may be few more takes than entries."""

_POWERS = {"m": 1.0, "1/m": -1.0, "m^(1/2)": 0.5}
_GROWS = np.array(
    [_POWERS.get(feature.unit.split("/s")[0], 0.0) for feature in FEATURES], dtype=np.float64
)
_FLOOR = np.array([FLOORS[feature.unit] for feature in FEATURES])
_AT = {name: i for i, name in enumerate(DESCRIPTION_NAMES)}
_SIGNAL = {signal.name: i for i, signal in enumerate(SIGNALS)}
_RATES = ("speed", "acceleration", "jerk")
_LINEAR = [_SIGNAL[f"euclidean_{rate}"] for rate in _RATES]
_ANGULAR = [[_SIGNAL[f"angular_{a}_{rate}"] for a in ("left", "up", "front")] for rate in _RATES]
_SPEEDS = [_AT["log_peak_speed"], _AT["log_rms_speed"]]
_ACCELERATIONS = [_AT["log_rms_acceleration"], _AT["log_peak_acceleration"]]
_LENGTHS = [_AT["log_path"], _AT["log_extent"]]
_TINY = 1e-12


def resized(description: FloatArray, log_factor: FloatArray | float) -> FloatArray:
    """Return the description of a movement whose path is scaled and whose rotation is the same.

    Parameters
    ----------
    description
        ``(…, 132)``.
    log_factor
        ``(…)``, logarithm of the scale factor.

    Decisions by thresholds in metres (which chords have a direction, where curvature is defined)
    are assumed to stay, and so are the shares of translation and rotation in a body's acceleration.
    """
    log_factor = np.asarray(log_factor)
    square = np.exp(2.0 * log_factor)[..., None]
    new = description.copy()
    grows = np.exp(log_factor[..., None] * _GROWS)
    new[..., : len(FEATURES)] *= grows
    logs = slice(len(FEATURES), 2 * len(FEATURES))
    above = np.maximum(np.exp(description[..., logs]) - _FLOOR, 0.0)
    new[..., logs] = np.log(grows * above + _FLOOR)
    new[..., _LENGTHS] += log_factor[..., None]
    new[..., _AT["log_turning_per_length"]] -= log_factor
    speed = _AT["log_euclidean_speed_mean"]
    new[..., _AT["log_rotation_over_speed"]] -= new[..., speed] - description[..., speed]

    pairs = description[..., : len(FEATURES)] ** 2
    mean_square = pairs[..., 0::2] + pairs[..., 1::2]
    linear = mean_square[..., _LINEAR]
    angular = BODY_RADIUS_M**2 * mean_square[..., _ANGULAR].sum(axis=-1)
    share = linear / (linear + angular + _TINY)
    growth = square * share + 1.0 - share  # of mean squares: of speed, acceleration, jerk
    grown = 0.5 * np.log(growth)
    new[..., _SPEEDS] += grown[..., :1]
    rest = REST_M_S2**2
    above = np.maximum(np.exp(2.0 * description[..., _ACCELERATIONS]) - rest, 0.0)
    new[..., _ACCELERATIONS] = 0.5 * np.log(growth[..., 1:2] * above + rest)
    rms = _AT["log_rms_acceleration"]
    of_speed, of_jerk = grown[..., 0], grown[..., 2]
    of_acceleration = new[..., rms] - description[..., rms]

    over_extent = _AT["log_acceleration_over_extent"]
    extent = np.exp(2.0 * (description[..., rms] - description[..., over_extent]))
    share = np.minimum(np.exp(2.0 * description[..., _AT["log_extent"]]) / extent, 1.0)
    of_extent = 0.5 * np.log(square[..., 0] * share + 1.0 - share)
    new[..., over_extent] += of_acceleration - of_extent
    new[..., _AT["log_speed_over_extent"]] += of_speed - of_extent
    new[..., _AT["log_acceleration_over_speed"]] += of_acceleration - of_speed
    new[..., _AT["log_jerk_over_acceleration"]] += of_jerk - of_acceleration
    new[..., _AT["log_dimensionless_jerk"]] += 2.0 * (of_jerk - of_speed)
    new[..., _AT["log_acceleration_variation"]] += (
        new[..., _AT["log_peak_acceleration"]]
        - description[..., _AT["log_peak_acceleration"]]
        - of_acceleration
    )
    return new


@dataclass(frozen=True, slots=True, eq=False)
class Sizes:
    """The sizes of the training movements.

    Attributes
    ----------
    columns : (m,) indices of the entries that show the size.
    centre : (m,) values of these for a movement of the usual size.
    weight : (m,) weights of the differences from the centre in the logarithm of a size.
    spread : standard deviation of these logarithms, positive.
    """

    columns: NDArray[np.int64]
    centre: FloatArray
    weight: FloatArray
    spread: float

    def of(self, description: FloatArray) -> FloatArray:
        """Return the logarithm of the size over the usual one: ``(…, 132)`` to ``(…)``."""
        return finished(self.in_steps(description))

    def in_steps(self, description: FloatArray) -> Steps[FloatArray]:
        """Do what `of` does, in steps."""
        size = np.zeros(description.shape[:-1])
        seen = description
        for i in range(ROUNDS):
            size = size + (seen[..., self.columns] - self.centre) @ self.weight
            size = np.minimum(np.maximum(size, -LARGEST), LARGEST)
            if i + 1 < ROUNDS:
                seen = resized(description, -size)
                yield
        return np.asarray(size)

    def beyond(self, size: FloatArray) -> FloatArray:
        """Return the part of the logarithm of a size that is beyond the usual, to be removed."""
        return np.asarray(size - size / (1.0 + (size / (USUAL_SPREADS * self.spread)) ** 4))


def sizes_of(descriptions: FloatArray, columns: NDArray[np.int64]) -> Sizes:
    """Estimate the distribution of sizes from descriptions ``(n, 132)``."""
    seen = descriptions[:, columns]
    centre, scale = seen.mean(axis=0), seen.std(axis=0) + 1e-9
    standard = (seen - centre) / scale
    covariance = (1.0 - DIAGONAL) * (standard.T @ standard) / len(seen)
    covariance += DIAGONAL * np.eye(len(columns))
    larger = _LARGER[columns] / scale
    towards = np.linalg.solve(covariance, larger)
    weight = towards / (larger @ towards) / scale
    spread = float(Sizes(columns, centre, weight, 1.0).of(descriptions).std())
    return Sizes(columns, centre, weight, max(spread, 1e-3))


def _larger() -> FloatArray:
    """Return each entry's derivative by the logarithm of the size, for pure translation."""
    grows = dict(zip(DESCRIPTION_NAMES, [0.0] * len(FEATURES) + _GROWS.tolist(), strict=False))
    of_size = ("path", "extent", "peak_speed", "rms_speed", "peak_acceleration", "rms_acceleration")
    grows |= {f"log_{name}": 1.0 for name in of_size}
    grows |= {"log_turning_per_length": -1.0, "log_rotation_over_speed": -1.0}
    return np.array([grows.get(name, 0.0) for name in DESCRIPTION_NAMES])


_LARGER = _larger()
