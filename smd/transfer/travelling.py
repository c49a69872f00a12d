"""Moves along the doodle's path: gaits, flight and leaps."""

from __future__ import annotations

import numpy as np

from smd.acting.move import KNOT_RATE_HZ, Move, Placement, knots, nearest_turn
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import eased_clock, gaussian_smoothed, smootherstep
from smd.transfer.ground_root import EXECUTION, executed
from smd.transfer.pacing import Pacing
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Piece

NOWHERE_M = 0.05
"""Length up to which a path in the scene is none: less than a foot shifts while standing."""

SETTLING_S = 0.35
"""Time in which a gait accelerates at the start of its phrase and comes to rest at the end; never
more than a quarter of the phrase."""

FADING_S = 0.05
"""Smoothing of a gait's blend weight: a pause on the way does not begin abruptly."""

FULL_GAIT_SPEED = 0.4
"""Share of a gait's usual speed above which its blend weight is 1; below, it fades to standing."""

TAKE_OFF_S = 0.6
"""Time in which a clip that never touches the ground takes off, and lands; never more than a third
of the phrase."""

UPRIGHT_S = 1.1
"""Time in which a body gets from lying in the air to standing, where it is planned as a body can:
its greatest speed is 1.9 times the mean."""


def along_path(
    piece: Piece,
    path: GroundPath,
    start_s: float,
    end_s: float,
    at: Placement,
    *,
    phase: float | None = None,
    from_gait: bool = False,
    into_gait: bool = False,
    standing_s: float = 0.0,
) -> Move[Piece]:
    """Follow the path with a cyclic clip.

    A gait advances by the distance travelled, a clip that never touches the ground by time.

    Parameters
    ----------
    phase
        Where in its cycle the clip begins; by default where its feet pass.
    from_gait, into_gait
        Whether the phrase before ends, and the one after begins, in full gait along the same
        path, so that there is no coming to rest between them.
    standing_s
        Time that it takes at least to get from standing into the clip, and back.
    """
    gait = piece.gait
    if gait is None:
        raise ValueError(f"{piece.clip.name}: expected a cyclic clip that travels")
    time_s = knots(start_s, end_s)
    settling_s = _settling_s(path, time_s) if gait.passings else _take_off_s(time_s)
    clock_s = eased_clock(
        time_s, 0.0 if from_gait else settling_s[0], 0.0 if into_gait else settling_s[1]
    )
    over_ground = path.at(clock_s)
    steps = np.linalg.norm(np.diff(over_ground, axis=0), axis=-1)
    way_m = np.concatenate([[0.0], np.cumsum(steps)])
    even = (time_s - start_s) / (end_s - start_s)
    if gait.passings:
        share = way_m / way_m[-1] if way_m[-1] > NOWHERE_M else even
        cycles = gait.cycles_for(way_m[-1], end_s - start_s)
        presence = _speed_presence(
            time_s,
            way_m,
            gait.speed_m_s,
            standing_s,
            from_gait=from_gait,
            into_gait=into_gait,
        )
        first = gait.passings[0].phase if phase is None else phase
    else:
        share = even
        cycles = float(max(round((end_s - start_s) / gait.duration_s), 1))
        longest_s = UPRIGHT_S if standing_s > 0.0 else TAKE_OFF_S
        over_s = min(longest_s, (end_s - start_s) / 3.0)
        presence = _ends(time_s, over_s, from_same=from_gait, into_same=into_gait)
        first = 0.0 if phase is None else phase
    heading = path.heading_at(clock_s)
    return Move(
        piece=piece,
        start_s=start_s,
        end_s=end_s,
        time_s=time_s,
        root_m=at.position_m + over_ground - over_ground[0],
        heading_rad=heading + nearest_turn(heading[0], at.heading_rad) - heading[0],
        frame=(first + cycles * share) * piece.last_frame,
        presence=presence,
    )


def leap(
    piece: Piece,
    path: GroundPath,
    pacing: Pacing,
    end_s: float,
    at: Placement,
    *,
    run_up_s: float = 0.0,
) -> Move[Piece]:
    """Follow the path with a clip that is played once, such as a jump.

    The ground root follows the path, re-timed so that it moves during the clip's execution alone
    and as the clip's own does; it turns on the way as the prop did from start to end.

    Parameters
    ----------
    pacing
        When each frame is shown.
    end_s
        When the phrase ends, and the path with it: the body may come back after that.
    run_up_s
        Time in which it gathers speed before it flies, and loses it after; 0 to move as the clip.
    """
    start_s = pacing.start_s
    time_s = knots(start_s, pacing.end_s)
    frame = pacing.frame_at(time_s)
    if run_up_s > 0.0:
        share = _glided(time_s, frame, piece, run_up_s)
    else:
        share = np.interp(frame, np.arange(len(piece.clip)), executed(piece.clip, piece.root))
    phrase_s = knots(start_s, end_s)
    over_ground = path.at(phrase_s)
    way_m = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(over_ground, axis=0), axis=-1))]
    )
    if way_m[-1] > NOWHERE_M and not run_up_s:
        clock_s = np.interp(share * way_m[-1], way_m, phrase_s)
    else:
        clock_s = start_s + share * (end_s - start_s)
    first, last = path.heading_at(start_s), path.heading_at(end_s)
    return Move(
        piece=piece,
        start_s=start_s,
        end_s=pacing.end_s,
        time_s=time_s,
        root_m=at.position_m + path.at(clock_s) - over_ground[0],
        heading_rad=nearest_turn(float(first), at.heading_rad) + share * (last - first),
        frame=frame,
        presence=np.ones(len(time_s)),
        airborne=piece.airborne,
    )


def _glided(time_s: FloatArray, frame: FloatArray, piece: Piece, run_up_s: float) -> FloatArray:
    """Return the share of a planned path at each time: at an even speed in the air.

    What does not fly, such as a roll, goes as planned in its execution.
    """
    if piece.airborne is None:
        ends = piece.clip.stage_end_frames[EXECUTION - 1 : EXECUTION + 1].tolist()
        off_s, on_s = np.interp(ends, frame, time_s)
        return np.clip((time_s - off_s) / max(on_s - off_s, 1e-9), 0.0, 1.0)
    off_s, on_s = np.interp([piece.airborne.first, piece.airborne.last], frame, time_s)
    before_s = max(min(run_up_s, off_s - time_s[0]), 1e-3)
    after_s = max(min(run_up_s, time_s[-1] - on_s), 1e-3)
    speed = np.minimum(
        smootherstep((time_s - off_s + before_s) / before_s),
        smootherstep((on_s + after_s - time_s) / after_s),
    )
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time_s))])
    return np.asarray(way / way[-1])


def _settling_s(path: GroundPath, time_s: FloatArray) -> tuple[float, float]:
    """Return how long a gait takes to accelerate and to come to rest, where the prop does not.

    A phrase may begin or end while the prop is moving, since recognition cuts where the tokens
    change. The character passes the same positions, a little faster in between.
    """
    duration_s = time_s[-1] - time_s[0]
    step_s = min(1.0 / 60.0, 0.25 * duration_s)
    ends = np.array([time_s[0], time_s[0] + step_s, time_s[-1] - step_s, time_s[-1]])
    places = path.at(ends)
    first, last = np.linalg.norm(places[[1, 3]] - places[[0, 2]], axis=-1) / step_s
    mean = np.linalg.norm(np.diff(path.at(time_s), axis=0), axis=-1).sum() / duration_s
    most_s = min(SETTLING_S, 0.25 * duration_s)
    return tuple(most_s * float(min(speed / max(mean, 1e-9), 1.0)) for speed in (first, last))


def _take_off_s(time_s: FloatArray) -> tuple[float, float]:
    """Return how long a flight takes to take off, and to land."""
    over_s = min(TAKE_OFF_S, (time_s[-1] - time_s[0]) / 3.0)
    return over_s, over_s


def _speed_presence(
    time_s: FloatArray,
    way_m: FloatArray,
    usual_m_s: float,
    standing_s: float,
    *,
    from_gait: bool,
    into_gait: bool,
) -> FloatArray:
    """Return a gait's blend weight: 0 at rest, 1 from a share of its speed on."""
    duration_s = time_s[-1] - time_s[0]
    if way_m[-1] <= NOWHERE_M:
        return np.ones_like(time_s)
    speed = np.gradient(way_m, time_s)
    full = FULL_GAIT_SPEED * min(usual_m_s, way_m[-1] / duration_s)
    presence = gaussian_smoothed(smootherstep(speed / full), FADING_S * KNOT_RATE_HZ)
    settling_s = max(min(SETTLING_S, 0.25 * duration_s), min(standing_s, 0.4 * duration_s))
    return presence * _ends(time_s, settling_s, from_same=from_gait, into_same=into_gait)


def _ends(time_s: FloatArray, over_s: float, *, from_same: bool, into_same: bool) -> FloatArray:
    """Return 1, except for a rise from 0 at the start and a fall to 0 at the end, where wanted."""
    rise = np.ones_like(time_s) if from_same else smootherstep((time_s - time_s[0]) / over_s)
    fall = np.ones_like(time_s) if into_same else smootherstep((time_s[-1] - time_s) / over_s)
    return rise * fall
