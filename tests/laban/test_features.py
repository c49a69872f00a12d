from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from laban import FEATURES, LabanError, RigidMotion, effort_features
from laban.features import FEATURE_NAMES, SIGNALS, feature_table
from laban.qualities import quality_table
from smd.geometry.rotations import multiply, quaternion_about, quaternion_from_rotvec, rotate

RADIUS_M, RISE_M = 0.2, 0.05  # a helix: (r cos, c angle, r sin)


def named(motion: RigidMotion) -> dict[str, float]:
    return dict(zip(FEATURE_NAMES, effort_features(motion), strict=True))


@pytest.fixture(scope="module")
def helix(motion_of, columns):
    """A helix whose angle is ``rate * t + growth * t^2 / 2``."""

    def make(*, rise_m, rate=3.0, growth=0.0, rate_hz=60.0):
        def path(t):
            angle, speed = rate * t + 0.5 * growth * t**2, rate + growth * t
            c, s = np.cos(angle), np.sin(angle)
            r = RADIUS_M
            position = columns(r * c, rise_m * angle, r * s)
            # by the chain rule, angle' = speed, angle'' = growth, angle''' = 0
            d1, d2, d3 = (
                columns(-r * s, rise_m, r * c),
                columns(-r * c, 0, -r * s),
                columns(r * s, 0, -r * c),
            )
            w = speed[:, None]
            velocity = d1 * w
            acceleration = d2 * w**2 + d1 * growth
            jerk = d3 * w**3 + 3 * d2 * w * growth
            return position, velocity, acceleration, jerk

        return motion_of(path, rate_hz=rate_hz)

    return make


def test_there_are_fifty_features_with_names_of_their_own():
    assert len(SIGNALS) == 25
    assert len(FEATURES) == len(set(FEATURE_NAMES)) == 50


def test_a_circle_has_the_curvature_of_its_radius_and_no_torsion(helix):
    found = named(helix(rise_m=0.0))
    assert found["curvature_mean"] == pytest.approx(1 / RADIUS_M)
    assert found["curvature_sd"] == pytest.approx(0.0, abs=1e-9)
    assert found["torsion_mean"] == pytest.approx(0.0, abs=1e-9)
    assert found["equi_affine_speed_mean"] == pytest.approx(0.0, abs=1e-2)  # sixth root of 1e-16
    assert found["euclidean_speed_mean"] == pytest.approx(3.0 * RADIUS_M)
    assert found["euclidean_acceleration_mean"] == pytest.approx(9.0 * RADIUS_M)
    assert found["euclidean_jerk_mean"] == pytest.approx(27.0 * RADIUS_M)


def test_a_circle_has_its_curvature_however_it_is_timed(helix):
    found = named(helix(rise_m=0.0, rate=0.0, growth=4.0))  # from rest
    assert found["curvature_mean"] == pytest.approx(1 / RADIUS_M)
    assert found["curvature_sd"] == pytest.approx(0.0, abs=1e-9)


def test_a_helix_has_its_curvature_torsion_and_equi_affine_speed(helix):
    found = named(helix(rise_m=RISE_M))
    square = RADIUS_M**2 + RISE_M**2
    assert found["curvature_mean"] == pytest.approx(RADIUS_M / square)
    assert found["torsion_mean"] == pytest.approx(RISE_M / square)
    assert found["equi_affine_speed_mean"] == pytest.approx(3.0 * (RADIUS_M**2 * RISE_M) ** (1 / 6))
    for name in ("curvature", "torsion", "equi_affine_speed", "euclidean_speed"):
        assert found[f"{name}_sd"] == pytest.approx(0.0, abs=1e-6)
    assert found["equi_affine_acceleration_mean"] == pytest.approx(0.0, abs=1e-6)


def test_equi_affine_speed_is_speed_times_powers_of_curvature_and_torsion(helix):
    found = named(helix(rise_m=RISE_M))
    product = (
        found["euclidean_speed_mean"]
        * found["curvature_mean"] ** (1 / 3)
        * found["torsion_mean"] ** (1 / 6)
    )
    assert found["equi_affine_speed_mean"] == pytest.approx(product)


def test_a_helix_begun_ever_faster_has_a_constant_equi_affine_acceleration(helix):
    found = named(helix(rise_m=RISE_M, rate=1.0, growth=2.0))
    expected = 2.0 * (RADIUS_M**2 * RISE_M) ** (1 / 6)
    assert found["equi_affine_acceleration_mean"] == pytest.approx(expected)
    assert found["equi_affine_acceleration_sd"] == pytest.approx(0.0, abs=1e-6)


def test_a_uniformly_accelerated_line_is_as_in_the_textbook(motion_of, columns):
    a, n = 0.8, 121
    motion = motion_of(
        lambda t: (
            columns(0, 0, 0.5 * a * t**2),
            columns(0, 0, a * t),
            columns(0, 0, a + 0 * t),
            columns(0, 0, 0 * t),
        )
    )
    found = named(motion)
    assert found["local_front_speed_mean"] == pytest.approx(a * 1.0)  # half of 2 s
    # n even steps from 0 to v have the standard deviation v sqrt((n + 1) / (12 (n - 1)))
    assert found["local_front_speed_sd"] == pytest.approx(2 * a * np.sqrt((n + 1) / (12 * (n - 1))))
    assert found["local_front_acceleration_mean"] == pytest.approx(a)
    assert found["local_up_speed_mean"] == found["local_left_speed_mean"] == 0.0
    for name in ("euclidean_jerk", "curvature", "torsion", "equi_affine_speed"):
        assert found[f"{name}_mean"] == found[f"{name}_sd"] == 0.0


def test_a_turn_about_a_fixed_axis_has_rates_about_that_axis_alone(motion_of, columns):
    def turning(t):
        q = quaternion_about([0.0, 1.0, 0.0], t**3 / 3)
        return q, columns(0, t**2, 0), columns(0, 2 * t, 0), columns(0, 2 + 0 * t, 0)

    still = motion_of(lambda t: [columns(0 * t, 1, 0) * k for k in (1, 0, 0, 0)], turning)
    found = named(still)
    t = still.time_s
    assert found["angular_up_speed_mean"] == pytest.approx(np.mean(t**2))
    assert found["angular_up_acceleration_mean"] == pytest.approx(np.mean(2 * t))
    assert found["angular_up_jerk_mean"] == pytest.approx(2.0)
    others = [name for name in FEATURE_NAMES if not name.startswith("angular_up")]
    assert all(found[name] == 0.0 for name in others)


def test_local_axes_are_those_of_the_body(motion_of, columns):
    # +Z of the body points to the world's +X: what goes to +X goes to the front
    facing = quaternion_about([0.0, 1.0, 0.0], 0.5 * np.pi)

    def turning(t):
        still = columns(0 * t, 0, 0)
        return np.tile(facing, (len(t), 1)), still, still, still

    found = named(
        motion_of(
            lambda t: (columns(t, 0, 0), columns(1 + 0 * t, 0, 0), *[columns(0 * t, 0, 0)] * 2),
            turning,
        )
    )
    assert found["local_front_speed_mean"] == pytest.approx(1.0)
    assert found["local_left_speed_mean"] == pytest.approx(0.0, abs=1e-12)


def test_there_and_back_counts_as_speed_and_not_as_nothing(motion_of, columns):
    found = named(
        motion_of(
            lambda t: [
                columns(0, np.sin(np.pi * t + k * np.pi / 2) * np.pi**k, 0) for k in range(4)
            ]
        )
    )
    assert found["local_up_speed_mean"] == pytest.approx(2.0, rel=0.01)  # pi * mean |cos|


@pytest.mark.parametrize("seed", range(5))
def test_features_do_not_depend_on_where_the_body_is_or_which_way_the_world_faces(
    seed, random_motion
):
    rng = np.random.default_rng(seed)
    motion = random_motion(rng)
    turn = quaternion_from_rotvec(rng.normal(size=3))
    turned = {
        name: rotate(turn, getattr(motion, name))
        for name in ("position_m", "velocity_m_s", "acceleration_m_s2", "jerk_m_s3")
    }
    turned["position_m"] = turned["position_m"] + rng.normal(size=3)
    turned["orientation_xyzw"] = multiply(turn, motion.orientation_xyzw)
    np.testing.assert_allclose(
        effort_features(replace(motion, **turned)), effort_features(motion), rtol=1e-6
    )


def test_a_movement_and_its_mirror_image_have_the_same_features(random_motion):
    motion = random_motion(np.random.default_rng(1))
    across = np.array([-1.0, 1.0, 1.0])  # left and right change places
    mirrored = {field.name: getattr(motion, field.name) * across for field in fields(motion)[3:]}
    mirrored = {name: -value if "angular" in name else value for name, value in mirrored.items()}
    mirrored["position_m"] = motion.position_m * across
    mirrored["orientation_xyzw"] = motion.orientation_xyzw * [1.0, -1.0, -1.0, 1.0]
    np.testing.assert_allclose(
        effort_features(replace(motion, **mirrored)), effort_features(motion), rtol=1e-9
    )


@pytest.mark.parametrize("seed", range(5))
def test_features_hardly_depend_on_the_sampling_rate(seed, random_motion):
    slow = effort_features(random_motion(np.random.default_rng(seed), rate_hz=60.0))
    fast = effort_features(random_motion(np.random.default_rng(seed), rate_hz=120.0))
    # Spikes of curvature and torsion, and dips of the sixth root, are as narrow as a sample.
    narrow = {"curvature": 0.5, "torsion": 0.5, "equi_affine_acceleration": 0.2}
    tolerance = np.array([narrow.get(name.rsplit("_", 1)[0], 0.05) for name in FEATURE_NAMES])
    assert (np.abs(slow - fast) <= tolerance * fast).all()


def test_a_body_at_rest_has_features_of_zero(motion_of, columns):
    motion = motion_of(lambda t: [columns(0 * t, 0, 0)] * 4)
    assert (effort_features(motion) == 0.0).all()


@pytest.mark.parametrize("n", [0, 1, 3])
def test_too_few_samples_are_said_so(n, random_motion):
    motion = random_motion(np.random.default_rng(0))
    few = RigidMotion(*(getattr(motion, field.name)[:n] for field in fields(motion)))
    with pytest.raises(LabanError, match=f"at least 4 samples, got {n}"):
        effort_features(few)


def test_the_shortest_movement_has_finite_features(random_motion):
    motion = random_motion(np.random.default_rng(0)).between(0.5, 0.551)
    assert len(motion) == 4
    assert np.isfinite(effort_features(motion)).all()


@pytest.mark.parametrize("table", [feature_table, quality_table])
def test_the_tables_in_the_docs_are_those_of_the_code(table):
    page = Path(__file__).parents[2] / "docs" / "effort.md"
    assert table() in page.read_text(encoding="utf-8")
