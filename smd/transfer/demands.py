"""Demands: warnings where a doodle demands more than a body can do, or a clip was made for.

The phrase is played all the same, at the times of the Score.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from smd.acting.move import Move
from smd.transfer.gait import LONGEST_STRIDE
from smd.transfer.repertoire import Piece
from smd.transfer.travelling import NOWHERE_M

FASTEST_PLAYED = 3.0
"""Multiple of a clip's own pace beyond which there is a warning."""

SEEN = 0.5
"""Blend weight from which a gait's steps count: a pause that is stood through has none."""


def demands(device: str, moves: Sequence[Move[Piece]]) -> Iterator[str]:
    """Yield a line for each action of which a performer's doodle demands too much, in order.

    Each names the first phrase's time and the greatest demand.
    """
    hurried: dict[str, list[tuple[float, float]]] = {}
    stretched: dict[str, list[tuple[float, float]]] = {}
    still: dict[str, list[tuple[float, float]]] = {}
    pressed: dict[str, list[tuple[float, float]]] = {}
    for move in moves:
        if not move.idles and (pace := fastest_pace(move)) > FASTEST_PLAYED:
            pressed.setdefault(move.piece.clip.name, []).append((move.start_s, pace))
        if not move.piece.travels or move.idles:
            continue
        name, gait = move.piece.clip.name, move.piece.gait
        way_m = way_of(move)
        if way_m <= NOWHERE_M:
            still.setdefault(name, []).append((move.start_s, way_m))
        elif gait is not None and gait.passings:
            if (cadence := steps_per_min(move)) > gait.most_steps_per_min:
                hurried.setdefault(name, []).append((move.start_s, cadence))
            # + 1e-6: a stride of exactly that is allowed.
            if (stretch := stride_ratio(move)) > LONGEST_STRIDE + 1e-6:
                stretched.setdefault(name, []).append((move.start_s, stretch))
    for name, found in pressed.items():
        yield (
            f"device {device!r}: {name} at {found[0][0]:.2f} s: expected up to "
            f"{FASTEST_PLAYED:.0f} times its clip's pace, the phrase asks for "
            f"{max(pace for _, pace in found):.1f}{_more(found)}"
        )
    limits = {move.piece.clip.name: move.piece.gait for move in moves}
    for name, found in hurried.items():
        gait = limits[name]
        assert gait is not None
        yield (
            f"device {device!r}: {name} at {found[0][0]:.2f} s: expected up to "
            f"{gait.most_steps_per_min:.0f} steps a minute, the doodle asks for "
            f"{max(cadence for _, cadence in found):.0f}{_more(found)}"
        )
    for name, found in stretched.items():
        yield (
            f"device {device!r}: {name} at {found[0][0]:.2f} s: expected strides up to "
            f"{LONGEST_STRIDE:.2f} times the clip's, the doodle asks for "
            f"{max(stretch for _, stretch in found):.2f}{_more(found)}"
        )
    for name, found in still.items():
        yield (
            f"device {device!r}: {name} at {found[0][0]:.2f} s: expected a way of "
            f"{NOWHERE_M:.2f} m on the stage, found {max(way_m for _, way_m in found):.2f} m; "
            f"it is done on the spot{_more(found)}"
        )


def fastest_pace(move: Move[Piece]) -> float:
    """Return the greatest pace of a clip, as a multiple of its own; 0 for a cycle."""
    if move.piece.clip.cyclic:
        return 0.0
    pace_hz = np.diff(move.frame) / np.diff(move.time_s)
    return float(pace_hz.max(initial=0.0) / move.piece.clip.rate_hz)


def way_of(move: Move[Piece]) -> float:
    """Return the length of a move's path over the ground, in metres."""
    return float(np.linalg.norm(np.diff(move.root_m, axis=0), axis=-1).sum())


def steps_per_min(move: Move[Piece]) -> float:
    """Return a gait's steps a minute while it is seen."""
    assert move.piece.gait is not None
    seen = 0.5 * (move.presence[1:] + move.presence[:-1]) >= SEEN
    lasting_s = np.diff(move.time_s)[seen].sum()
    cycles = np.diff(move.frame)[seen].sum() / move.piece.last_frame
    return float(60.0 * cycles * len(move.piece.gait.passings) / max(lasting_s, 1e-9))


def stride_ratio(move: Move[Piece]) -> float:
    """Return a gait's mean stride over its clip's."""
    assert move.piece.gait is not None
    cycles = (move.frame[-1] - move.frame[0]) / move.piece.last_frame
    return way_of(move) / max(cycles, 1e-9) / move.piece.gait.stride_m


def _more(found: Sequence[object]) -> str:
    return f" (the most of {len(found)} phrases)" if len(found) > 1 else ""
