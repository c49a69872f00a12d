"""From a recording to an animation, in the five lines of the README.

Reads a shipped recording of two props, acts it out with the shipped characters and writes
``smd-examples/duel.usda``, which opens in Blender, usdview or Unreal. Prints what each prop was
understood to do.
"""

from pathlib import Path

import smd

RECORDING = Path(__file__).parents[1] / "recordings" / "duel.csv"
FOLDER = Path("smd-examples")

recording = smd.read_recording(RECORDING)  # the suffix says which format it has
library = smd.load_library()  # the shipped humanoid; a folder for one of your own
score = smd.parse(recording, library)
performance = smd.animate(score, recording, library)

FOLDER.mkdir(exist_ok=True)
smd.write(performance, FOLDER / "duel.usda")

for part in score.performers:
    print(f"{part.device}: {', '.join(phrase.action for phrase in part.phrases)}")
print(f"wrote {FOLDER / 'duel.usda'}")
