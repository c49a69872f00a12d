"""Effort read back from what was played: `python -m benchmarks.expression`.

Each action that is played once is acted in its own time with Time and Weight from -1 to 1, and
with Space and Flow. The hand that moves most, and the pelvis, are described as if each were a prop
a tenth as large as the character. Two readers read them:

- ``others``: Laban's logistic regression of everything, learned from the *other* actions, each
  action's descriptions beside the mean of its own: whether what Effort does to one action can be
  told from what it does to others.
- ``shipped``: the model that reads doodles, as it is.

A pair of performances that differ by 0.5 or more on one axis, all else equal, is in order if what
is read differs the same way; it is mistaken if more is read to have changed on the other axis of
the two.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations, product

import numpy as np

from actions_library.folder import load_library
from laban import Effort, EffortModel, load_effort_model
from laban.description import DESCRIPTION_NAMES, FAMILIES, describe
from laban.linear import fit_linear
from laban.model import effort_of
from laban.stillness import is_readable
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.doodle import Doodle
from smd.expression.body import body_of
from smd.expression.expressive import expressive
from smd.expression.study import study_of
from smd.geometry.arrays import FloatArray
from smd.smoothing import smooth

VALUES = (-1.0, -0.5, 0.0, 0.5, 1.0)
LEAST = 0.5
FIGURINE = 0.1
PAIRS_OF_AXES = (("time", "weight"), ("space", "flow"))
PARTS = ("hand", "pelvis")

State = tuple[float, float]
Descriptions = dict[tuple[str, State], dict[str, FloatArray]]
"""By action and what was played on two axes: of each part that moves."""
Odds = Mapping[tuple[str, State], FloatArray]
"""What was read: log odds of both axes, ``(2,)``."""

_EVERYTHING = [DESCRIPTION_NAMES.index(name) for name in FAMILIES["everything"]]


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


def played_descriptions(axes: tuple[str, str]) -> Descriptions:
    """Play every action that is played once in all states of two axes, and describe it."""
    library = load_library()
    body = body_of(library.clip("idle"))
    found: Descriptions = {}
    for action in library.actions:
        neutral = library.clip(action.name)
        if neutral.cyclic:
            continue
        joints, study = joints_of(neutral), study_of(neutral, body)
        for state in product(VALUES, VALUES):
            effort = Effort(**dict(zip(axes, state, strict=True)))
            clip = expressive(study, effort, travels=action.travels)
            motions = {part: smooth(prop_of(clip, joint)) for part, joint in joints.items()}
            found[action.name, state] = {
                part: describe(motion) for part, motion in motions.items() if is_readable(motion)
            }
    return found


def read_by_others(descriptions: Descriptions, parts: tuple[str, ...]) -> Odds:
    """Read each action by a reader that has learned from all others."""
    keys = [key for key, found in descriptions.items() if all(part in found for part in parts)]
    seen = np.array(
        [np.concatenate([descriptions[key][part][_EVERYTHING] for part in parts]) for key in keys]
    )
    whose = np.array([name for name, _ in keys])
    states = np.array([state for _, state in keys])
    for name in np.unique(whose):
        seen[whose == name] -= seen[whose == name].mean(axis=0)
    odds = np.zeros((len(keys), 2))
    for name in np.unique(whose):
        asked = whose == name
        for i in range(2):
            known = ~asked & (states[:, i] != 0.0)
            low, high = seen[known].min(axis=0), seen[known].max(axis=0)
            reader = fit_linear(seen[known], states[known, i] > 0.0)
            odds[asked, i] = reader.log_odds(np.clip(seen[asked], low, high))
    return dict(zip(keys, odds, strict=True))


def read_as_doodles(
    descriptions: Descriptions, parts: tuple[str, ...], axes: tuple[str, str], model: EffortModel
) -> Odds:
    """Read by the shipped model; the mean of the parts' log odds."""
    odds = {}
    for key, found in descriptions.items():
        read = [effort_of(found[part], model) for part in parts if part in found]
        if len(read) == len(parts):
            values = np.array([[getattr(one, axis) for axis in axes] for one in read])
            odds[key] = np.arctanh(np.clip(values, -0.999, 0.999)).mean(axis=0)
    return odds


def ordered(odds: Odds) -> Iterator[tuple[int, bool, bool]]:
    """Yield of each pair which axis differs, whether it is in order, and whether mistaken."""
    for (name, one), (other_name, other) in combinations(odds, 2):
        for i in range(2):
            change = other[i] - one[i]
            if name != other_name or one[1 - i] != other[1 - i] or abs(change) < LEAST:
                continue
            read = odds[name, other] - odds[name, one]
            yield i, read[i] * change > 0.0, abs(read[1 - i]) > abs(read[i])


def main() -> None:
    """Print the shares of pairs in order and of those mistaken, by reader, axis and part."""
    model = load_effort_model()
    for axes in PAIRS_OF_AXES:
        descriptions = played_descriptions(axes)
        for parts in (("hand",), ("pelvis",), PARTS):
            readers = {
                "others": read_by_others(descriptions, parts),
                "shipped": read_as_doodles(descriptions, parts, axes, model),
            }
            for reader, read in readers.items():
                pairs = np.array(list(ordered(read)))
                for i, axis in enumerate(axes):
                    right, wrong = 100.0 * pairs[pairs[:, 0] == i, 1:].mean(axis=0)
                    print(
                        f"{axis:6} {reader:7} {' and '.join(parts):15}: {right:5.1f} % of "
                        f"{np.sum(pairs[:, 0] == i)} pairs in order, {wrong:.1f} % mistaken for "
                        f"{axes[1 - i]}"
                    )


if __name__ == "__main__":
    main()
