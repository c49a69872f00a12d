"""How few keys a performance needs: `python -m benchmarks.keys`.

What ``smd convert --keys reduced --within MM`` keeps of the shipped stories: keys in the file, and
so in every curve that Blender makes of it; how far the skin and the ground root stray at most.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import smd
from exporters.keys import drift_m, key_frames
from smd.acting.performance import Actor
from smd.geometry.resampling import interpolate_linear

RECORDINGS = Path(__file__).parents[1] / "recordings"
WITHIN_MM = (0.5, 1.0, 2.0, 5.0, 10.0)


def root_drift_m(actor: Actor, keys: np.ndarray) -> float:
    """Return how far the ground root is at most from where it is at each frame."""
    root_m = actor.poses.translation_m[:, 0]
    shown_m = interpolate_linear(keys, root_m[keys], np.arange(len(actor)))
    return float(np.linalg.norm(shown_m - root_m, axis=-1).max())


def main() -> None:
    """Print a line for each performer and distance."""
    library = smd.load_library()
    print("performer   within mm  frames  keys  share   skin mm  root mm  seconds")
    for path in sorted(RECORDINGS.glob("*.csv")):
        recording = smd.read_recording(path)
        performance = smd.animate(smd.parse(recording, library), recording, library)
        for actor in performance.actors:
            for within in WITHIN_MM:
                started = time.process_time()
                keys = key_frames(actor.character, actor.poses, 0.001 * within)
                seconds = time.process_time() - started
                drift = 1000.0 * drift_m(actor.character, actor.poses, keys).max()
                root = 1000.0 * root_drift_m(actor, keys)
                print(
                    f"{actor.name:12s} {within:8g} {len(actor):7d} {len(keys):5d}"
                    f" {len(keys) / len(actor):6.2f} {drift:9.2f} {root:8.2f} {seconds:8.2f}"
                )


if __name__ == "__main__":
    main()
