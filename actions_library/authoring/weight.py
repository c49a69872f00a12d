"""The weight: hips are moved so that the ground under the feet can carry the body.

An animator poses hips by eye. A body obeys its mass centre: whatever accelerates it is a push of
the ground, and this acts in the zero moment point [1]_, under the soles. Here the hips' way is
corrected as little as possible until that point is nearly there, as a dynamics filter does [2]_:
the mass moves over the standing foot before the other one leaves, and back before a quick stop.
In the air the mass centre goes on as it left, and falls.

References
----------
.. [1] M. Vukobratović and B. Borovac, "Zero-Moment Point: thirty-five years of its life",
   Int. J. Humanoid Robotics 1, 2004.
.. [2] K. Yamane and Y. Nakamura, "Dynamics Filter: concept and implementation of on-line motion
   generator for human figures", IEEE Trans. Robotics and Automation 19, 2003.
.. [3] A. Beck and M. Teboulle, "A Fast Iterative Shrinkage-Thresholding Algorithm for Linear
   Inverse Problems", SIAM J. Imaging Sciences 2, 2009: steps that go on as they went.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.mass import GRAVITY_M_S2
from actions_library.authoring.support import SupportArea
from smd.geometry.arrays import BoolArray, FloatArray, IntArray

STEADIEST_M_S2 = 6.0
"""Acceleration of the mass centre over the ground above which it is brought down."""

FOLLOWS = 0.85
"""By how much of the hips' way the mass centre goes along while the feet stay."""

BEYOND_M = 0.10
"""How far outside the soles the zero moment point may be. A mass centre does not turn as a body
does: of real movement, too, it is a little outside."""

_INNER = 0.85
"""Share of the soles' area over which a slow mass centre is sought."""

_SOFTEN_S = 0.025
"""Standard deviation of the Gaussian through which the mass centre's way is read."""

_LEAST, _SMOOTH, _OVER, _STEADY, _AIR = 0.02, 2e-9, 0.3, 4e-3, 1e-2
"""What the correction costs: its size (m²) and third derivative (m²/s⁶), the mass centre's own
distance from the soles (m²), too much acceleration (m²/s⁴), and any in the air; 1 is the cost of
a square metre between the zero moment point and the soles."""

_REACH = 20.0
"""What a square metre costs by which the hips are too high for the legs; as `_OVER`."""

_SLOW_M_S = 0.20
"""Speed of the mass centre from which on it need no longer be over the soles itself."""

_STEPS, _REACH_STEPS = 80, 8
_STANDS_S = 0.25
"""How long a clip that is no cycle stands before and after; nothing is moved there."""

_STILL = 3
"""Frames at either end of such a clip in which nothing is moved."""


@dataclass(frozen=True, slots=True, eq=False)
class CarriedBody:
    """A body and what carries it, over ``n`` frames.

    Attributes
    ----------
    centre_m : (n, 3) of mass.
    support : on the ground.
    free : (n,) bool, where more than soles carry: nothing is asked of the zero moment point.
    room_m : (n,) how far the hips may rise until a leg is straight; below 0 where they must sink.
    rate_hz : frames a second.
    cyclic : the last frame is the first one again, but for the travel.
    """

    centre_m: FloatArray
    support: SupportArea
    free: BoolArray
    room_m: FloatArray
    rate_hz: float
    cyclic: bool


def shift_of_hips(body: CarriedBody) -> FloatArray:
    """Return by how much to move the hips, ``(n, 3)``: left, up, ahead.

    Over the ground, what the zero moment point is more than `BEYOND_M` outside the soles, what a
    slow mass centre is beside them, and what exceeds `STEADIEST_M_S2` are minimised with the size
    of the correction. In the air only free fall is asked for. Upwards, free fall and the legs'
    reach are.
    """
    rows = _rows_of(body)
    shift = np.zeros((len(rows.frame), 3))
    shift[:, 1] = _upward(rows)
    shift[:, [0, 2]] = _aside(rows)
    own = np.arange(len(body.centre_m)) % len(rows.frame)
    return shift[own if body.cyclic else own + _stands(body)]


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """What is looked at, in ``m`` rows: one cycle, or the clip between two times of standing.

    Attributes
    ----------
    frame : (m,) of each.
    centre, speed, acceleration : (m, 3) of the mass, softened.
    support : of these rows.
    stands, air : (m, 1) 1 where soles alone carry, and where nothing does; else 0.
    room : (m,) see `CarriedBody`.
    moves : (m, k) from what may be moved to the rows.
    faster : (m, k) from what may be moved to the mass centre's acceleration.
    size : (k, k) what the correction itself costs.
    """

    frame: IntArray
    centre: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    support: SupportArea
    stands: FloatArray
    air: FloatArray
    room: FloatArray
    moves: FloatArray
    faster: FloatArray
    size: FloatArray


def _rows_of(body: CarriedBody) -> _Rows:
    frames, stands = len(body.centre_m), _stands(body)
    frame = np.arange(frames - 1)
    moves = np.eye(frames - 1)
    if not body.cyclic:
        frame = np.clip(np.arange(-stands, frames + stands), 0, frames - 1)
        moves = np.eye(len(frame))[:, stands + _STILL : stands + frames - _STILL]
    second = _second_derivative(len(frame), body)
    centre, speed, acceleration = _read(body, frame, second)
    carries, free = body.support.carries[frame], body.free[frame]
    bend = second @ moves
    rougher = (np.roll(bend, -1, axis=0) - bend) * body.rate_hz
    faster, air = FOLLOWS * bend, (~carries & ~free)[:, None].astype(float)
    size = _LEAST * np.eye(moves.shape[1]) + _SMOOTH * rougher.T @ rougher
    return _Rows(
        frame=frame,
        centre=centre,
        speed=speed,
        acceleration=acceleration,
        support=SupportArea(body.support.corner_m[frame], carries),
        stands=(carries & ~free)[:, None].astype(float),
        air=air,
        room=body.room_m[frame],
        moves=moves,
        faster=faster,
        size=size + faster.T @ (_AIR * air * faster),
    )


def _upward(rows: _Rows) -> FloatArray:
    """Return the hips' shift upwards, ``(m,)``: hips that are too high are brought down."""
    falls = rows.faster.T @ (_AIR * rows.air[:, 0] * (-GRAVITY_M_S2 - rows.acceleration[:, 1]))
    room = np.where(np.isfinite(rows.room), rows.room, 0.0)
    up = np.linalg.solve(rows.size, falls)
    for _ in range(_REACH_STEPS):
        high = _REACH * (rows.moves @ up > rows.room)[:, None] * rows.moves
        up = np.linalg.solve(rows.size + high.T @ rows.moves, falls + high.T @ room)
    return np.asarray(rows.moves @ up)


def _aside(rows: _Rows) -> FloatArray:
    """Return the hips' shift to the left and ahead, ``(m, 2)``.

    Each step is one of least squares, toward the nearest place at which nothing would cost.
    """
    centre, acceleration = rows.centre[:, [0, 2]], rows.acceleration[:, [0, 2]]
    pull = rows.centre[:, 1:2] / np.maximum(rows.acceleration[:, 1:2] + GRAVITY_M_S2, 1.0)
    along, faster = FOLLOWS * rows.moves, rows.faster
    further = along - pull * faster
    slow = 1.0 / (1.0 + (np.linalg.norm(rows.speed, axis=1, keepdims=True) / _SLOW_M_S) ** 4)
    over, inner = _OVER * rows.stands * slow, rows.support.shrunk(_INNER)
    floats = faster.T @ (_AIR * rows.air * -acceleration)

    cost = rows.size + further.T @ (rows.stands * further) + along.T @ (over * along)
    solve = np.linalg.inv(cost + _STEADY * faster.T @ faster)
    aside = last = np.zeros((rows.moves.shape[1], 2))
    for step in range(_STEPS):
        aside, last = aside + step / (step + 3.0) * (aside - last), aside  # hurried on [3]_
        moved, asked = along @ aside, acceleration + faster @ aside
        moment = centre + moved - pull * asked
        outside = rows.support.nearest_m(moment) - moment
        far = np.maximum(np.linalg.norm(outside, axis=1, keepdims=True), BEYOND_M)
        nearer = rows.stands * (outside * (1.0 - BEYOND_M / far) + further @ aside)
        above = over * (inner.nearest_m(centre + moved) - centre)
        much = np.maximum(np.linalg.norm(asked, axis=1, keepdims=True) / STEADIEST_M_S2, 1.0)
        slower = _STEADY * (asked / much - acceleration)
        aside = solve @ (further.T @ nearer + along.T @ above + faster.T @ slower + floats)
    return np.asarray(rows.moves @ aside)


def _stands(body: CarriedBody) -> int:
    """Return how many rows of standing come before the clip's first frame."""
    return 0 if body.cyclic else round(_STANDS_S * body.rate_hz)


def _read(
    body: CarriedBody, frame: IntArray, second: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the mass centre's softened way in the world, its velocity and acceleration."""
    from scipy.ndimage import gaussian_filter1d

    steady, travel = np.zeros((len(frame), 3)), np.zeros(3)
    if body.cyclic:
        travel = (body.centre_m[-1] - body.centre_m[0]) / len(frame)
        steady = np.arange(len(frame))[:, None] * travel
    mode = "wrap" if body.cyclic else "nearest"
    in_place = body.centre_m[frame] - steady
    way = gaussian_filter1d(in_place, _SOFTEN_S * body.rate_hz, axis=0, mode=mode)
    velocity = 0.5 * (np.roll(way, -1, axis=0) - np.roll(way, 1, axis=0)) + travel
    if not body.cyclic:
        velocity[[0, -1]] = 0.0
    return way + steady, velocity * body.rate_hz, second @ way


def _second_derivative(count: int, body: CarriedBody) -> FloatArray:
    """Return the matrix of second differences, round a cycle or 0 at the ends."""
    eye = np.eye(count)
    matrix = np.roll(eye, 1, axis=0) - 2.0 * eye + np.roll(eye, -1, axis=0)
    if not body.cyclic:
        matrix[[0, -1]] = 0.0
    return matrix * body.rate_hz**2
