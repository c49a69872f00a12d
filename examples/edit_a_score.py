"""Correct what was understood, and act it out again.

Parses a shipped recording into a Score, a small file that any editor opens, and changes it in three
ways: another action, another Effort, another time. Writes ``smd-examples/postman.score.json`` and
``smd-examples/postman.usda``; prints the phrases before and after.
"""

from dataclasses import replace
from pathlib import Path

import smd
from laban import Effort

RECORDING = Path(__file__).parents[1] / "recordings" / "postman.csv"
FOLDER = Path("smd-examples")

recording = smd.read_recording(RECORDING)
library = smd.load_library()
score = smd.parse(recording, library)
(postman,) = score.performers
print("understood:", *(phrase.action for phrase in postman.phrases))

phrases = list(postman.phrases)
first, jump = phrases[0], phrases[-1]
assert (first.action, jump.action) == ("walk", "jump")
# He sneaks up to the house, gently; and he leaps over the fence, a little earlier.
phrases[0] = replace(first, action="sneak", effort=Effort(time=-0.8, weight=-0.9))
phrases[-1] = replace(jump, action="leap", end_s=jump.end_s - 0.1)
corrected = replace(score, performers=(replace(postman, phrases=tuple(phrases)),))

FOLDER.mkdir(exist_ok=True)
smd.write_score(corrected, FOLDER / "postman.score.json")  # or write first, and edit by hand
again = smd.read_score(FOLDER / "postman.score.json")
smd.write(smd.animate(again, recording, library), FOLDER / "postman.usda")
print("corrected: ", *(phrase.action for phrase in again.performers[0].phrases))
print(f"wrote {FOLDER / 'postman.score.json'} and {FOLDER / 'postman.usda'}")
