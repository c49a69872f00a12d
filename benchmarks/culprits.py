"""Culprits: which actions and phrases have the frames that no body can do (`benchmarks.feasible`).

A frame counts where the mass centre's acceleration over the ground, or the distance of the zero
moment point from the soles, is above its goal. ``joins`` are frames in which a move just began,
within a transition's time. ``carried`` is the share of the fast frames in which the ground root
alone, as the path carries it, is above the goal: the others are the pose's own.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from benchmarks.acted import Acted, kind_of
from smd.geometry.arrays import FloatArray

ACC_M_S2, ZMP_M = 8.0, 0.35
"""Goals above which a frame is impossible."""


class Deed(NamedTuple):
    """What is done in some frames: how it moves, the clip's name, and "joins" or "inside"."""

    kind: str
    action: str
    part: str


Frames = dict[Deed, FloatArray]
"""Of each deed ``(n, 3)``: acceleration, that of the root alone, distance from the soles."""


def print_culprits(performers: Sequence[Acted], most: int) -> None:
    """Print the groups of frames with the largest shares of the impossible, and the worst moves."""
    frames = frames_of(performers)
    print(f"  {'':34s} {'frames':>7s}    above 8 m/s2, carried,  p99    above 35 cm,  p95")
    print_shares(frames, lambda deed: f"{deed.kind}, {deed.part}", most)
    print_shares(frames, lambda deed: f"{deed.action}, {deed.part}", most)
    print("  worst moves: acceleration, zero moment point outside")
    moves = sorted(worst_moves(performers), reverse=True)
    for acc, outside, where in moves[:most]:
        print(f"    {acc:6.1f} m/s2 {100.0 * outside:5.0f} cm  {where}")


def frames_of(performers: Sequence[Acted]) -> Frames:
    """Return the figures of all frames, by what is done in them."""
    found: dict[Deed, list[FloatArray]] = defaultdict(list)
    for one in performers:
        of = one.mechanics
        figures = np.column_stack([of.level_m_s2, of.carried_m_s2, of.outside_m])
        for i, move in enumerate(one.moves):
            for part, those in (("joins", one.joins), ("inside", ~one.joins)):
                deed = Deed(kind_of(move), move.piece.clip.name, part)
                found[deed].append(figures[(one.at == i) & those])
    return {deed: np.concatenate(of) for deed, of in found.items()}


def worst_moves(performers: Sequence[Acted]) -> list[tuple[float, float, str]]:
    """Return of each move its greatest acceleration, its greatest distance, and where it is."""
    found = []
    for one in performers:
        level, outside = one.mechanics.level_m_s2, np.nan_to_num(one.mechanics.outside_m)
        for i, move in enumerate(one.moves):
            rows = np.flatnonzero(one.at == i)
            if len(rows):
                top = rows[np.argmax(level[rows])]
                at_s = one.start_s + one.mechanics.time_s[top]
                where = f"{one.name}: {kind_of(move)} {move.piece.clip.name} at {at_s:.2f} s"
                found.append((float(level[top]), float(outside[rows].max()), where))
    return found


def print_shares(frames: Frames, group: Callable[[Deed], str], most: int) -> None:
    """Print groups of frames by their share of the impossible ones, the largest first."""
    groups: dict[str, list[FloatArray]] = defaultdict(list)
    for deed, figures in frames.items():
        groups[group(deed)].append(figures)
    joined = {name: np.concatenate(of) for name, of in groups.items()}
    every = np.concatenate(list(joined.values()))
    fast, tips = (max(int(n), 1) for n in _impossible(every))
    order = sorted(joined, key=lambda name: sum(_impossible(joined[name])), reverse=True)
    for name in order[:most]:
        level, carried, outside = joined[name].T
        own_fast, own_tips = _impossible(joined[name])
        by_root = np.count_nonzero((level > ACC_M_S2) & (carried > ACC_M_S2))
        outside = outside[~np.isnan(outside)]
        print(
            f"    {name:32s} {100.0 * len(level) / len(every):6.1f} %"
            f" {100.0 * own_fast / fast:10.1f} % {100.0 * by_root / max(own_fast, 1):6.0f} %"
            f" {_percentile(level, 99):7.1f}"
            f" {100.0 * own_tips / tips:11.1f} % {100.0 * _percentile(outside, 95):6.0f}"
        )


def _impossible(figures: FloatArray) -> tuple[int, int]:
    """Return how many frames are above each goal; NaN is above none."""
    return int(np.sum(figures[:, 0] > ACC_M_S2)), int(np.sum(figures[:, 2] > ZMP_M))


def _percentile(value: FloatArray, share: float) -> float:
    return float(np.percentile(value, share)) if len(value) else 0.0
