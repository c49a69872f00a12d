"""Recognise actions while they are drawn, from a device that replays a recording.

A replay stands in for tracked controllers: it hands out frames, one after another, as a headset's
runtime does. Each action is told half a second after it ended, with its Effort. Prints a line for
each as it comes, with the moment at which it was known.
"""

from pathlib import Path

import smd
from laban import load_effort_model
from smd.capture.live import LiveRecognition
from smd.capture.replay import ReplaySource
from smd.capture.take import rows_of
from smd.recognition import Recognizer

RECORDING = Path(__file__).parents[1] / "recordings" / "fledgling.csv"

recognizer = Recognizer(smd.load_library().actions)
source = ReplaySource([RECORDING])  # with a headset: `smd play` opens one
names = {device.serial: device.name for device in source.devices()}
live = LiveRecognition(recognizer, load_effort_model(), names)

for frame in source.poses():
    for known in live.push(frame.time_s, rows_of(frame, names, hold_to_draw=True)):
        print(
            f"at {frame.time_s:5.2f} s: {known.device} did {known.detection.action} from "
            f"{known.detection.start_s:.2f} to {known.detection.end_s:.2f} s, "
            f"time {known.effort.time:+.2f}"
        )
for known in live.finish():
    print(f"at the end: {known.device} did {known.detection.action}")
