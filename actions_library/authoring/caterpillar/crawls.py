"""Four crawls of the caterpillar, a cycle each: the higher the fold, the longer the stride."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.caterpillar.skeleton import (
    FOOT_AHEAD,
    HEIGHT_M,
    LENGTH_M,
    PAIRS,
    SEGMENTS,
    TAIL_M,
    legs_of_pair,
)
from actions_library.authoring.caterpillar.trunk import VIAS, carried_swing
from actions_library.authoring.feet import Plant, repeated
from actions_library.authoring.fold import Fold
from actions_library.authoring.keys import Turn
from actions_library.authoring.posing import RATE_HZ
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, on_both_sides
from actions_library.authoring.rig_posing import make_rig_clip
from actions_library.authoring.rigging import place_of
from actions_library.authoring.stance import frame_count, steady_travel
from smd.character.clip import Clip
from smd.geometry.arrays import FloatArray

LIFT_ALONG = ((0.0, 0.45), (0.38, 1.0), (0.65, 1.0), (1.0, 0.65))
"""How high the fold is along the body, tail to head, as a share of its height in the middle: the
tail is drawn along rather than thrown up, and the head stays low."""

_GRIP_M = 0.007
"""How far a segment is moved from where it stands when its feet let go, and when they take hold."""


def crawl(rig: Rig) -> Clip:
    """Flat: the segments shorten and hardly rise."""
    return _crawl(rig, "crawl", Fold(8.0, 0.40, 0.42, 0.95, LENGTH_M), 44 / 60)


def walk(rig: Rig) -> Clip:
    """The usual crawl: a low wave along the back."""
    return _crawl(rig, "walk", Fold(25.0, 0.32, 0.50, 0.90, LENGTH_M), 42 / 60)


def hump(rig: Rig) -> Clip:
    """A high wave: half of the body is up."""
    return _crawl(rig, "hump", Fold(46.0, 0.15, 0.56, 0.75, LENGTH_M), 46 / 60)


def loop(rig: Rig) -> Clip:
    """As an inchworm: the tail comes up to the front feet in one arch, then the front stretches."""
    return _crawl(rig, "loop", Fold(63.0, 0.04, 0.46, 0.56, LENGTH_M), 54 / 60)


def _crawl(rig: Rig, name: str, fold: Fold, period_s: float) -> Clip:
    end = period_s
    cycles = np.arange(frame_count(end)) / RATE_HZ / period_s
    plants = {
        leg: repeated([plant], period_s, left=0.0, ahead=fold.stride_m)
        for k in PAIRS
        for leg in legs_of_pair(k)
        for plant in (_plant(rig, leg, k, fold, period_s),)
    }
    return make_rig_clip(
        rig,
        name,
        _head_keys(fold),
        steady_travel(end, ahead=fold.stride_m),
        plants=plants,
        laid={"spine": _spine_m(fold, cycles)},
        stage_ends_s=(0.0, 0.0, end, end, end),
        cyclic=True,
    )


def _spine_m(fold: Fold, cycles: FloatArray) -> FloatArray:
    """Return where the segments begin, and where the last one ends, ``(n, 13, 3)``."""
    from scipy.interpolate import PchipInterpolator

    along = np.linspace(0.0, 1.0, SEGMENTS + 1)
    ahead, up = fold.moved_m(cycles[:, None] - fold.lag * along)
    place = np.zeros((*ahead.shape, 3))
    place[..., 1] = HEIGHT_M + PchipInterpolator(*zip(*LIFT_ALONG, strict=True))(along) * up
    place[..., 2] = TAIL_M + LENGTH_M * along + ahead + _lead_m(fold)
    return place


def _lead_m(fold: Fold) -> float:
    """Return what is added to the places of a body so that its middle is over the ground root."""
    return 0.5 * fold.lag * fold.stride_m - fold.lead_m()


def _plant(rig: Rig, leg: str, k: int, fold: Fold, period_s: float) -> Plant:
    """Return a foot's stand after its segment's first fold, and the way through the air to it."""
    left, _, ahead = place_of(rig.skeleton, rig.leg(leg).foot)
    first = fold.lag * (k - 1.0 + FOOT_AHEAD) / SEGMENTS  # when the fold comes to these feet
    phase = np.linspace(-0.4, 1.4, 3601) * fold.part
    moved = np.hypot(*fold.moved_m(phase))
    left_over = np.hypot(fold.stride_m - fold.moved_m(phase)[0], fold.moved_m(phase)[1])
    leave = first + phase[np.argmax(moved > _GRIP_M)]
    land = first + phase[len(phase) - 1 - np.argmax((left_over > _GRIP_M)[::-1])]
    stood = ahead + _lead_m(fold)
    carried = _spine_m(fold, leave + np.array(VIAS) * (land - leave))[:, k - 1 : k + 1]
    swing = carried_swing(rig, leg, k, carried, stood, fold.stride_m)
    return Plant(
        land=land * period_s,
        leave=(leave + 1.0) * period_s,
        left=left,
        ahead=stood + fold.stride_m,
        swing=swing,
    )


def _head_keys(fold: Fold) -> list[RigKey]:
    """The head nods a little as the fold reaches it; the feelers follow."""
    reached = fold.lag % 1.0
    nod = min(0.12 * fold.angle_deg, 7.0)
    return [
        key(reached, head=Turn(lean=4.0 - nod)),
        key(reached + 0.5 * fold.part, head=Turn(lean=4.0 + nod)),
        on_both_sides(key(reached, left_feeler=Turn(lean=12.0, tilt=-4.0))),
        on_both_sides(key(reached + 0.5, left_feeler=Turn(lean=-10.0, tilt=8.0))),
    ]
