"""What a stream should say: the offline pass over all there is, asked again and again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from laban import RigidMotion
from smd.doodle import Doodle
from smd.recognition.detection import Detection
from smd.recognition.streaming import BLOCK_S, HORIZON_S, SOON_S, STEP_S, Spotter
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, TokenRun
from smd.smoothing import RATE_HZ, WINDOW_S, smooth


def spans_as_they_become_final(
    doodle: Doodle, spotter: Spotter, horizon_s: float = HORIZON_S
) -> list[tuple[str, float, float]]:
    """Return actions, starts and ends, looking when the stream does; nothing is forgotten."""
    whole = smooth(doodle)
    decided_s, look_s = -np.inf, -np.inf
    found = []
    times = [*doodle.time_s.tolist(), np.inf]
    for now_s, before_s in zip(times, [-np.inf, -np.inf, *times], strict=False):
        last = now_s == np.inf
        if now_s < look_s:
            continue
        look_s = now_s + BLOCK_S
        settling_s = horizon_s - 2.0 * STEP_S
        settled_s = now_s - settling_s
        known_s = np.inf if last else _grid_before(before_s, doodle) - 0.5 * WINDOW_S
        if now_s - doodle.time_s[0] < 0.5 or known_s - doodle.time_s[0] < 0.02:
            continue
        motion = whole.between(-np.inf, known_s)
        runs = tokenize(motion)
        first = next((i for i, run in enumerate(runs) if run.start_s > decided_s - 0.025), 0)
        spans: list[Detection] = _spans(spotter, motion, runs)
        count = len(runs)
        if any(span.first_run < first < span.last_run for span in spans):
            spans = _spans(spotter, motion, runs[first:])
            count = len(runs) - first
        spans = [span for span in spans if span.start_s > decided_s - 0.025]
        moving_s = [run.end_s for run in runs[first:] if run.token != STILL]
        later = [span for span in spans if span.end_s > settled_s]
        is_near = bool(moving_s) and moving_s[0] <= settled_s + BLOCK_S + SOON_S
        if is_near and later and later[0].last_run == count:  # it is not over yet
            look_s = min(look_s, now_s + SOON_S)
        if moving_s and moving_s[0] > settled_s:
            look_s = min(look_s, moving_s[0] + settling_s)
            continue
        for span in spans:
            if span.end_s > settled_s:
                look_s = min(look_s, span.end_s + settling_s)
                break
            found.append((span.action, span.start_s, span.end_s))
            decided_s = span.end_s
    return found


def _spans(spotter: Spotter, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Detection]:
    return list(spotter.named(motion, runs, spotter.chosen(motion, runs)))


def _grid_before(time_s: float, doodle: Doodle) -> float:
    """Return the last time of the smoothed motion's fine grid before one."""
    stride = max(1, int(np.ceil((len(doodle) - 1) / doodle.duration_s / RATE_HZ - 0.3)))
    step_s = 1.0 / RATE_HZ / stride
    fine = np.ceil((time_s - doodle.time_s[0]) / step_s - 1e-9) - 1
    return float(doodle.time_s[0] + fine * step_s)
