"""Teach a gesture of your own by three performances, and have a fourth one recognised.

The gesture, made up here: draw an upright Z in the air, as with a sword. Makes a library in
``smd-examples/swordsman/`` that knows it beside walking and bowing, and shows the clip of slashing
for it. Prints what was learned, and what the fourth performance is taken for.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np

import smd
from actions_library.extension import new_library
from smd.recognition import learn_action

FOLDER = Path("smd-examples") / "swordsman"


def zorro(size_m: float, stroke_s: float) -> smd.Doodle:
    """Return one performance: right, down to the left, right again; with rest around it."""
    corners_m = size_m * np.array([[0, 0, 0], [-1, 0, 0], [0, -1, 0], [-1, -1, 0]])
    time_s = np.arange(0.0, 3 * stroke_s + 1.0, 1 / 90)
    done = np.clip((time_s - 0.5) / stroke_s, 0.0, 2.999)
    stroke = done.astype(int)
    share = (done - stroke) ** 2 * (3.0 - 2.0 * (done - stroke))  # from rest to rest
    position_m = corners_m[stroke] + share[:, None] * (corners_m[stroke + 1] - corners_m[stroke])
    return smd.Doodle(time_s, position_m, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)))


action = learn_action("zorro", [zorro(0.14, 0.45), zorro(0.18, 0.5), zorro(0.22, 0.6)])
shipped = smd.load_library()
clip = replace(shipped.clip("slash"), name="zorro")
shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.parent.mkdir(exist_ok=True)
library = new_library(
    FOLDER, shipped, ["idle", "walk", "bow"], action, clip, shipped.credit("slash")
)
print(f"{FOLDER}: {', '.join(known.name for known in library.actions)}")
print(f"learned {action.name} from {len(action.learned_from)} performances: {action.pattern}")

score = smd.parse(smd.Recording((zorro(0.16, 0.55),)), library)
for phrase in score.performers[0].phrases:
    print(f"a fourth one is taken for {phrase.action}, confidence {phrase.confidence:.2f}")
