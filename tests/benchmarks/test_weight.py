from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.mass import GRAVITY_M_S2, centre_of_mass
from actions_library.authoring.soles import soles_in_world
from actions_library.authoring.support import support_of
from benchmarks.weight import over_ground_m_s2, turning_rad_s, weigh
from smd.character.clip import Clip
from smd.geometry.rotations import quaternion_about

RATE_HZ = 60.0


def rigid(
    moved_m: np.ndarray, *, cyclic: bool = False, name: str = "rigid", **turned: np.ndarray
) -> Clip:
    """The body at rest, moved as a whole; joints named are turned."""
    skeleton, frames = humanoid_skeleton(), len(moved_m)
    rotation = np.tile(skeleton.rest_rotation_xyzw, (frames, 1, 1))
    translation = np.tile(skeleton.rest_translation_m, (frames, 1, 1))
    translation[:, skeleton.index("hips")] += moved_m
    for joint, xyzw in turned.items():
        rotation[:, skeleton.index(joint)] = xyzw
    ends = np.array([0, 0, frames - 1, frames - 1, frames - 1])
    none = np.zeros((frames, 0), dtype=bool)
    return Clip(name, skeleton, RATE_HZ, rotation, translation, ends, (), none, cyclic)


def test_swaying_has_the_acceleration_and_the_zero_moment_point_of_a_sine():
    time_s, sway_m = np.arange(241) / RATE_HZ, 0.2
    clip = rigid(
        np.outer(sway_m * np.sin(2.0 * np.pi * time_s), [1.0, 0.0, 0.0]),  # once a second
        cyclic=True,
    )
    weight = weigh(clip)
    greatest = sway_m * (2.0 * np.pi) ** 2
    read = np.sinc(2.0 / 24.0) ** 2  # what central differences at 24 Hz see of 1 Hz
    assert weight.acceleration_max_m_s2 == pytest.approx(greatest * read, rel=0.005)
    bind = clip.skeleton.world_from_bind[None, :, :3, 3]
    upright = np.tile(clip.skeleton.rest_rotation_xyzw, (1, 1, 1))
    left, height, ahead = centre_of_mass(clip.skeleton, bind)[0]
    point = np.array([[left + height * greatest * read / GRAVITY_M_S2, ahead]])
    soles = support_of(soles_in_world(clip.skeleton, upright, bind))
    expected = np.linalg.norm(point - soles.nearest_m(point))  # the soles sway along
    assert weight.outside_p95_m == pytest.approx(expected, abs=0.002)
    assert weight.outside_share == pytest.approx(0.75, abs=0.1)


def test_a_capture_is_read_as_a_clip():
    time_s = np.arange(361) / 90.0  # at another rate
    centre = np.column_stack([0.2 * np.sin(2.0 * np.pi * time_s), time_s, time_s])
    read = np.sinc(2.0 / 24.0) ** 2
    greatest = over_ground_m_s2(centre, 90.0).max()
    assert greatest == pytest.approx(0.2 * (2.0 * np.pi) ** 2 * read, rel=0.01)


@pytest.mark.parametrize("gravity", [0.5, 1.0, 1.4])
def test_a_flight_is_measured_by_its_fall_its_crouch_and_its_landing(gravity):
    push_s, land_s, deep_m = 0.25, 0.30, 0.20
    off_m_s = 2.0 * deep_m / push_s
    flight_s = 2.0 * off_m_s / (gravity * GRAVITY_M_S2)

    def way(since_s: float, last_s: float) -> float:
        """From standing, down and up: pushed off, stopped again, at even accelerations."""
        return 0.5 * off_m_s * since_s**2 / last_s

    up = []
    for t in np.arange(0.0, 2.5, 1.0 / RATE_HZ):
        if t < 0.5:
            up.append(-deep_m * min(1.0, t / 0.5))
        elif t < 0.5 + push_s:
            up.append(-deep_m + way(t - 0.5, push_s))
        elif t < 0.5 + push_s + flight_s:
            air = t - 0.5 - push_s
            up.append(off_m_s * air - 0.5 * gravity * GRAVITY_M_S2 * air**2)
        else:
            left = max(0.0, land_s - (t - 0.5 - push_s - flight_s))
            up.append(way(left, land_s) - 0.5 * off_m_s * land_s)
    weight = weigh(rigid(np.outer(up, [0.0, 1.0, 0.0])))
    (flight,) = weight.flights
    assert flight.gravity == pytest.approx(gravity, rel=0.02)
    assert flight.crouch_m == pytest.approx(deep_m, abs=0.03)
    assert flight.landing_s == pytest.approx(land_s, abs=2.0 / RATE_HZ)


def test_who_stands_asks_for_nothing():
    weight = weigh(rigid(np.zeros((60, 3))))
    assert weight.acceleration_max_m_s2 == pytest.approx(0.0, abs=1e-9)
    assert weight.outside_p95_m == pytest.approx(0.0, abs=1e-9)
    assert weight.flights == ()


def test_a_trunk_turns_in_the_world_and_a_limb_from_what_carries_it():
    time_s = np.arange(30) / RATE_HZ
    turned = quaternion_about([0.0, 1.0, 0.0], 2.0 * time_s)
    bent = quaternion_about([1.0, 0.0, 0.0], 3.0 * time_s)
    clip = rigid(np.zeros((30, 3)), hips=turned, right_upper_arm=bent)
    np.testing.assert_allclose(turning_rad_s(clip, "hips"), 2.0, rtol=1e-6)
    np.testing.assert_allclose(turning_rad_s(clip, "upper_chest"), 2.0, rtol=1e-6)
    skeleton = clip.skeleton
    bone = skeleton.rest_translation_m[skeleton.index("right_lower_arm")]
    across = np.hypot(bone[1], bone[2]) / np.linalg.norm(bone)  # what turns about x
    speed = turning_rad_s(clip, "right_upper_arm")
    np.testing.assert_allclose(speed, 3.0 * across, rtol=1e-3)
    np.testing.assert_allclose(turning_rad_s(clip, "right_lower_arm"), 0.0, atol=1e-6)
