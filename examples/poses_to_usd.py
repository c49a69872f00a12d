"""From poses of one's own to an animation: no recording and no Score.

Two walk cycles of the shipped character are laid along a straight line, in longer steps than the
clip's, as any other program might bring poses. ``grounded_actor`` keeps the feet that stand where
they stand. Writes ``smd-examples/walker.usda`` and prints how long the steps are.
"""

from pathlib import Path

import numpy as np

import smd
from smd.acting.act import grounded_actor
from smd.acting.legs import feet_of, legs_of
from smd.acting.performance import Performance
from smd.transfer.repertoire import piece_of

FOLDER = Path("smd-examples")
STEP_M = 0.8  # the clip's own is 0.7 m

library = smd.load_library()
clip = library.clip("walk")
legs = legs_of(clip.skeleton, feet_of(clip))
piece = piece_of(clip, travels=True, legs=legs)  # a clip, and when its feet stand

frame = np.arange(2 * piece.last_frame + 1.0)  # two cycles of two steps
poses = piece.sampled(frame)  # (n, joint, 4) and (n, joint, 3), the root at the origin
poses.translation_m[:, 0, 2] = 2 * STEP_M * frame / piece.last_frame  # ahead is +Z

actor = grounded_actor(
    "walker", library.character, poses, piece.stands_at(frame), legs, rate_hz=clip.rate_hz
)
FOLDER.mkdir(exist_ok=True)
smd.write(Performance(clip.rate_hz, 0.0, (actor,)), FOLDER / "walker.usda")

length_m = actor.poses.translation_m[-1, 0, 2] / 4
print(f"4 steps of {length_m:.2f} m")
print(f"wrote {FOLDER / 'walker.usda'}")
