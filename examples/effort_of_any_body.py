"""Read the Effort of any rigid body's movement, with ``laban`` alone.

``laban`` needs no recording, library or ``smd``: it takes a body's pose over time with three
derivatives, from a tracker, a simulation or a robot's controller. Here a body goes 20 cm ahead,
tipping over, in 0.3 to 1.6 s. Each movement is read against all of them, as one performer's. Prints
Time from sustained (-1) to sudden (+1), and the other axes; no files are written.
"""

import numpy as np
from numpy.polynomial import Polynomial

from laban import AXES, RigidMotion, load_effort_model, own_measure, read_effort

RATE_HZ, AHEAD_M, TIP_RAD = 60.0, 0.2, 0.3
COURSE = Polynomial([0, 0, 0, 0, 35, -84, 70, -20])  # 0 to 1; at rest to the third derivative


def stroke(seconds: float) -> RigidMotion:
    """Return a movement with its derivatives, which a polynomial tells exactly."""
    time_s = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    courses = [COURSE] + [COURSE.deriv(order) for order in (1, 2, 3)]
    done = [course(time_s / seconds) / seconds**k for k, course in enumerate(courses)]
    ahead = [AHEAD_M * each[:, None] * [0.0, 0.0, 1.0] for each in done]
    tipped = [TIP_RAD * each[:, None] * [1.0, 0.0, 0.0] for each in done]  # about +X
    half, zero = 0.5 * tipped[0][:, 0], np.zeros_like(time_s)
    orientation_xyzw = np.stack([np.sin(half), zero, zero, np.cos(half)], axis=-1)
    return RigidMotion(time_s, ahead[0], orientation_xyzw, *ahead[1:], *tipped[1:])


model = load_effort_model()
durations_s = (0.3, 0.4, 0.6, 0.8, 1.2, 1.6)
own = own_measure([stroke(seconds) for seconds in durations_s])  # None reads it against nobody's
for seconds in durations_s:
    effort = read_effort(stroke(seconds), model, own)
    print(f"{seconds} s:", ", ".join(f"{axis} {getattr(effort, axis):+.2f}" for axis in AXES))
