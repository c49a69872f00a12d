"""Give the prop a character and a clip of your own.

Makes a library in ``smd-examples/my_hero/`` of a character's file, imports a BVH clip into it as an
action, and has that acted out. For files of your own, change CHARACTER (glTF or USD) and CLIP (BVH
as well): here they are the shipped figure, and arms that go up and come down again. Writes
``smd-examples/hurrah.usda``; prints what was found out about character and clip.
"""

import shutil
from pathlib import Path

import numpy as np

import smd
from actions_library.adoption.library import import_clip, library_from
from actions_library.importers import import_file
from smd.score import Part

FOLDER = Path("smd-examples")
CHARACTER = smd.load_library().folder / "character.usdc"
CLIP = Path(__file__).with_name("arms_up.bvh")

FOLDER.mkdir(exist_ok=True)
shutil.rmtree(FOLDER / "my_hero", ignore_errors=True)
hero, played = library_from(FOLDER / "my_hero", import_file(CHARACTER))
idling = played.get("idle", "its rest pose")
print(f"my_hero: {len(hero.character.skeleton)} joints, idles with {idling}")
arms_up = import_file(CLIP, up="y", unit_m=1.0)  # a BVH file does not say; by default a guess
hero, adopted = import_clip(hero, arms_up, arms_up.animations[0], "hurrah")
manner = "travels" if adopted.ground.travels else "in place"
print(f"hurrah: {adopted.clip.duration_s:.2f} s, {manner}; library: {hero.folder}")

# `smd learn hurrah TAKES… --library smd-examples/my_hero` teaches its gesture; here a Score asks.
still = np.arange(0.0, 4.0, 0.02)
doodle = smd.Doodle(still, np.zeros((200, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (200, 1)), "prop")
score = smd.Score((Part("prop", (smd.Phrase("hurrah", 1.0, 3.0),)),))
performance = smd.animate(score, smd.Recording((doodle,)), hero)
smd.write(performance, FOLDER / "hurrah.usda")
print(f"wrote {FOLDER / 'hurrah.usda'}")
