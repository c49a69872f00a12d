"""Recognition and Effort while devices draw."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from laban import Effort, EffortModel, RigidMotion
from laban.effort import AXES
from laban.windows import WINDOW_S, EffortStream
from smd.capture.source import Row
from smd.errors import DoodleError
from smd.formats.dropouts import LONGEST_BRIDGE_S
from smd.formats.frame import Mount
from smd.geometry.rotations import multiply, rotate
from smd.recognition import Recognizer
from smd.recognition.acceptance import Intent
from smd.recognition.recognizer import Span

MOST_WINDOWS = 256
"""Windows of Effort that are kept for a phrase that is not decided yet: a minute of them."""


class Decided(NamedTuple):
    """A phrase that was decided while playing.

    Attributes
    ----------
    device : its name.
    span : the action, and when.
    effort : of the windows that lie in it, on average.
    """

    device: str
    span: Span
    effort: Effort


class LiveRecognition:
    """Recognises what several devices draw, frame by frame.

    A device that was lost for longer than smoothing bridges begins anew, as a doodle does.

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
        """Take a moment, by serial; return the phrases that it decides."""
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
            with suppress(DoodleError):  # a bad sample is in the recording; here it is passed over
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
    """One device, from one loss to the next.

    Effort is read one sample after the stream has looked, so that a phrase does not wait for it.
    """

    def __init__(
        self, device: str, recognizer: Recognizer, intent: Intent, model: EffortModel
    ) -> None:
        self._device = device
        self._unread: list[RigidMotion] = []
        self._spans = recognizer.stream(self._unread.append, intent=recognizer.intent or intent)
        self._efforts = EffortStream(model)
        self._windows: deque[tuple[float, Effort]] = deque(maxlen=MOST_WINDOWS)
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
        self._read()
        spans = self._spans.push(time_s, position_m, orientation_xyzw, drawing)
        return [self._decided(span) for span in spans]

    def finish(self) -> list[Decided]:
        """Return the phrases that were not decided yet."""
        spans = self._spans.finish()
        self._read()
        self._windows.extend(self._efforts.finish())
        return [self._decided(span) for span in spans]

    def _read(self) -> None:
        """Read the Effort of the windows that new smoothed motion completes."""
        for motion in self._unread:
            self._windows.extend(self._efforts.push(motion))
        self._unread.clear()

    def _decided(self, span: Span) -> Decided:
        """Return a span with the Effort of the windows in it, or of the nearest one."""
        middle_s = 0.5 * (span.start_s + span.end_s)
        half_s = max(0.5 * (span.end_s - span.start_s) - 0.5 * WINDOW_S, 0.0)
        by_distance = sorted(self._windows, key=lambda window: abs(window[0] - middle_s))
        inside = [each for each in by_distance if abs(each[0] - middle_s) <= half_s]
        return Decided(self._device, span, _mean([e for _, e in inside or by_distance[:1]]))


def _mean(efforts: list[Effort]) -> Effort:
    """Return the mean of each axis over the windows in which it was read."""
    values = {
        axis: [value for e in efforts if (value := getattr(e, axis)) is not None] for axis in AXES
    }
    return Effort(**{axis: float(np.mean(read)) for axis, read in values.items() if read})
