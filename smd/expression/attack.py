"""Attack: within its step, a sudden foot comes forward at once, a sustained one evenly (Time).

A gait's cycle is the doodle's, and a foot that stands is the ground's. What is left to Time is how
a foot gets from one stand to the next, and how trunk and arms get through the step.
"""

from __future__ import annotations

import numpy as np

from smd.character.clip import Clip
from smd.character.poses import Poses
from smd.character.skeleton import Skeleton
from smd.expression.body import Body
from smd.expression.operators import at_frames
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import normalized, sign_continuous
from smd.geometry.runs import runs_of_true

ATTACK, LINGER = 3.0, 2.0
"""How far ahead of its own time a sudden step is, and how much evener a sustained one. With twice
as much, a sudden one would come to a stand on its way; and one that swings as a cosine does gets no
evener than with 2, where its greatest speed is 0.83 times its own."""


def attacked(u: FloatArray, time: FloatArray | float) -> FloatArray:
    """Return which moment of a step to show at each, both from 0 to 1; its ends keep their pace.

    Sudden: quick at first, then slow. Sustained: quicker at both ends and slower in the middle,
    where a step is at its quickest.
    """
    bell = (u * (1.0 - u)) ** 2
    return u + time * bell * np.where(np.asarray(time) >= 0.0, ATTACK, LINGER * (2.0 * u - 1.0))


def with_attack(poses: Poses, time: FloatArray, clip: Clip, body: Body) -> Poses:
    """Return a stack of cycles whose steps have the attack of an Effort of Time ``(e,)``.

    Each leg's swing is retimed by itself, and trunk and arms from one foot's touchdown to the
    next one's. What stands, the pelvis and the ground root stay; what never touches the ground
    does not step, and stays as it is.

    Parameters
    ----------
    clip
        Whose poses they are, changed or not: it says when each foot stands.
    """
    last = len(clip) - 1
    stands = {
        effector.end: np.asarray(clip.contacts[:-1, columns].any(axis=1))
        for effector in body.effectors
        if effector.is_leg and (columns := _columns(clip, effector.beyond))
    }
    downs = sorted({down % last for stand in stands.values() for _, down in _swings(stand)})
    if not downs:
        return poses
    rotation = sign_continuous(poses.rotation_xyzw)
    for effector in body.effectors:
        if effector.end in stands:
            leg = [effector.base, *_between(clip.skeleton, effector.base, effector.beyond)]
            source = _retimed(last, _swings(stands[effector.end]), time)
            rotation[:, :, leg] = normalized(at_frames(rotation[:, :, leg], source))
    steps = [
        (down, after + last * (after <= down))
        for down, after in zip(downs, [*downs[1:], downs[0]], strict=True)
    ]
    upper, source = list(body.upper), _retimed(last, steps, time)
    rotation[:, :, upper] = normalized(at_frames(rotation[:, :, upper], source))
    return Poses(rotation, poses.translation_m)


def _columns(clip: Clip, joints: frozenset[int]) -> list[int]:
    """Return which columns of a clip's contacts are those of some joints."""
    index = clip.skeleton.index
    return [i for i, name in enumerate(clip.contact_joints) if index(name) in joints]


def _between(skeleton: Skeleton, base: int, beyond: frozenset[int]) -> list[int]:
    """Return a limb's joints after its base, and what hangs from its end."""
    joints, joint = set(beyond), int(skeleton.parents[min(beyond)])
    while joint != base:
        joints.add(joint)
        joint = int(skeleton.parents[joint])
    return sorted(joints)


def _swings(stand: BoolArray) -> list[tuple[int, int]]:
    """Return the last frame of each stand and the first of the next; that may be a cycle later."""
    n = len(stand)
    if stand.all() or not stand.any():
        return []
    begins = int(np.flatnonzero(stand)[0])
    runs = runs_of_true(~np.roll(stand, -begins)).tolist()
    return [
        ((start - 1 + begins) % n, (start - 1 + begins) % n + end - start + 1)
        for start, end in runs
    ]


def _retimed(last: int, stretches: list[tuple[int, int]], time: FloatArray) -> FloatArray:
    """Return which frame of a cycle of ``last`` steps to show at each ``(last + 1, e)``."""
    source = np.repeat(np.arange(last + 1, dtype=np.float64)[:, None], len(time), axis=1)
    for start, end in stretches:
        at = np.arange(start, end + 1)
        u = (at - start) / (end - start)
        source[at % last] = start + (end - start) * attacked(u[:, None], time)
    source[:-1] %= last
    source[-1] = source[0]
    return source
