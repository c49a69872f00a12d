from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from laban import RigidMotion


@pytest.fixture(scope="session")
def motion_of() -> Callable[..., RigidMotion]:
    """Make a motion from the closed forms of a path and its three derivatives.

    ``path(t)`` returns four ``(n, 3)`` arrays; ``turning(t)`` an orientation and the body's
    angular velocity, acceleration and jerk.
    """

    def make(path, turning=None, *, duration_s=2.0, rate_hz=60.0):
        t = np.arange(round(duration_s * rate_hz) + 1) / rate_hz
        if turning is None:
            still = np.zeros((len(t), 3))
            rotation = (np.tile([0.0, 0.0, 0.0, 1.0], (len(t), 1)), still, still, still)
        else:
            rotation = turning(t)
        position, *derivatives = path(t)
        return RigidMotion(t, position, rotation[0], *derivatives, *rotation[1:])

    return make


@pytest.fixture(scope="session")
def columns() -> Callable[..., np.ndarray]:
    """Stack scalars or ``(n,)`` arrays into ``(n, 3)``."""
    return lambda *parts: np.stack(np.broadcast_arrays(*parts), axis=-1).astype(float)


@pytest.fixture(scope="session")
def random_motion(motion_of) -> Callable[[np.random.Generator], RigidMotion]:
    """Make a smooth motion of random waves, whose derivatives are exact."""

    def make(rng, *, rate_hz=60.0, size_m=0.1, pace=1.0):
        rates = pace * rng.uniform(1.0, 6.0, (2, 3, 4))
        amplitudes = rng.uniform(-size_m, size_m, (2, 3, 4))
        phases = rng.uniform(0.0, 2 * np.pi, (2, 3, 4))

        def waves(t, i, order):
            angle = rates[i] * t[:, None, None] + phases[i] + 0.5 * np.pi * order
            return np.sum(amplitudes[i] * rates[i] ** order * np.sin(angle), axis=-1)

        def path(t):
            return [waves(t, 0, order) for order in range(4)]

        def turning(t):
            # Features take orientation and angular rates as they are: they need not agree.
            q = np.concatenate([waves(t, 1, 0) / size_m, np.ones((len(t), 1))], axis=1)
            q /= np.linalg.norm(q, axis=1, keepdims=True)
            return [q, *(10 * waves(t, 1, order) for order in range(1, 4))]

        return motion_of(path, turning, duration_s=2.0 / pace, rate_hz=rate_hz)

    return make
