"""Sizes: what is said of a movement that is larger, against movements that are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from laban import AXES, load_effort_model, read_effort
from laban.committee import ENTRY_NAMES
from laban.description import DESCRIPTION_NAMES, describe
from laban.own import measure_of
from laban.size import Sizes, resized, sizes_of

COLUMNS = np.array([DESCRIPTION_NAMES.index(name) for name in ENTRY_NAMES], dtype=np.int64)

AT_THRESHOLDS = ("curvature", "torsion", "turning", "equi_affine", "log_speed_range", "arrival")
"""What thresholds in metres, or the rest that is added to an acceleration, have a part in."""

OF_TURNING_BODIES = (
    *("log_path", "log_extent", "log_rms_speed", "log_roundness", "log_duration"),
    *("log_rotation", "log_rotation_over_speed"),
    *("euclidean_jerk_sd", "log_local_up_speed_mean", "log_euclidean_acceleration_mean"),
)
"""What is known exactly though the body turns as it goes; peaks are known by their shares."""


def larger(motion, factor):
    """Return a movement whose way is so many times as large."""
    return replace(
        motion,
        position_m=factor * motion.position_m,
        velocity_m_s=factor * motion.velocity_m_s,
        acceleration_m_s2=factor * motion.acceleration_m_s2,
        jerk_m_s3=factor * motion.jerk_m_s3,
    )


def without_turning(motion):
    still = np.zeros((len(motion), 3))
    return replace(
        motion,
        orientation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (len(motion), 1)),
        angular_velocity_rad_s=still,
        angular_acceleration_rad_s2=still,
        angular_jerk_rad_s3=still,
    )


@pytest.mark.parametrize("factor", [0.5, 2.0, 6.0])
@pytest.mark.parametrize("seed", range(5))
def test_a_description_made_larger_is_that_of_the_larger_movement(seed, factor, random_motion):
    turning = random_motion(np.random.default_rng(seed))
    for motion, names in (
        (turning, OF_TURNING_BODIES),
        (
            without_turning(turning),
            [n for n in DESCRIPTION_NAMES if not any(word in n for word in AT_THRESHOLDS)],
        ),
    ):
        ours = resized(describe(motion), np.log(factor))
        theirs = describe(larger(motion, factor))
        for name in names:
            column = DESCRIPTION_NAMES.index(name)
            assert ours[column] == pytest.approx(theirs[column], rel=0.02, abs=0.02), name


def test_made_larger_and_smaller_again_nothing_has_changed(random_motion):
    description = describe(random_motion(np.random.default_rng(0)))
    there_and_back = resized(resized(description, 1.2), -1.2)
    np.testing.assert_allclose(there_and_back, description, atol=1e-9)
    many = np.stack([description, description])
    np.testing.assert_allclose(resized(many, np.array([0.0, 1.2]))[0], description)
    np.testing.assert_allclose(resized(many, np.array([0.0, 1.2]))[1], resized(description, 1.2))


@pytest.fixture(scope="module")
def learned(random_motion) -> tuple[Sizes, np.ndarray]:
    """Sizes of 200 movements whose sizes vary a little, and their descriptions."""
    rng = np.random.default_rng(3)
    described = [
        describe(without_turning(larger(random_motion(rng), float(np.exp(rng.normal(0.0, 0.3))))))
        for _ in range(200)
    ]
    return sizes_of(np.array(described), COLUMNS), np.array(described)


@pytest.mark.parametrize("factor", [1 / 3, 2.0, 6.0])
def test_a_size_grows_with_the_movement(factor, learned, random_motion):
    sizes, _ = learned
    grown = []
    for seed in range(20):
        motion = without_turning(random_motion(np.random.default_rng(1000 + seed)))
        grown.append(sizes.of(describe(larger(motion, factor))) - sizes.of(describe(motion)))
    assert np.mean(grown) == pytest.approx(np.log(factor), abs=0.15)


def test_sizes_within_the_usual_are_kept_and_those_far_beyond_are_not(learned):
    sizes, described = learned
    assert abs(float(np.mean(sizes.of(described)))) < 0.1
    size = np.array([0.3, 1.0, 2.0, 4.0, 8.0]) * sizes.spread
    kept = size - sizes.beyond(size)
    np.testing.assert_allclose(kept[0], size[0], rtol=0.01)
    assert kept[4] < 0.05 * size[4]
    np.testing.assert_allclose(sizes.beyond(-size), -sizes.beyond(size))


def test_somebodys_takes_all_six_times_as_large_are_read_the_same(random_motion):
    """Against takes of their own, the size of a person's movements says nothing."""
    model = load_effort_model()
    rng = np.random.default_rng(5)
    motions = [
        without_turning(random_motion(rng, size_m=0.05, pace=rng.uniform(0.5, 2.0)))
        for _ in range(12)
    ]
    readings = []
    for factor in (1.0, 6.0):
        as_large = [larger(motion, factor) for motion in motions]
        own = measure_of(np.array([describe(motion) for motion in as_large]))
        each = [read_effort(motion, model, own) for motion in as_large]
        readings.append([[getattr(effort, axis) for axis in AXES] for effort in each])
    assert np.mean(np.abs(np.subtract(*readings))) < 0.1
    assert np.mean(np.sign(readings[0]) != np.sign(readings[1])) <= 0.05
