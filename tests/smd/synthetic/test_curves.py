from __future__ import annotations

import numpy as np
import pytest

from smd.geometry.rotations import heading_rad, rotate
from smd.smoothing import smooth
from smd.synthetic.curves import circle, helix, spin, straight_line

INSIDE = slice(10, -10)  # away from the ends, where a fit has one side only


def test_a_straight_line_has_its_length_and_one_velocity():
    line = straight_line(length_m=1.5, duration_s=2.0, direction=(1.0, 2.0, -2.0))
    assert line.position_m[-1] == pytest.approx([0.5, 1.0, -1.0])
    velocity = np.diff(line.position_m, axis=0) / np.diff(line.time_s)[:, None]
    assert velocity == pytest.approx(np.tile([0.25, 0.5, -0.5], (len(velocity), 1)))


def test_a_circle_closes_and_faces_its_way():
    doodle = circle(radius_m=0.3, duration_s=4.0)
    assert doodle.position_m[0] == pytest.approx(doodle.position_m[-1], abs=1e-12)
    centre = doodle.position_m[:360].mean(axis=0)
    assert np.linalg.norm(doodle.position_m - centre, axis=1) == pytest.approx(0.3, rel=1e-3)
    m = smooth(doodle)
    way = m.velocity_m_s[INSIDE] / np.linalg.norm(m.velocity_m_s[INSIDE], axis=1, keepdims=True)
    front = rotate(m.orientation_xyzw[INSIDE], np.tile([0.0, 0.0, 1.0], (len(way), 1)))
    assert front == pytest.approx(way, abs=1e-4)


def test_a_circle_goes_to_the_left():
    m = smooth(circle(radius_m=0.3, duration_s=4.0))
    expected = np.tile([0.0, np.pi / 2.0, 0.0], (len(m), 1))
    assert m.angular_velocity_rad_s == pytest.approx(expected, abs=1e-6)


def test_a_helix_has_constant_curvature_and_torsion():
    radius_m, rise_m = 0.3, 0.4
    m = smooth(helix(radius_m=radius_m, rise_m=rise_m, duration_s=4.0))
    v, a, j = (x[INSIDE] for x in (m.velocity_m_s, m.acceleration_m_s2, m.jerk_m_s3))
    binormal = np.cross(v, a)
    curvature = np.linalg.norm(binormal, axis=1) / np.linalg.norm(v, axis=1) ** 3
    torsion = np.sum(binormal * j, axis=1) / np.sum(binormal**2, axis=1)
    h = rise_m / (2.0 * np.pi)
    assert curvature == pytest.approx(radius_m / (radius_m**2 + h**2), rel=0.01)
    assert torsion == pytest.approx(h / (radius_m**2 + h**2), rel=0.02)


def test_a_spin_stays_in_place_and_turns_by_its_angle():
    doodle = spin(angle_rad=1.0, duration_s=1.0)
    assert not doodle.position_m.any()
    assert heading_rad(doodle.orientation_xyzw[-1]) == pytest.approx(1.0)


@pytest.mark.parametrize("rate_hz", [30.0, 90.0, 100.0])
def test_a_last_partial_period_is_dropped_and_no_whole_one(rate_hz):
    doodle = straight_line(length_m=1.0, duration_s=0.29, rate_hz=rate_hz)
    assert len(doodle) == int(round(0.29 * rate_hz * 1000) // 1000) + 1
