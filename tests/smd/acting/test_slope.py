from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from smd.acting.footing import CLEARANCE_M
from smd.acting.legs import feet_of, legs_of, world_of
from smd.acting.slope import MOST_TILT_RAD
from smd.acting.terrain import Terrain
from smd.doodle import Doodle, Recording
from smd.errors import TransferError
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.pipeline import animate
from smd.score import Part, Phrase, Score

RATE_HZ = 60.0
UP = np.array([0.0, 1.0, 0.0])
Relief = Callable[[np.ndarray, np.ndarray], np.ndarray]


def terrain(height: Relief, step_m: float = 0.1, turn_rad: float = 0.0) -> Terrain:
    """A net of squares over -2 to 7 m, as high as a function of x and z."""
    axis = np.arange(-2.0, 7.0 + 0.5 * step_m, step_m)
    x, z = np.meshgrid(axis, axis, indexing="ij")
    points = np.stack([x, height(x, z) + 0.0 * x, z], axis=-1).reshape(-1, 3)
    index = np.arange(len(points)).reshape(x.shape)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    triangles = np.concatenate([np.stack([a, c, b], axis=-1), np.stack([a, d, c], axis=-1)])
    turn = np.broadcast_to(quaternion_about(UP, turn_rad), (len(points), 4))
    return Terrain(rotate(turn, points), triangles.reshape(-1, 3))


def stairs(x, z):
    """Treads of 60 cm, 15 cm high."""
    tread = np.floor(z / 0.6)
    return 0.15 * (tread + np.clip((z / 0.6 - tread) * 12.0, 0.0, 1.0) - 1.0)


def bumps(x, z):
    return 0.08 * np.sin(3.0 * x + 1.0) * np.sin(3.0 * z) + 0.02 * np.sin(9.0 * z + x)


def take(library, action="walk", speed_m_s=1.0, turn_rad=0.0) -> tuple[Recording, Score]:
    """A prop that is led ahead for 4 s."""
    scale = library.character.height_m / 0.175
    time_s = np.arange(6 * 90 + 1) / 90.0
    way = np.clip(time_s - 1.0, 0.0, 4.0) * speed_m_s / scale
    turn = np.broadcast_to(quaternion_about(UP, turn_rad), (len(way), 4))
    place = rotate(turn, np.stack([0.0 * way, 0.8 + 0.0 * way, way], axis=-1))
    level = multiply(turn, np.tile([0.0, 0.0, 0.0, 1.0], (len(way), 1)))
    score = Score((Part("fox", (Phrase(action, 1.0, 5.0),)),))
    return Recording((Doodle(time_s, place, level, "fox"),)), score


def acted(library, ground, **how):
    recording, score = take(library, **how)
    return animate(score, recording, library, rate_hz=RATE_HZ, ground=ground)


def soles(performance, library):
    """Each leg with its heel and ball ``(n, 3)`` in the world, the ball's at the sole."""
    (actor,) = performance.actors
    skeleton = library.character.skeleton
    for leg in legs_of(skeleton, feet_of(library.clip("walk"))):
        local = actor.poses
        q, ankle = world_of(skeleton, leg.foot, *local)
        yield leg, q, ankle + rotate(q, leg.heel_m), ankle + rotate(q, leg.ball_m)


def clearance_m(performance, library, ground):
    """How high each foot's heel and ball are over the ground ``(legs, 2, n)``."""
    return np.array(
        [
            [
                heel[:, 1] - ground.height_at(heel[:, [0, 2]]),
                ball[:, 1] - ground.height_at(ball[:, [0, 2]]) - leg.ball_height_m,
            ]
            for leg, _, heel, ball in soles(performance, library)
        ]
    )


def test_level_ground_is_no_terrain(library):
    flat = acted(library, None).actors[0]
    on = acted(library, terrain(lambda x, z: 0.0)).actors[0]
    assert on.poses.rotation_xyzw == pytest.approx(flat.poses.rotation_xyzw, abs=1e-6)
    assert on.poses.translation_m == pytest.approx(flat.poses.translation_m, abs=1e-6)


def test_on_a_plateau_everything_is_as_much_higher(library):
    flat = acted(library, None).actors[0]
    on = acted(library, terrain(lambda x, z: 3.0)).actors[0]
    assert on.poses.rotation_xyzw == pytest.approx(flat.poses.rotation_xyzw, abs=1e-6)
    assert on.poses.translation_m[:, 0] == pytest.approx(
        flat.poses.translation_m[:, 0] + 3.0 * UP, abs=1e-6
    )


@pytest.mark.parametrize("percent", [-35, -18, 18, 35])
def test_on_a_slope_feet_are_on_the_plane_and_as_steep(library, percent):
    ground = terrain(lambda x, z: 0.01 * percent * z)
    performance = acted(library, ground)
    over = clearance_m(performance, library, ground)
    assert over.min() > -5e-4
    lowest = over.min(axis=(0, 1))
    assert lowest.mean() < 2e-3
    assert lowest.max() < CLEARANCE_M
    # While they wait, both soles lie in the plane.
    waits = slice(0, 50)
    normal = np.array([0.0, 1.0, -0.01 * percent]) / np.hypot(1.0, 0.01 * percent)
    for _, _, heel, ball in soles(performance, library):
        along = (ball - heel)[waits]
        level = along - np.outer(along @ normal, normal)
        assert level[:, 1] / level[:, 2] == pytest.approx(0.01 * percent, abs=1e-9)
    assert np.ptp(over[:, :, waits].max(axis=(0, 1))) < 2e-3


def test_a_slope_steeper_than_an_ankle_bends_is_stood_on_by_the_edge(library):
    ground = terrain(lambda x, z: 0.7 * x)
    performance = acted(library, ground)
    assert clearance_m(performance, library, ground).min() > -5e-3
    waits = slice(0, 50)
    for _, _, heel, ball in soles(performance, library):
        assert np.isfinite(heel).all()
        assert np.ptp((ball - heel)[waits, 1]) < 1e-3
    assert np.arctan(0.7) > MOST_TILT_RAD


@pytest.mark.parametrize(("relief", "step_m"), [(stairs, 0.05), (bumps, 0.05)])
@pytest.mark.parametrize(("action", "speed"), [("walk", 1.0), ("walk", -1.0), ("jump", 0.3)])
def test_over_steps_and_bumps_no_sole_is_in_the_ground(library, relief, step_m, action, speed):
    ground = terrain(relief if speed > 0 else lambda x, z: relief(x, -z), step_m)
    performance = acted(library, ground, action=action, speed_m_s=abs(speed))
    assert clearance_m(performance, library, ground).min() > -5e-3
    (actor,) = performance.actors
    body = actor.poses.translation_m[:, 0, 1] + actor.poses.translation_m[:, 1, 1]
    assert np.abs(np.diff(body, 2)).max() * RATE_HZ**2 < 25.0
    for _, _, heel, _ in soles(performance, library):
        assert np.abs(np.diff(heel[:, 1])).max() * RATE_HZ < 8.0


def test_turning_ground_and_prop_turns_the_performance(library):
    straight = acted(library, terrain(bumps)).actors[0]
    turned = acted(library, terrain(bumps, turn_rad=0.7), turn_rad=0.7).actors[0]
    turn = np.broadcast_to(quaternion_about(UP, 0.7), (len(straight.poses.translation_m), 4))
    assert turned.poses.translation_m[:, 0] == pytest.approx(
        rotate(turn, straight.poses.translation_m[:, 0]), abs=1e-6
    )
    assert np.abs(turned.poses.rotation_xyzw[:, 1:]) == pytest.approx(
        np.abs(straight.poses.rotation_xyzw[:, 1:]), abs=1e-5
    )


def test_a_way_beside_the_ground_or_under_a_bridge_is_refused_with_its_place(library):
    ground = terrain(lambda x, z: 0.0)
    beside = r"^ground: expected ground below 'fox' at 4\.\d\d s \(x .*, z 7\.0.*\), found none$"
    with pytest.raises(TransferError, match=beside):
        acted(library, ground, speed_m_s=2.0)
    roof = np.array([[-1.0, 2.0, 2.0], [-1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [1.0, 2.0, 2.0]])
    n = len(ground.points_m)
    covered = Terrain(
        np.concatenate([ground.points_m, roof]),
        np.concatenate([ground.triangles, np.array([[0, 1, 2], [0, 2, 3]]) + n]),
    )
    with pytest.raises(TransferError, match=r"expected one surface below 'fox' at 3.* found sever"):
        acted(library, covered)


def test_a_performance_keeps_its_terrain_for_who_shows_it(library):
    from exporters.usd import performance_stage

    ground = terrain(bumps, 0.5)
    performance = acted(library, ground)
    assert performance.terrain is ground
    stage = performance_stage(performance)  # a prim does not keep its stage
    mesh = stage.GetPrimAtPath("/Performance/Scenery/Ground")
    shown = np.array(mesh.GetAttribute("points").Get())
    assert shown == pytest.approx(ground.points_m, abs=1e-6)
