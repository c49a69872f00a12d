"""Moves that stay where they are: idling, gestures and turns."""

from __future__ import annotations

import numpy as np

from smd.character.clip import Clip
from smd.transfer.easing import smootherstep
from smd.transfer.ground_root import ground_root, turned
from smd.transfer.move import Move, Placement, knots

TURNING_RAD = np.radians(15.0)
"""A clip whose ground root turns by more is a turn; a prop that turns by less has not turned."""

MOST_TURN_PER_PASS = 1.5
"""How many times its own angle a turning clip turns at most; beyond that it is played again."""

FACING_S = 0.6
"""Time in which an idling character turns to where its next phrase faces."""


def idling(
    clip: Clip, start_s: float, end_s: float, at: Placement, *, facing_rad: float, clock_s: float
) -> Move:
    """Stand where the last phrase ended, and face where the next one will at its start.

    Parameters
    ----------
    facing_rad
        Heading at the end; reached in the last `FACING_S`.
    clock_s
        Time at which the idle clip began: it goes on all the while, seen or not.
    """
    time_s = knots(start_s, end_s)
    facing_s = min(FACING_S, end_s - start_s)
    share = (
        smootherstep((time_s - end_s) / facing_s + 1.0) if facing_s > 0.0 else np.ones(len(time_s))
    )
    return Move(
        clip=clip,
        start_s=start_s,
        end_s=end_s,
        time_s=time_s,
        root_m=np.broadcast_to(at.position_m, (len(time_s), 2)),
        heading_rad=at.heading_rad + share * (facing_rad - at.heading_rad),
        frame=(time_s - clock_s) * clip.rate_hz,
        presence=np.ones(len(time_s)),
        idles=True,
    )


def gesture(clip: Clip, start_s: float, end_s: float, at: Placement) -> Move:
    """Play a clip on the spot, once, or as often as its own time allows if it is cyclic.

    The heading holds. A step that the clip itself takes is taken.
    """
    time_s = knots(start_s, end_s)
    share = (time_s - start_s) / (end_s - start_s)
    cycles = max(round((end_s - start_s) / clip.duration_s), 1) if clip.cyclic else 1
    frame = share * cycles * (len(clip) - 1)
    own_frame = np.mod(frame, len(clip) - 1) if clip.cyclic else frame
    step = turned(ground_root(clip).position_at(own_frame), at.heading_rad)
    return Move(
        clip=clip,
        start_s=start_s,
        end_s=end_s,
        time_s=time_s,
        root_m=at.position_m + step,
        heading_rad=np.full(len(time_s), at.heading_rad),
        frame=frame,
        presence=np.ones(len(time_s)),
    )


def turns(clip: Clip) -> bool:
    """Return whether a clip is a turn on the spot."""
    return abs(ground_root(clip).turn_rad) > TURNING_RAD


def turn_passes(clip: Clip, prop_turn_rad: float) -> tuple[float, ...]:
    """Return the angles of the passes of a turning clip that turn as far as the prop did.

    A large turn takes several passes. A prop that hardly turned, or turned the other way, leaves
    the clip its own angle: who asks for a turn to the left shall see one.
    """
    own_rad = ground_root(clip).turn_rad
    same_way = prop_turn_rad * own_rad > 0.0 and abs(prop_turn_rad) > TURNING_RAD
    whole_rad = prop_turn_rad if same_way else own_rad
    passes = max(int(np.ceil(abs(whole_rad / own_rad) / MOST_TURN_PER_PASS)), 1)
    return (whole_rad / passes,) * passes


def turn(clip: Clip, start_s: float, end_s: float, at: Placement, turn_rad: float) -> Move:
    """Turn by an angle, with the clip's own course of turning."""
    root = ground_root(clip)
    time_s = knots(start_s, end_s)
    frame = (time_s - start_s) / (end_s - start_s) * (len(clip) - 1)
    return Move(
        clip=clip,
        start_s=start_s,
        end_s=end_s,
        time_s=time_s,
        root_m=at.position_m + turned(root.position_at(frame), at.heading_rad),
        heading_rad=at.heading_rad + root.yaw_at(frame) / root.turn_rad * turn_rad,
        frame=frame,
        presence=np.ones(len(time_s)),
    )
