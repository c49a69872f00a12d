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

Then what every expression keeps, each axis alone from -1 to 1 in nine steps: by how much each
measure goes the wrong way from one step to the next, at most, of each action. And in all 81 states
of poles and neutral: how far a hand or foot is from where the neutral action is for, and the least
bend of any elbow or knee, over all actions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations, product

import numpy as np

from actions_library.folder import load_library
from actions_library.library import Library
from laban import Effort, EffortModel, load_effort_model
from laban.description import DESCRIPTION_NAMES, FAMILIES, describe
from laban.linear import fit_linear
from laban.model import effort_of
from laban.stillness import is_readable
from smd.character.clip import Clip
from smd.character.ik import limb_of
from smd.character.kinematics import forward_kinematics
from smd.character.roles import body_plan
from smd.doodle import Doodle
from smd.expression.body import body_of
from smd.expression.expressive import expressive
from smd.expression.study import Study, study_of
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, normalized, rotate
from smd.smoothing import smooth

NINE = tuple(np.linspace(-1.0, 1.0, 9).tolist())
ACTS_M = 0.3
"""How far a hand or foot goes, at least, that acts."""

AHEAD = (0.0, 0.0, 1.0)
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
        joints, states = joints_of(neutral), list(product(VALUES, VALUES))
        efforts = [Effort(**dict(zip(axes, state, strict=True))) for state in states]
        clips = expressive(study_of(neutral, body), efforts, travels=action.travels)
        for state, clip in zip(states, clips, strict=True):
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


def places(clip: Clip) -> FloatArray:
    """Return where the joints are in the character's own frame, ``(n, j, 3)``."""
    rotation, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    return rotate(inverse(rotation[:, :1]), place - place[:, :1])


def acting(study: Study) -> int:
    """Return the hand or foot that goes farthest while a neutral clip's action is executed."""
    begins, ends = study.clip.stage_end_frames[1:3]
    ways = way_m(places(study.clip)[begins : ends + 1])
    return max((effector.end for effector in study.body.effectors), key=lambda j: float(ways[j]))


def way_m(place_m: FloatArray) -> FloatArray:
    """Return how far each joint goes, ``(j,)``, by ``(n, j, 3)``."""
    return np.asarray(np.linalg.norm(np.diff(place_m, axis=0), axis=-1).sum(axis=0))


def executed_s(clip: Clip, joint: int) -> float:
    """Return how long a clip's execution lasts."""
    return float(clip.stage_end_frames[2] - clip.stage_end_frames[1]) / clip.rate_hz


def peak_m_s2(clip: Clip, joint: int) -> float:
    """Return a clip's greatest acceleration, over 1/15 s: of a joint that acts, or of the body.

    A joint that goes less than `ACTS_M` does not act; the body's is the RMS of all joints'.
    """
    place = places(clip)
    step = round(clip.rate_hz / 30.0)
    second = place[2 * step :] - 2.0 * place[step:-step] + place[: -2 * step]
    each = np.linalg.norm(second, axis=-1) * (clip.rate_hz / step) ** 2
    if np.linalg.norm(np.ptp(place[:, joint], axis=0)) >= ACTS_M:
        return float(each[:, joint].max())
    return float(np.sqrt(np.mean(each**2, axis=-1)).max())


def size_m(clip: Clip, joint: int) -> float:
    """Return how far a joint goes in a clip."""
    return float(way_m(places(clip))[joint])


def directness(clip: Clip, joint: int) -> float:
    """Return the chord of a joint's way through the execution, over its arc."""
    begins, ends = clip.stage_end_frames[1:3]
    path = places(clip)[begins : ends + 1, joint]
    arc = np.linalg.norm(np.diff(path, axis=0), axis=-1).sum()
    return float(np.linalg.norm(path[-1] - path[0]) / max(arc, 1e-9))


def followed_m(clip: Clip, joint: int) -> float:
    """Return how far a joint still goes once the execution has ended."""
    return float(way_m(places(clip)[clip.stage_end_frames[2] :])[joint])


LAWS: tuple[tuple[str, str, float, Callable[[Clip, int], float]], ...] = (
    ("time", "the execution lasts longer", -1.0, executed_s),
    ("weight", "the peak acceleration falls", 1.0, peak_m_s2),
    ("weight", "the way falls", 1.0, size_m),
    ("space", "chord over arc falls", 1.0, directness),
    ("flow", "the follow-through grows", -1.0, followed_m),
)
"""What should never happen with more of an axis; the sign of what may; and the measure."""


def played_along(
    study: Study, axis: str, values: Sequence[float], *, travels: bool
) -> tuple[Clip, ...]:
    """Return a clip played with values of one axis alone."""
    return expressive(study, [Effort(**{axis: value}) for value in values], travels=travels)


def wrong_way(values: Sequence[float], sign: float) -> float:
    """Return the greatest relative change from one value to the next that has the wrong sign."""
    value = np.asarray(values, dtype=np.float64)
    change = sign * np.diff(value) / np.maximum(np.abs(value[:-1]), 1e-9)
    return float(max(-change.min(), 0.0))


def bends_rad(clip: Clip) -> FloatArray:
    """Return how far each elbow and knee is bent, ``(n, limbs)``: negative is backwards."""
    skeleton = clip.skeleton
    _, rest = forward_kinematics(skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m)
    plan = body_plan(skeleton.joints, skeleton.parents.tolist(), rest, front=AHEAD)
    turned, place = forward_kinematics(skeleton, clip.rotation_xyzw, clip.translation_m)
    bends = []
    for part in plan.limbs:
        joints = (part.upper, part.middle, part.end)
        pole = AHEAD if part.kind == "leg" else tuple(-x for x in AHEAD)
        limb = limb_of(skeleton, *(skeleton.joints[j] for j in joints), pole)
        upper = normalized(place[:, part.middle] - place[:, part.upper])
        lower = normalized(place[:, part.end] - place[:, part.middle])
        hinge = rotate(turned[:, part.upper], limb.upper_hinge)
        sine = np.sum(np.cross(upper, lower) * hinge, axis=-1)
        bends.append(np.arctan2(sine, np.sum(upper * lower, axis=-1)))
    return np.stack(bends, axis=-1)


def off_aim_m(study: Study, clip: Clip) -> float:
    """Return how far an effector is from its aim when the execution ends; 0 without an aim."""
    neutral, played = places(study.clip), places(clip)
    ends = [effector.end for effector in study.aim.effectors]
    apart = played[clip.stage_end_frames[2], ends] - neutral[study.aim.frame, ends]
    return float(np.linalg.norm(apart, axis=-1).max(initial=0.0))


def print_laws(library: Library) -> None:
    """Print by how much each measure goes the wrong way, per action that is played once."""
    body = body_of(library.clip("idle"))
    print("\nmost that a measure goes the wrong way from one of nine steps to the next, in %")
    print(f"{'':12}" + "".join(f"{axis:>8}" for axis, *_ in LAWS) + "   aims")
    worst = np.zeros(len(LAWS))
    for action in library.actions:
        study = study_of(library.clip(action.name), body)
        if study.clip.cyclic:
            continue
        joint, found = acting(study), []
        for axis, _, sign, measure in LAWS:
            clips = played_along(study, axis, NINE, travels=action.travels)
            found.append(100.0 * wrong_way([measure(clip, joint) for clip in clips], sign))
        names = [study.clip.skeleton.joints[effector.end] for effector in study.aim.effectors]
        print(f"{action.name:12}" + "".join(f"{x:8.1f}" for x in found), "  " + ", ".join(names))
        worst = np.maximum(worst, found)
    for (axis, wrong, *_), most in zip(LAWS, worst, strict=True):
        print(f"{axis:6}: {wrong} by {most:.1f} % at most")


def print_states(library: Library) -> None:
    """Print what holds in all 81 states of poles and neutral: aims and hinges."""
    body = body_of(library.clip("idle"))
    aims, bends = [], []
    for action in library.actions:
        study = study_of(library.clip(action.name), body)
        states = list(product((-1.0, 0.0, 1.0), repeat=4))
        clips = expressive(study, [Effort(*state) for state in states], travels=action.travels)
        for state, clip in zip(states, clips, strict=True):
            aims.append((100.0 * off_aim_m(study, clip), action.name, state))
            bends.append((float(np.degrees(bends_rad(clip).min())), action.name, state))
    print(f"\n{len(bends)} clips in all 81 states; a state is time, weight, space, flow")
    print("farthest from an aim: {:.2f} cm, {} {}".format(*max(aims)))
    print("least bend of an elbow or knee: {:.2f} degrees, {} {}".format(*min(bends)))


def main() -> None:
    """Print what is read, by reader, axis and part; then what is kept."""
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
    print_laws(load_library())
    print_states(load_library())


if __name__ == "__main__":
    main()
