"""Description: the feature vector of one movement that Effort is read from.

It holds the 50 features of the paper as they are, their logarithms, and the qualities. With few
takes a classifier can use only few entries; `FAMILIES` are the sets that classifiers are given.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from laban.features import FEATURES, MIN_SAMPLES, Feature, features_in_steps
from laban.motion import FloatArray, RigidMotion
from laban.qualities import QUALITIES, qualities_in_steps
from laban.steps import Steps, finished
from laban.stillness import without_still_ends

FLOORS: Mapping[str, float] = MappingProxyType(
    {
        "m/s": 0.01,
        "m/s^2": 0.2,
        "m/s^3": 8.0,
        "rad/s": 0.1,
        "rad/s^2": 1.5,
        "rad/s^3": 64.0,
        "1/m": 0.2,
        "m^(1/2)/s": 0.02,
        "m^(1/2)/s^2": 0.2,
    }
)
"""Added before the logarithm, by unit: about the value of a component at rest, for a tracker whose
noise is 1 mm and 0.5 degrees a sample (tests/smd/test_effort.py). Smaller values are noise."""

LOGARITHMS: tuple[Feature, ...] = tuple(
    Feature(f"log_{f.name}", f"log {f.unit}", f"log ({f.formula} + {FLOORS[f.unit]:g})")
    for f in FEATURES
)

DESCRIPTION: tuple[Feature, ...] = (*FEATURES, *LOGARITHMS, *QUALITIES)
"""The 132 entries of a description, in order."""

DESCRIPTION_NAMES: tuple[str, ...] = tuple(feature.name for feature in DESCRIPTION)

_NOISE_DECIDES = (
    "jerk",
    "torsion",
    "equi_affine",
    "curvature",
    "submovement",
    *(f"angular_{axis}_acceleration" for axis in ("left", "up", "front")),
)

FAMILIES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "vigour": (
            "log_rms_speed",
            "log_peak_speed",
            "log_rms_acceleration",
            "log_peak_acceleration",
            "log_duration",
            "log_speed_over_extent",
            "log_acceleration_over_extent",
        ),
        "geometry": (
            "log_roundness",
            "log_flatness",
            "log_path_over_reach",
            "log_straightness",
            "log_turning",
            "log_rotation",
        ),
        "turning": (
            "log_flatness",
            "log_turning_rate",
            "log_rotation_rate",
            "log_curvature_mean",
            "log_curvature_sd",
        ),
        "smoothness": (
            "spectral_arc_length",
            "log_dimensionless_jerk",
            "log_submovements",
            "log_submovement_rate",
            "time_to_peak",
            "slow_share",
            "log_jerk_over_acceleration",
            "log_acceleration_over_speed",
            "log_speed_range",
            "log_speed_variation",
        ),
        "everything": tuple(
            f.name
            for f in (*LOGARITHMS, *QUALITIES)
            if not any(w in f.name for w in _NOISE_DECIDES)
        ),
    }
)
"""Entries that belong together: few takes suffice for few weights only. *Everything* is all but
the entries that a tracker's noise dominates."""

MULTIPLIED: tuple[str, ...] = (
    *(
        name
        for name in FAMILIES["everything"]
        if any(name in names for family, names in FAMILIES.items() if family != "everything")
    ),
    "log_peak_over_mean_speed",
    "log_acceleration_variation",
    "log_arrival",
)
"""Entries whose pairwise products are used if there are enough takes: which speed is sudden depends
on how far the movement goes."""

_FLOOR = np.array([FLOORS[feature.unit] for feature in FEATURES])


def describe(motion: RigidMotion) -> FloatArray:
    """Return the description of one span of movement, without its still ends.

    Parameters
    ----------
    motion
        At least `laban.features.MIN_SAMPLES` samples. If fewer of them move, all are used.

    Returns
    -------
    (132,) finite, in the order of `DESCRIPTION`.

    Raises
    ------
    LabanError
        If there are fewer samples.
    """
    return finished(described_in_steps(motion))


def described_in_steps(motion: RigidMotion) -> Steps[FloatArray]:
    """Do what `describe` does, in steps."""
    moving = without_still_ends(motion)
    if len(moving) < MIN_SAMPLES:
        moving = motion
    yield
    features = yield from features_in_steps(moving)
    yield
    qualities = yield from qualities_in_steps(moving)
    return np.concatenate([features, np.log(features + _FLOOR), qualities])
