"""Effort read back from what was played: `python -m benchmarks.expression`.

Each action that is played once is acted in its own time with Time and Weight from -1 to 1. The
hand that moves most, and the pelvis, are read as if each were a prop, a tenth as large as the
character, by the shipped reader. A pair of performances that differ by 0.5 or more on one axis,
all else equal, is in order if what is read differs the same way; it is mistaken if more is read to
have changed on the other axis.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from actions_library.folder import load_library
from laban import Effort, load_effort_model, read_effort
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.doodle import Doodle
from smd.smoothing import smooth
from smd.transfer.body import body_of
from smd.transfer.expression import expressive

VALUES = (-1.0, -0.5, 0.0, 0.5, 1.0)
LEAST = 0.5
FIGURINE = 0.1
AXES = ("time", "weight")
PARTS = ("hand", "pelvis")


def prop_of(clip: Clip, joint: int) -> Doodle:
    """Return a joint's movement as that of a prop."""
    rotation, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    time_s = np.arange(len(clip)) / clip.rate_hz
    return Doodle(time_s, FIGURINE * place[:, joint], rotation[:, joint])


def joints_of(clip: Clip) -> dict[str, int]:
    """Return the joints that are read: the hand that goes farther, and the pelvis."""
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    hands = [clip.skeleton.index(f"{side}_hand") for side in ("left", "right")]
    way = [np.linalg.norm(np.diff(place[:, j], axis=0), axis=-1).sum() for j in hands]
    return {"hand": hands[int(np.argmax(way))], "pelvis": clip.skeleton.index("hips")}


def readings() -> Iterator[tuple[str, dict[tuple[float, float], dict[str, Effort]]]]:
    """Yield each action with what is read of it, by the Time and Weight it was played with."""
    library, model = load_library(), load_effort_model()
    body = body_of(library.clip("idle"))
    for action in library.actions:
        neutral = library.clip(action.name)
        if neutral.cyclic:
            continue
        joints = joints_of(neutral)
        read: dict[tuple[float, float], dict[str, Effort]] = {}
        for time in VALUES:
            for weight in VALUES:
                effort = Effort(time=time, weight=weight)
                clip = expressive(neutral, effort, body, travels=action.travels)
                read[time, weight] = {
                    part: read_effort(smooth(prop_of(clip, joint)), model)
                    for part, joint in joints.items()
                }
        yield action.name, read


def main() -> None:
    """Print the shares of pairs in order and of those mistaken, by axis and part."""
    order = {(axis, part): [0, 0] for axis in AXES for part in PARTS}
    mistaken = {(axis, part): 0 for axis in AXES for part in PARTS}
    for name, read in readings():
        shown = []
        for i, axis in enumerate(AXES):
            right = {part: [0, 0] for part in PARTS}
            for one, other in combinations(read, 2):
                change = other[i] - one[i]
                if one[1 - i] != other[1 - i] or abs(change) < LEAST:
                    continue
                for part in PARTS:
                    before, after = read[one][part], read[other][part]
                    if before.time is None or after.time is None:  # it is at rest
                        continue
                    seen = {a: getattr(after, a) - getattr(before, a) for a in AXES}
                    order[axis, part][0] += seen[axis] * change > 0.0
                    order[axis, part][1] += 1
                    right[part][0] += seen[axis] * change > 0.0
                    right[part][1] += 1
                    mistaken[axis, part] += abs(seen[AXES[1 - i]]) > abs(seen[axis])
            shown += [f"{axis} {part} {100 * r / n:3.0f} %" for part, (r, n) in right.items() if n]
        print(f"  {name:12} {', '.join(shown)}")
    for (axis, part), (right_all, count) in order.items():
        wrong = 100.0 * mistaken[axis, part] / count
        print(
            f"{axis:6} {part:6}: {100.0 * right_all / count:5.1f} % of {count} pairs in order, "
            f"{wrong:.1f} % mistaken for the other axis"
        )


if __name__ == "__main__":
    main()
