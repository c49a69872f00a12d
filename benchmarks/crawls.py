"""The caterpillar's crawls, and how its feet hold on a bend: ``python -m benchmarks.crawls``."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import smd
from actions_library.folder import load_library
from actions_library.library import Library
from smd.acting.performance import Actor
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.doodle import Recording
from smd.geometry.arrays import BoolArray, FloatArray
from smd.score import DEFAULT_FIGURE_HEIGHT_M, Part, Phrase, Score
from smd.synthetic.curves import circle

FOLDER = Path(__file__).parents[1] / "actions_library" / "caterpillar"
CRAWLS = ("crawl", "walk", "hump", "loop")
RADII_M = (0.6, 1.2)
RATE_HZ, LASTS_S = 60.0, 6.0

DOWN_M, SETTLED = 5e-4, 6
"""Height up to which a foot is down, and frames for which it is so around a step that counts."""


def trunk_m(clip: Clip) -> FloatArray:
    """Return where a clip's segments are, ``(n, segments, 3)``."""
    place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]
    names = clip.skeleton.joints
    return place[:, [j for j, name in enumerate(names) if name.startswith("segment_")]]


def print_crawl(clip: Clip, height_m: float) -> None:
    """Print a crawl's measures, for a trunk that is so high at rest."""
    trunk = trunk_m(clip)
    between = np.linalg.norm(np.diff(trunk, axis=1), axis=-1)
    at_rest = clip.skeleton.rest_translation_m[clip.skeleton.index("segment_2"), 2]
    step = np.diff(trunk[..., 2].mean(axis=1)) * (len(clip) - 1) / clip.travel_m
    print(
        f"{clip.name}: {clip.travel_m:.2f} m in {clip.duration_s:.2f} s, "
        f"crest {trunk[..., 1].max() - height_m:.2f} m, segments {between.min() / at_rest:.0%} to "
        f"{between.max() / at_rest:.0%}, speed of the middle {step.min():.2f} to {step.max():.2f} "
        "of the mean"
    )


def on_a_bend(library: Library, action: str, radius_m: float) -> Actor:
    """Return the caterpillar that goes around a circle at its own speed."""
    clip = library.clip(action)
    turns = clip.travel_m / clip.duration_s * LASTS_S / (2.0 * np.pi * radius_m)
    scale = library.character.height_m / DEFAULT_FIGURE_HEIGHT_M
    doodle = circle(radius_m=radius_m / scale, duration_s=LASTS_S, turns=turns)
    score = Score((Part(doodle.device, (Phrase(action, 0.2, LASTS_S - 0.2),)),))
    (actor,) = smd.animate(score, Recording((doodle,)), library, rate_hz=RATE_HZ).actors
    return actor


def footholds(actor: Actor) -> tuple[FloatArray, BoolArray, FloatArray]:
    """Return of all feet their speed, ``(n, f)``, when they stand, and their least height.

    A foot stands in a step where it is down for some frames around it, whatever the clip says.
    """
    skeleton = actor.character.skeleton
    place = forward_kinematics(skeleton, *actor.poses)[1]
    feet = [j for j, name in enumerate(skeleton.joints) if "_foot_" in name]
    up = place[:, feet, 1] - skeleton.world_from_bind[feet, 1, 3]
    speed = np.linalg.norm(np.diff(place[:, feet][..., [0, 2]], axis=0), axis=-1) * RATE_HZ
    low = np.lib.stride_tricks.sliding_window_view(up < DOWN_M, SETTLED, axis=0).all(axis=-1)
    edge = SETTLED // 2 - 1
    return speed, np.pad(low, ((edge, edge), (0, 0))), up.min(axis=0)


def main() -> None:
    """Print the measures of each crawl, and how feet hold on bends."""
    library = load_library(FOLDER)
    at_rest = library.character.skeleton
    height_m = float(at_rest.world_from_bind[at_rest.index("segment_1"), 1, 3])
    for name in CRAWLS:
        print_crawl(library.clip(name), height_m)
    for name in CRAWLS:
        for radius_m in RADII_M:
            speed, on, least = footholds(on_a_bend(library, name, radius_m))
            print(
                f"{name}, radius {radius_m} m: feet stand {on.mean():.0%} of the time, slide "
                f"{speed[on].mean():.4f} m/s on average, above 0.02 m/s in "
                f"{np.mean(speed[on] > 0.02):.1%}, lowest {1e3 * least.min():.1f} mm"
            )


if __name__ == "__main__":
    main()
