"""Over the ground: how high jumps go, how feet do on terrain, and what both cost.

Run with ``python -m benchmarks.ground``.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

from actions_library.folder import load_library
from actions_library.library import Library
from smd.acting.flight import GRAVITY_M_S2
from smd.acting.legs import feet_of, legs_of, world_of
from smd.acting.performance import Performance
from smd.acting.terrain import Terrain
from smd.doodle import Doodle, Recording
from smd.geometry.rotations import rotate
from smd.pipeline import animate
from smd.score import Part, Phrase, Score

RATE_HZ = 60.0
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
Relief = Callable[[np.ndarray, np.ndarray], np.ndarray]


def take(
    library: Library, action: str, lasting_s: float, *, way_m: float, rise_m: float = 0.0
) -> tuple[Recording, Score]:
    """A prop that goes ahead for a phrase, along a parabola; lengths are the stage's."""
    scale = library.character.height_m / 0.175
    time_s = np.arange(round((lasting_s + 2.0) * 90) + 1) / 90.0
    s = np.clip((time_s - 1.0) / lasting_s, 0.0, 1.0)
    place = np.stack([0.0 * s, 8.0 + 4.0 * rise_m * s * (1.0 - s), way_m * s], axis=-1) / scale
    doodle = Doodle(time_s, place, np.tile(LEVEL, (len(s), 1)), "prop")
    part = Part("prop", (Phrase(action, 1.0, 1.0 + lasting_s),))
    return Recording((doodle,)), Score((part,))


def terrain(relief: Relief, step_m: float) -> Terrain:
    """A net of squares over -2 to 8 m, as high as a function of x and z."""
    axis = np.arange(-2.0, 8.0 + 0.5 * step_m, step_m)
    x, z = np.meshgrid(axis, axis, indexing="ij")
    index = np.arange(x.size).reshape(x.shape)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    triangles = np.concatenate([np.stack([a, c, b], axis=-1), np.stack([a, d, c], axis=-1)])
    points = np.stack([x, relief(x, z) + 0.0 * x, z], axis=-1)
    return Terrain(points.reshape(-1, 3), triangles.reshape(-1, 3))


def stairs(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    tread = np.floor(z / 0.6)
    return 0.17 * (tread + np.clip((z / 0.6 - tread) * 30.0, 0.0, 1.0) - 1.0)


def bumps(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    return 0.1 * np.sin(3.0 * x) * np.sin(4.0 * z) + 0.05 * np.sin(9.0 * z + x)


def soles(
    performance: Performance, library: Library, ground: Terrain
) -> tuple[float, float, float]:
    """Return the lowest sole (mm), the mean of the lowest per frame (mm), and mean slide (m/s).

    Slide is that of the lower of heel and ball, over the ground, while within 5 mm of it.
    """
    (actor,) = performance.actors
    heights, slides = [], []
    for leg in legs_of(library.character.skeleton, feet_of(library.clip("walk"))):
        q, ankle = world_of(library.character.skeleton, leg.foot, *actor.poses)
        points = ankle + np.stack([rotate(q, leg.heel_m), rotate(q, leg.ball_m)])
        over = points[..., 1] - ground.height_at(points[..., [0, 2]])
        over[1] -= leg.ball_height_m
        heights.append(over)
        lower = over.argmin(axis=0)
        low = points[lower, np.arange(len(q))]
        stays = (over.min(axis=0) < 0.005)[1:] & (lower[1:] == lower[:-1])
        slides.append(np.linalg.norm(np.diff(low[:, [0, 2]], axis=0), axis=-1)[stays] * RATE_HZ)
    lowest = np.array(heights).min(axis=(0, 1))
    return 1e3 * lowest.min(), 1e3 * lowest.mean(), float(np.concatenate(slides).mean())


def flown(library: Library) -> None:
    """Print what becomes of jumps: apex, and what they fall with."""
    print("phrase, prop's rise: flight, apex of the body over its take-off, acceleration")
    hips = library.character.skeleton.index("hips")
    for action in ("jump", "leap"):
        for lasting_s in (0.5, 1.0, 1.5, 2.5):
            for rise_m in (0.0, 0.3, 1.0):
                recording, score = take(library, action, lasting_s, way_m=1.0, rise_m=rise_m)
                (actor,) = animate(score, recording, library, rate_hz=240.0).actors
                body = actor.poses.translation_m[:, hips, 1]
                bend = np.diff(body, 2) * 240.0**2
                top = int(body[1:-1].argmax())
                fall = -bend[top]
                steady = np.abs(bend + fall) < 0.1 * fall
                first = top - int(np.argmin(steady[top::-1]))
                last = top + int(np.argmin(steady[top:]))
                flight_s, apex_m = (last - first) / 240.0, body.max() - body[first]
                print(
                    f"{action:5} {lasting_s:.1f} s, {rise_m:.1f} m: {flight_s:.2f} s, "
                    f"{apex_m:.2f} m, {fall:5.1f} m/s² ({fall / GRAVITY_M_S2:.1f} g)"
                )


def plane(degrees: float, x_share: float, z_share: float) -> Relief:
    """Return a slope that rises along a direction."""
    steep = np.tan(np.radians(degrees))
    return lambda x, z: steep * (x_share * x + z_share * z)


def walked(library: Library) -> None:
    """Print how feet do on terrain."""
    print("lowest sole, mean of the lowest, slide of what bears")
    grounds: dict[str, tuple[Relief, float]] = {
        "level": (lambda x, z: 0.0 * x, 0.5),
        **{
            f"{degrees}° {name}": (plane(degrees, *of), 0.5)
            for degrees in (10, 20, 30)
            for name, of in (("up", (0, 1)), ("down", (0, -1)), ("across", (1, 0)))
        },
        "stairs up": (stairs, 0.02),
        "stairs down": (lambda x, z: stairs(x, -z), 0.02),
        "bumps": (bumps, 0.05),
    }
    for name, (relief, step_m) in grounds.items():
        ground = terrain(relief, step_m)
        for action, way_m in (
            (("walk", 5.0),)
            if name != "bumps"
            else (
                ("walk", 5.0),
                ("run", 6.0),
                ("side_step_left", 2.0),
                ("jump", 1.5),
            )
        ):
            recording, score = take(library, action, 4.0, way_m=way_m)
            performance = animate(score, recording, library, rate_hz=RATE_HZ, ground=ground)
            lowest, mean, slide = soles(performance, library, ground)
            print(f"{name:12} {action:15} {lowest:6.1f} mm {mean:6.1f} mm {slide:7.4f} m/s")


def costs(library: Library) -> None:
    """Print what a terrain takes to build, to ask and to act on."""
    axis = np.arange(-2.0, 8.0, 0.04)
    recording, score = take(library, "walk", 60.0, way_m=5.0)
    places = np.random.default_rng(0).uniform(-2.0, 7.0, (100_000, 2))
    ground = terrain(bumps, 0.04)
    for what, work in (
        (f"build {2 * len(axis) ** 2} triangles", lambda: terrain(bumps, 0.04)),
        ("100,000 heights", lambda: ground.height_at(places)),
        ("animate 60 s on level ground", lambda: animate(score, recording, library)),
        ("animate 60 s on terrain", lambda: animate(score, recording, library, ground=ground)),
    ):
        took = []
        for _ in range(5):
            start = time.perf_counter()
            work()
            took.append(time.perf_counter() - start)
        print(f"{what}: {statistics.median(took):.3f} s ({min(took):.3f} to {max(took):.3f})")


if __name__ == "__main__":
    shipped = load_library()
    flown(shipped)
    walked(shipped)
    costs(shipped)
