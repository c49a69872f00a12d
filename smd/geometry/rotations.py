"""Unit quaternions in xyzw order, over any leading axes.

Rotations are active and act on column vectors: ``rotate(a_from_b, v_in_b)`` is ``v_in_a``, and
``multiply(a_from_b, b_from_c)`` is ``a_from_c``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray

IDENTITY_XYZW = np.array([0.0, 0.0, 0.0, 1.0])
IDENTITY_XYZW.flags.writeable = False


def normalized(vector: ArrayLike) -> FloatArray:
    """Return vectors scaled to unit length along the last axis; zero stays zero."""
    vector = np.asarray(vector, dtype=np.float64)
    # einsum, since np.linalg.norm takes three times as long on short vectors.
    length = np.sqrt(np.einsum("...i,...i->...", vector, vector))[..., None]
    if (length > 0).all():
        return vector / length
    return np.divide(vector, length, out=np.zeros_like(vector), where=length > 0)


def multiply(a_xyzw: ArrayLike, b_xyzw: ArrayLike) -> FloatArray:
    """Return the Hamilton product: first ``b``, then ``a``."""
    a, b = np.asarray(a_xyzw, dtype=np.float64), np.asarray(b_xyzw, dtype=np.float64)
    ax, ay, az, aw = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    bx, by, bz, bw = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    # Component by component, since np.cross takes two to five times as long; and each in place,
    # since allocating sums takes as long as adding.
    x, y, z, w = aw * bx, aw * by, aw * bz, aw * bw
    x += ax * bw
    x += ay * bz
    x -= az * by
    y += ay * bw
    y += az * bx
    y -= ax * bz
    z += az * bw
    z += ax * by
    z -= ay * bx
    w -= ax * bx
    w -= ay * by
    w -= az * bz
    product = np.empty((*np.shape(w), 4))
    product[..., 0], product[..., 1], product[..., 2], product[..., 3] = x, y, z, w
    return product


def inverse(q_xyzw: ArrayLike) -> FloatArray:
    """Return the inverse of unit quaternions."""
    return np.asarray(q_xyzw, dtype=np.float64) * np.array([-1.0, -1.0, -1.0, 1.0])


def rotate(q_xyzw: ArrayLike, vector: ArrayLike) -> FloatArray:
    """Turn vectors ``(..., 3)`` by unit quaternions ``(..., 4)``."""
    q, v = np.asarray(q_xyzw, dtype=np.float64), np.asarray(vector, dtype=np.float64)
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    vx, vy, vz = v[..., 0], v[..., 1], v[..., 2]
    # v + 2 w (u × v) + 2 u × (u × v), u being (x, y, z); np.cross takes twice as long and more.
    tx, ty, tz = y * vz, z * vx, x * vy
    tx -= z * vy
    ty -= x * vz
    tz -= y * vx
    tx *= 2.0
    ty *= 2.0
    tz *= 2.0
    rx, ry, rz = w * tx, w * ty, w * tz
    rx += vx
    rx += y * tz
    rx -= z * ty
    ry += vy
    ry += z * tx
    ry -= x * tz
    rz += vz
    rz += x * ty
    rz -= y * tx
    turned = np.empty((*np.shape(rx), 3))
    turned[..., 0], turned[..., 1], turned[..., 2] = rx, ry, rz
    return turned


def rotvec_from_quaternion(q_xyzw: ArrayLike) -> FloatArray:
    """Return rotation vectors (axis times angle in [0, pi], radians)."""
    q = np.asarray(q_xyzw, dtype=np.float64)
    q = np.where(q[..., 3:] < 0, -q, q)
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., 3:])
    # sin(a/2)/a tends to 1/2: the quotient is safe until the sine underflows.
    factor = np.divide(angle, sine, out=np.full_like(sine, 2.0), where=sine > 1e-12)
    return q[..., :3] * factor


def quaternion_from_rotvec(rotvec_rad: ArrayLike) -> FloatArray:
    """Return unit quaternions of rotation vectors (axis times angle, radians)."""
    r = np.asarray(rotvec_rad, dtype=np.float64)
    half = 0.5 * np.linalg.norm(r, axis=-1, keepdims=True)
    return np.concatenate([0.5 * np.sinc(half / np.pi) * r, np.cos(half)], axis=-1)


def quaternion_about(axis: ArrayLike, angle_rad: ArrayLike) -> FloatArray:
    """Return unit quaternions turning by ``angle_rad`` about ``axis`` (any length but zero)."""
    angle = np.asarray(angle_rad, dtype=np.float64)[..., None]
    return quaternion_from_rotvec(normalized(axis) * angle)


def quaternion_between(start: ArrayLike, end: ArrayLike) -> FloatArray:
    """Return the shortest turn that takes direction ``start`` to direction ``end``."""
    a, b = np.broadcast_arrays(normalized(start), normalized(end))
    cosine = np.sum(a * b, axis=-1, keepdims=True)
    q = np.concatenate([np.cross(a, b), 1.0 + cosine], axis=-1)
    # Opposite directions: half a turn about any axis across them.
    spare = np.where(np.abs(a[..., :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    across = np.concatenate([normalized(np.cross(a, spare)), np.zeros_like(cosine)], axis=-1)
    return np.where(1.0 + cosine < 1e-12, across, normalized(q))


def sign_continuous(q_xyzw: ArrayLike) -> FloatArray:
    """Flip signs along the first axis so that neighbours lie in one hemisphere."""
    q = np.array(q_xyzw, dtype=np.float64)
    apart = np.einsum("...i,...i->...", q[1:], q[:-1]) < 0
    if apart.any():
        q[1:] *= np.cumprod(np.where(apart, -1.0, 1.0), axis=0)[..., None]
    return q


def slerp(a_xyzw: ArrayLike, b_xyzw: ArrayLike, fraction: ArrayLike) -> FloatArray:
    """Turn from ``a`` to ``b`` at constant angular speed along the shorter arc [1]_.

    References
    ----------
    .. [1] K. Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985.
    """
    a = np.asarray(a_xyzw, dtype=np.float64)
    fraction = np.asarray(fraction, dtype=np.float64)[..., None]
    difference = rotvec_from_quaternion(multiply(inverse(a), b_xyzw))
    return multiply(a, quaternion_from_rotvec(fraction * difference))


def matrix_from_quaternion(q_xyzw: ArrayLike) -> FloatArray:
    """Return rotation matrices ``(..., 3, 3)`` that act on column vectors."""
    q = np.asarray(q_xyzw, dtype=np.float64)
    x, y, z, w = (q[..., i] for i in range(4))
    xx, yy, zz = 2.0 * x * x, 2.0 * y * y, 2.0 * z * z
    xy, xz, yz = 2.0 * x * y, 2.0 * x * z, 2.0 * y * z
    wx, wy, wz = 2.0 * w * x, 2.0 * w * y, 2.0 * w * z
    matrix = np.empty((*q.shape[:-1], 3, 3))
    matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 0, 2] = 1.0 - yy - zz, xy - wz, xz + wy
    matrix[..., 1, 0], matrix[..., 1, 1], matrix[..., 1, 2] = xy + wz, 1.0 - xx - zz, yz - wx
    matrix[..., 2, 0], matrix[..., 2, 1], matrix[..., 2, 2] = xz - wy, yz + wx, 1.0 - xx - yy
    return matrix


def quaternion_from_euler(order: str, angles_rad: ArrayLike) -> FloatArray:
    """Return unit quaternions of Euler angles; ``order`` as in SciPy (capitals: intrinsic)."""
    from scipy.spatial.transform import Rotation

    angles = np.array(angles_rad, dtype=np.float64)
    flat = Rotation.from_euler(order, angles.reshape(-1, 3)).as_quat()
    return np.asarray(flat, dtype=np.float64).reshape(*angles.shape[:-1], 4)


def quaternion_from_matrix(matrix: ArrayLike) -> FloatArray:
    """Return unit quaternions ``(..., 4)`` of rotation matrices ``(..., 3, 3)``."""
    from scipy.spatial.transform import Rotation

    matrix = np.array(matrix, dtype=np.float64)
    flat = Rotation.from_matrix(matrix.reshape(-1, 3, 3)).as_quat()
    return np.asarray(flat, dtype=np.float64).reshape(*matrix.shape[:-2], 4)


def heading_rad(q_xyzw: ArrayLike) -> FloatArray:
    """Return the angle about +Y from +Z to the turned +Z, seen from above, in (-pi, pi].

    A front that points straight up or down has the heading of the frame's -Y or +Y instead.
    """
    q = np.asarray(q_xyzw, dtype=np.float64)
    front = rotate(q, np.broadcast_to([0.0, 0.0, 1.0], (*q.shape[:-1], 3)))
    up = rotate(q, np.broadcast_to([0.0, 1.0, 0.0], (*q.shape[:-1], 3)))
    level = np.hypot(front[..., 0], front[..., 2]) > 1e-6
    stand_in = np.where(front[..., 1:2] > 0, -up, up)
    flat = np.where(level[..., None], front, stand_in)
    return np.arctan2(flat[..., 0], flat[..., 2])
