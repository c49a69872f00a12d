"""Recognition and Effort while devices draw."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from laban import Effort, EffortModel, RigidMotion, read_effort
from smd.capture.source import Row
from smd.errors import DoodleError
from smd.formats.dropouts import LONGEST_BRIDGE_S
from smd.formats.frame import Mount
from smd.geometry.rotations import multiply, rotate
from smd.recognition import Recognizer
from smd.recognition.acceptance import Intent
from smd.recognition.detection import Detection

KEPT_S = 60.0
"""Length of movement that is kept for a phrase that is not decided yet."""


class Decided(NamedTuple):
    """A phrase that was decided while playing.

    Attributes
    ----------
    device : its name.
    detection : the action, and when.
    effort : of the detection, read as `smd.parse` reads it when all is over.
    """

    device: str
    detection: Detection
    effort: Effort


class LiveRecognition:
    """Recognises actions in the movement of several devices, frame by frame.

    After a dropout that is too long to bridge, a device starts a new stream, as it does a doodle.

    Parameters
    ----------
    recognizer
        Of the library that is played with.
    model
        Of Effort.
    names
        What devices are called, by serial.
    mount
        How the prop sits on its tracker.
    """

    def __init__(
        self,
        recognizer: Recognizer,
        model: EffortModel,
        names: Mapping[str, str],
        mount: Mount | None = None,
    ) -> None:
        self._recognizer = recognizer
        self._model = model
        self._names = names
        self._lever_m = None if mount is None else mount.lever_m
        self._turn_xyzw = None if mount is None else mount.tracker_from_prop_xyzw
        self._followers: dict[str, _Follower] = {}

    def push(self, time_s: float, rows: Mapping[str, Row]) -> list[Decided]:
        """Take the rows of one frame, by serial; return the phrases that it decides."""
        decided: list[Decided] = []
        for serial, (pose, drawing) in rows.items():
            if pose is None:
                continue
            follower = self._followers.get(serial)
            if follower is None or time_s - follower.last_s > LONGEST_BRIDGE_S:
                decided += follower.finish() if follower else []
                intent = Intent.FREE if drawing is None else Intent.DRAWN
                follower = _Follower(self._names[serial], self._recognizer, intent, self._model)
                self._followers[serial] = follower
            with suppress(DoodleError):  # a bad sample is in the recording; here it is skipped
                decided += follower.push(time_s, *self._of_prop(pose[:3], pose[3:]), drawing)
        return decided

    def finish(self) -> list[Decided]:
        """Return the phrases that were not decided yet; the doodle is over."""
        decided = [each for follower in self._followers.values() for each in follower.finish()]
        self._followers.clear()
        return decided

    def _of_prop(
        self, tracker_m: ArrayLike, world_from_tracker_xyzw: ArrayLike
    ) -> tuple[ArrayLike, ArrayLike]:
        """Return position and orientation of the prop on its tracker."""
        if self._lever_m is None or self._turn_xyzw is None:
            return tracker_m, world_from_tracker_xyzw
        return (
            np.asarray(tracker_m) + rotate(world_from_tracker_xyzw, self._lever_m),
            multiply(world_from_tracker_xyzw, self._turn_xyzw),
        )


class _Follower:
    """One device, from one loss to the next."""

    def __init__(
        self, device: str, recognizer: Recognizer, intent: Intent, model: EffortModel
    ) -> None:
        self._device = device
        self._model = model
        self._spans = recognizer.stream(self._keep, intent=recognizer.intent or intent)
        self._smoothed: deque[RigidMotion] = deque()
        self.last_s = -np.inf

    def push(
        self,
        time_s: float,
        position_m: ArrayLike,
        orientation_xyzw: ArrayLike,
        drawing: bool | None,
    ) -> list[Decided]:
        """Take one sample; return the phrases that it decides."""
        self.last_s = time_s
        detections = self._spans.push(time_s, position_m, orientation_xyzw, drawing)
        return [self._decided(detection) for detection in detections]

    def finish(self) -> list[Decided]:
        """Return the phrases that were not decided yet."""
        return [self._decided(detection) for detection in self._spans.finish()]

    def _keep(self, motion: RigidMotion) -> None:
        """Keep smoothed motion for phrases to come, and drop what is too old."""
        if not len(motion):
            return
        self._smoothed.append(motion)
        while self._smoothed[0].time_s[-1] < motion.time_s[-1] - KEPT_S:
            self._smoothed.popleft()

    def _decided(self, detection: Detection) -> Decided:
        """Return a detection with its Effort."""
        parts = [
            motion
            for motion in self._smoothed
            if motion.time_s[-1] >= detection.start_s - 1e-9
            and motion.time_s[0] <= detection.end_s + 1e-9
        ]
        if not parts:
            return Decided(self._device, detection, Effort())
        whole = RigidMotion(
            *(np.concatenate([getattr(p, field.name) for p in parts]) for field in fields(parts[0]))
        )
        effort = read_effort(whole.between(detection.start_s, detection.end_s), self._model)
        return Decided(self._device, detection, effort)
