"""RecognitionStream: the actions in a doodle that is still being drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.geometry.arrays import BoolArray, FloatArray
from smd.recognition.detection import Detection
from smd.recognition.segmentation import Segment
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, Token, TokenRun
from smd.smoothing_stream import Arrays, SmoothingStream


class Spotter(Protocol):
    """Finds the actions in a motion that is cut into tokens, as an offline pass would."""

    def chosen(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> Sequence[Segment]:
        """Return the stretches of runs that are actions, in time order."""

    def named(
        self, motion: RigidMotion, runs: Sequence[TokenRun], segments: Sequence[Segment]
    ) -> Sequence[Detection]:
        """Return the detections of stretches of runs that were chosen."""


Movement: TypeAlias = tuple[Token, float, float]
"""A run that moves: its token, start and end."""

HORIZON_S = 0.5
"""A detection is final this long after its last movement, at the latest."""

BLOCK_S = 0.25
"""Interval of looks; the stream also looks when a detection falls due."""

SOON_S = 0.1
"""Interval to the next look, if the next detection to fall due is not over yet."""

MEMORY_S = 4.0
"""Movement that nothing has explained for this long is dropped."""

STEP_S = 1.0 / 50.0
"""Most time between two samples for which the horizon is kept."""

_CONTEXT_S = 1.5
"""Movement that is decided, and kept to see beside it how faint what follows is."""

_SAME_S = 0.025
"""Times nearer than one and a half periods are the same boundary, seen from two blocks."""


class RecognitionStream:
    """Recognises actions while they are drawn.

    Samples are smoothed as they come (`SmoothingStream`). Every `BLOCK_S`, and when a detection
    falls due, the undecided motion is cut into tokens and given to the spotter, as if it were the
    whole recording. Detections that ended ``horizon_s`` ago (less two samples) are final; the rest
    is decided again next time. So a detection is final as soon as the offline pass over the samples
    so far finds that it ended so long ago. ``docs/streaming.md`` explains where that differs from
    the offline pass over everything.

    Parameters
    ----------
    spotter
        The offline pass: a `smd.recognition.Recognizer`, or `TokenSpotter` for tokens alone.
    figure_height_m
        Height of the figurine that the prop stands for.
    horizon_s
        How long after its last movement a detection is final, at least `BLOCK_S`; longer is nearer
        to the offline pass.
    listener
        Called with each piece of smoothed motion, as it follows.
    """

    def __init__(
        self,
        spotter: Spotter,
        *,
        figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
        horizon_s: float = HORIZON_S,
        listener: Callable[[RigidMotion], None] | None = None,
    ) -> None:
        self._spotter = spotter
        self._listener = listener
        self._figure_height_m = figure_height_m
        self._settling_s = horizon_s - 2.0 * STEP_S
        self._smoothing = SmoothingStream()
        self._arrays: Arrays = ()  # of the motion that is not decided yet, and some before it
        self._given: list[tuple[float, bool | None]] = []  # times of samples, and what they draw
        self._look_s = -np.inf  # when to look next
        self._decided_s = -np.inf  # what begins earlier is decided
        self._forgotten = 0  # runs before the motion that is kept
        self._ahead: tuple[RigidMotion, Sequence[TokenRun], list[Segment]] | None = None
        self._seen: tuple[list[Movement], int, list[Segment]] = [], 0, []  # last, and its answer

    def push(
        self,
        time_s: float,
        position_m: ArrayLike,
        orientation_xyzw: ArrayLike,
        drawing: bool | None = None,
    ) -> list[Detection]:
        """Take one sample and return the detections that have become final, in time order.

        ``drawing`` says whether the user means to draw; None where nothing says so.

        Raises
        ------
        DoodleError
            If the sample is not later than the last one, not finite, or no rotation; the stream
            goes on without it.
        """
        self._smoothing.push(time_s, position_m, orientation_xyzw)
        self._given.append((time_s, drawing))
        if time_s < self._look_s:
            self._name_ahead()
            return []
        self._look_s = time_s + BLOCK_S
        self._extend(self._smoothing.ready())
        return self._settled(time_s - self._settling_s)

    def finish(self) -> list[Detection]:
        """Return the detections that were not final yet; the doodle is over."""
        self._extend(self._smoothing.finish())
        return self._settled(np.inf)

    def _extend(self, new: Arrays | None) -> None:
        if new is not None:
            if self._listener:
                self._listener(RigidMotion(*new))
            kept = self._arrays or tuple(array[:0] for array in new)
            self._arrays = tuple(map(np.concatenate, zip(kept, new, strict=True)))

    def _settled(self, settled_s: float) -> list[Detection]:
        """Return the detections that ended by then, and forget what plays no part any more."""
        if not self._arrays or len(self._arrays[0]) < 2:
            return []
        motion = RigidMotion(*self._arrays)
        drawing = self._drawing(motion.time_s)
        runs = tokenize(motion, figure_height_m=self._figure_height_m, drawing=drawing)
        first = next(
            (i for i, run in enumerate(runs) if run.start_s > self._decided_s - _SAME_S), len(runs)
        )
        final: list[Detection] = []
        needed_s = settled_s
        due_s = next((run.end_s for run in runs[first:] if run.token != STILL), np.inf)
        if due_s <= settled_s + BLOCK_S + SOON_S:  # by the next look: what is ready will not wait
            segments = self._undecided(motion, runs, first)
            ends_s = [runs[segment.last - 1].end_s for segment in segments]
            count = sum(end_s <= settled_s for end_s in ends_s)
            if count:
                final = list(self._spotter.named(motion, runs, segments[:count]))
                self._decided_s = final[-1].end_s
            if count < len(segments):
                if segments[count].last < len(runs):  # likely to stay so
                    self._ahead = motion, runs, segments[count : count + 1]
                else:  # it is to be named once it is over, and before it falls due
                    self._look_s = min(self._look_s, settled_s + self._settling_s + SOON_S)
            if due_s <= settled_s:
                due_s = np.inf
                if count < len(segments):
                    needed_s = min(settled_s, runs[segments[count].first].start_s)
                    due_s = ends_s[count]
        self._look_s = min(self._look_s, due_s + self._settling_s)
        numbered = [
            replace(
                detection,
                first_run=detection.first_run + self._forgotten,
                last_run=detection.last_run + self._forgotten,
            )
            for detection in final
        ]
        if np.isfinite(settled_s):
            self._forget(runs, needed_s)
        return numbered

    def _name_ahead(self) -> None:
        """Name what falls due next while there is time; a spotter may remember it."""
        if self._ahead:
            self._spotter.named(*self._ahead)
            self._ahead = None

    def _undecided(
        self, motion: RigidMotion, runs: Sequence[TokenRun], first: int
    ) -> list[Segment]:
        """Return the segments of the runs from ``first`` on; the ones before are decided."""
        # Rest that goes on changes nothing.
        moving = [(run.token, run.start_s, run.end_s) for run in runs if run.token != STILL]
        if (moving, first) == self._seen[:2]:
            return self._seen[2]
        segments = list(self._spotter.chosen(motion, runs))
        if any(segment.first < first < segment.last for segment in segments):
            # What is decided looks otherwise by now, but it is decided.
            segments = [
                replace(segment, first=segment.first + first, last=segment.last + first)
                for segment in self._spotter.chosen(motion, runs[first:])
            ]
        segments = [segment for segment in segments if segment.first >= first]
        self._seen = moving, first, segments
        return segments

    def _drawing(self, time_s: FloatArray) -> BoolArray:
        """Return whether movement counts at each of the motion's times."""
        times, drawing = zip(*self._given, strict=True)
        before = np.searchsorted(times, time_s + 1e-9, side="right") - 1
        counts = np.array([each is not False for each in drawing])  # None: nothing says it does not
        return counts[np.maximum(before, 0)]

    def _forget(self, runs: Sequence[TokenRun], needed_s: float) -> None:
        """Forget the motion before the first run that may still be part of an action."""
        time_s = self._arrays[0]
        old_s = max(needed_s - MEMORY_S, self._decided_s)
        moving = (run.start_s for run in runs if run.token != STILL and run.end_s > old_s + _SAME_S)
        self._decided_s = max(self._decided_s, min(next(moving, needed_s), needed_s))
        cut = int(np.searchsorted(time_s, self._decided_s - _CONTEXT_S))
        if cut == 0:
            return
        self._forgotten += sum(run.last <= cut for run in runs)
        self._arrays = tuple(array[cut:] for array in self._arrays)
        times = [given_s for given_s, _ in self._given]
        del self._given[: max(int(np.searchsorted(times, time_s[cut])) - 1, 0)]
