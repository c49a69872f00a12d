"""Lever arm: from the tracker to the point about which a prop is turned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from laban import RigidMotion
from laban.frozen import Frozen
from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array
from smd.geometry.rotations import rotate

BLOCK_S = 2.0
"""Within a block the centre may drift at a constant velocity, and errors are correlated."""

FEWEST_BLOCKS = 6
"""A short recording gets shorter blocks: errors are estimated from the variation of blocks."""

LEAST_TURN_RAD = np.pi
"""Half a turn in all; with less, a hand's tremor and drift are as large as its rotation."""

LEAST_ACROSS = 0.2
"""Turning across the main axis must be this share of all turning (root mean square)."""

LARGEST_ERROR_M = 0.01
"""Largest standard error: a lever less precise than this is useless for a figurine of 17 cm."""

_ROUNDS = 30  # it settles in about ten
_SPREAD_OF_MEDIAN = 1.538  # median length of 3 normal components with deviation 1
_BISQUARE = 4.685  # Tukey's: 95 % efficient where errors are normal


@dataclass(frozen=True, slots=True, eq=False)
class LeverArm(Frozen):
    """Where a prop's centre is, seen from its tracker.

    Attributes
    ----------
    lever_m : (3,) from the tracker to the centre, along the tracker's axes.
    error_m : (3,) standard error of each component.
    residual_m_s : speed of the centre that turning does not explain, root mean square.
    tracker_wander_m, centre_wander_m : distance of tracker and centre from their mean place,
        root mean square: what compensating gains.
    turn_rad : how far the prop was turned, all told.
    """

    lever_m: FloatArray
    error_m: FloatArray
    residual_m_s: float
    tracker_wander_m: float
    centre_wander_m: float
    turn_rad: float

    def __post_init__(self) -> None:
        for name in ("lever_m", "error_m"):
            object.__setattr__(
                self, name, frozen_array(name, getattr(self, name), (3,), DoodleError)
            )


def estimate_lever(motions: Sequence[RigidMotion]) -> LeverArm:
    """Find the point of a prop that stays in place while the prop is turned.

    With orientation R and lever l the centre p + R l moves at v + R (w x l), w being the body's
    angular velocity. The lever is the one for which that is nothing but a drift, constant over
    blocks of `BLOCK_S`: a linear least-squares problem. It is solved again with weights (Tukey's
    bisquare [1]_) until moments at which the hand moved off no longer count. The standard error is
    the jackknife's, by how the lever moves when one block is left out [2]_ (to first order).

    Parameters
    ----------
    motions
        In each the prop is turned about its centre, about at least two axes. Where that place
        is may differ from one to the next.

    Raises
    ------
    DoodleError
        If the prop turns too little, or about one axis only (the component along it moves
        nothing), or the centre moves so much that the lever remains unknown.

    References
    ----------
    .. [1] A. Beaton, J. Tukey, "The Fitting of Power Series, Meaning Polynomials, Illustrated on
       Band-Spectroscopic Data", Technometrics 16(2), 1974.
    .. [2] B. Efron, C. Stein, "The Jackknife Estimate of Variance", Annals of Statistics 9(3),
       1981.
    """
    turn_rad = sum(_turn_rad(motion) for motion in motions)
    if turn_rad < LEAST_TURN_RAD:
        raise DoodleError(
            f"lever arm: expected turning of at least {np.degrees(LEAST_TURN_RAD):.0f} degrees in "
            f"all, got {np.degrees(turn_rad):.0f}"
        )
    turning = np.concatenate([motion.angular_velocity_rad_s for motion in motions])
    _require_two_axes(turning)
    orientation = np.concatenate([motion.orientation_xyzw for motion in motions])
    velocity = np.concatenate([motion.velocity_m_s for motion in motions])
    # Columns R (w x e_k): how fast a step along each axis of the tracker moves the centre.
    columns = [rotate(orientation, np.cross(turning, axis)) for axis in np.eye(3)]
    block = _blocks(motions)
    lever, error, residual = _robust_fit(np.stack(columns, axis=-1), -velocity, block)
    if error.max() > LARGEST_ERROR_M:
        raise DoodleError(
            f"lever arm: expected it to within {1000 * LARGEST_ERROR_M:.0f} mm, got "
            f"{1000 * error.max():.0f} mm along {'xyz'[int(np.argmax(error))]}: the centre was not "
            "held in place; turn further and faster, in one place"
        )
    return LeverArm(
        lever_m=lever,
        error_m=error,
        residual_m_s=float(np.sqrt(np.mean(np.sum(residual**2, axis=-1)))),
        tracker_wander_m=_wander_m(motions, np.zeros(3)),
        centre_wander_m=_wander_m(motions, lever),
        turn_rad=turn_rad,
    )


def _turn_rad(motion: RigidMotion) -> float:
    """Return the angle turned, all told."""
    step_s = (motion.time_s[-1] - motion.time_s[0]) / max(len(motion) - 1, 1)
    return float(np.linalg.norm(motion.angular_velocity_rad_s, axis=-1).sum() * step_s)


def _require_two_axes(turning: FloatArray) -> None:
    """Raise where the prop turns about one axis only, naming it."""
    # Turning about axis n moves nothing along n: information on a direction is turning across it.
    share, axes = np.linalg.eigh(turning.T @ turning)
    across = float(np.sqrt(max(share[0] + share[1], 0.0) / share.sum()))
    if across < LEAST_ACROSS:
        axis = axes[:, 2] * np.sign(axes[np.argmax(np.abs(axes[:, 2])), 2])
        named = ", ".join(f"{value:.2f}" for value in axis + 0.0)
        raise DoodleError(
            f"lever arm: expected turning about two axes, got one, ({named}) in the tracker's "
            f"frame: along it, mostly {'xyz'[int(np.argmax(np.abs(axis)))]}, the lever cannot be "
            "seen; nod or roll the prop as well"
        )


def _blocks(motions: Sequence[RigidMotion]) -> IntArray:
    """Return the number of each sample's block; no block reaches over two motions."""
    whole_s = sum(float(motion.time_s[-1] - motion.time_s[0]) for motion in motions)
    block_s = min(BLOCK_S, whole_s / FEWEST_BLOCKS)
    blocks, first = [], 0
    for motion in motions:
        own = first + ((motion.time_s - motion.time_s[0]) / block_s).astype(np.int64)
        blocks.append(own)
        first = int(own[-1]) + 1
    return np.concatenate(blocks)


def _robust_fit(
    columns: FloatArray, target: FloatArray, block: IntArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Solve ``columns (n, 3, 3) @ lever = target (n, 3) + drift of the block``.

    Returns the lever, its standard errors and the residuals ``(n, 3)``.
    """
    weight = np.ones(len(target))
    for _ in range(_ROUNDS):
        a, b = (_less_block_mean(values, weight, block) for values in (columns, target))
        normal = np.einsum("nik,nil,n->kl", a, a, weight)
        lever = np.linalg.solve(normal, np.einsum("nik,ni,n->k", a, b, weight))
        residual = b - a @ lever
        length = np.linalg.norm(residual, axis=-1)
        # + 1e-9: exact data leave nothing to scale by.
        scale = np.median(length) / _SPREAD_OF_MEDIAN + 1e-9
        before, weight = weight, np.maximum(1.0 - (length / (_BISQUARE * scale)) ** 2, 0.0) ** 2
        if np.abs(weight - before).max() < 1e-6:
            break
    # How the pull of each sample changes with the lever: the weight falls as the residual grows.
    limit = _BISQUARE * scale
    falling = 4.0 * np.sqrt(weight) / limit**2
    pulled = np.einsum("nik,ni->nk", a, residual)
    blocks = block[-1] + 1
    slopes, pulls = np.zeros((blocks, 3, 3)), np.zeros((blocks, 3))
    slope = np.einsum("nik,nil,n->nkl", a, a, weight)
    slope -= np.einsum("nk,nl,n->nkl", pulled, pulled, falling)
    np.add.at(slopes, block, slope)
    np.add.at(pulls, block, pulled * weight[:, None])
    moved = np.linalg.solve(slopes.sum(axis=0) - slopes, -pulls[..., None])[..., 0]
    error = np.sqrt((blocks - 1) * np.mean((moved - moved.mean(axis=0)) ** 2, axis=0))
    return lever, error, residual


def _less_block_mean(values: FloatArray, weight: FloatArray, block: IntArray) -> FloatArray:
    """Return ``values (n, …)`` less their weighted mean over each block."""
    total = np.zeros((block[-1] + 1, *values.shape[1:]))
    spread_weight = weight.reshape(-1, *(1,) * (values.ndim - 1))
    np.add.at(total, block, values * spread_weight)
    count = np.bincount(block, weight).reshape(-1, *(1,) * (values.ndim - 1))
    return values - (total / np.maximum(count, 1e-12))[block]


def _wander_m(motions: Sequence[RigidMotion], lever_m: FloatArray) -> float:
    """Return how far a point of the prop is from its mean place, root mean square."""
    squares = []
    for motion in motions:
        place = motion.position_m + rotate(motion.orientation_xyzw, lever_m)
        squares.append(np.sum((place - place.mean(axis=0)) ** 2, axis=-1))
    return float(np.sqrt(np.concatenate(squares).mean()))
