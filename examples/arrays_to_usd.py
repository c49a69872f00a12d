"""Bring a trajectory of your own, as arrays, and have it acted out.

Any tracker will do that tells times, positions and orientations. Here they are made up: a prop goes
along half a circle, turning along, and comes to rest. Writes ``smd-examples/arrays.csv`` (the
recording) and ``smd-examples/arrays.usda`` (the animation); prints what was understood.
"""

from pathlib import Path

import numpy as np

import smd

FOLDER = Path("smd-examples")
RADIUS_M, SECONDS, RATE_HZ = 0.25, 5.0, 90.0

time_s = np.arange(0.0, SECONDS, 1.0 / RATE_HZ)
way = np.clip((time_s - 0.5) / (SECONDS - 1.0), 0.0, 1.0)  # half a second of rest at either end
angle = np.pi * way**2 * (3.0 - 2.0 * way)  # heading: about +Y, from +Z towards +X
zero = np.zeros_like(angle)
position_m = RADIUS_M * np.stack([1.0 - np.cos(angle), zero, np.sin(angle)], axis=-1)
orientation_xyzw = np.stack([zero, np.sin(angle / 2), zero, np.cos(angle / 2)], axis=-1)

doodle = smd.Doodle(time_s, position_m, orientation_xyzw, device="prop")
recording = smd.Recording((doodle,), source="arrays_to_usd.py")
library = smd.load_library()
score = smd.parse(recording, library, intent="drawn")  # all of it was meant

FOLDER.mkdir(exist_ok=True)
smd.write_recording(recording, FOLDER / "arrays.csv")
smd.write(smd.animate(score, recording, library), FOLDER / "arrays.usda")
for phrase in score.performers[0].phrases:
    print(f"{phrase.start_s:.2f} to {phrase.end_s:.2f} s: {phrase.action}")
print(f"wrote {FOLDER / 'arrays.csv'} and {FOLDER / 'arrays.usda'}")
