"""Roles: what each joint of any skeleton is (section 6.4.2 of the paper [1]_).

Structure decides first: limbs are pairs of alike branches, legs are those that come down, the
trunk is what holds them together. Names help where they say something: sides, hands, feet, head.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from smd.character.kinematics import rest_in_world
from smd.character.skeleton import Role, Skeleton
from smd.errors import CharacterError
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.rotations import inverse, normalized, quaternion_between, rotate

Side = Literal["left", "right"]

LEAST_LIMB = 0.15
"""Shortest limb, as a share of the skeleton's size: shorter pairs are ears, eyes or fingers."""

LEAST_DESCENT = 0.12
"""How far down a leg goes at least, as a share of the skeleton's height; controls lie flat."""

GROUNDED = 0.2
"""Height of a leg's end at most, as a share of the skeleton's height."""

END_SHARE = 0.35
"""Share of a limb's length that is left beyond its hand or foot at most."""

UP = (0.0, 1.0, 0.0)
_AXES = (UP, (0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0))
"""Directions that may be up; the first of equally likely ones is."""

_LEFT = re.compile(r"(?:^|[^a-z])l(?:$|[^a-z])|left|^L(?=[A-Z])", re.ASCII)
_RIGHT = re.compile(r"(?:^|[^a-z])r(?:$|[^a-z])|right|^R(?=[A-Z])", re.ASCII)
_HAND = re.compile(r"wrist|hand(?!le)|palm", re.IGNORECASE)
_FOOT, _ANKLE = re.compile(r"foot", re.IGNORECASE), re.compile(r"ankle", re.IGNORECASE)
_HEAD = re.compile(r"(?:^|[^a-z])head(?:$|[^a-z])", re.IGNORECASE)
_CONTROL = re.compile(r"(?:^|[^a-z])ik(?:$|[^a-z])|IK|control|pole|target", re.ASCII)


@dataclass(frozen=True, slots=True)
class LimbPlan:
    """An arm or a leg.

    Attributes
    ----------
    kind : ``"leg"`` where it reaches the ground, ``"arm"`` elsewhere.
    side : whose.
    chain : from the joint next to the trunk to the tip.
    upper, middle, end : the joints that two-bone inverse kinematics turns and places: shoulder,
        elbow, wrist, or hip, knee, ankle.
    """

    kind: Literal["arm", "leg"]
    side: Side
    chain: tuple[int, ...]
    upper: int
    middle: int
    end: int


@dataclass(frozen=True, slots=True)
class BodyPlan:
    """How a skeleton is built.

    Attributes
    ----------
    root : from the skeleton's first joint to the pelvis, which holds legs and spine.
    spine : from the joint after the pelvis to the head, or to the tip where there is no head.
    chest : the joint of the spine that holds the arms, or the front legs; the pelvis without them.
    head : None where nothing is one.
    limbs : legs first; from the back to the front, the left one before the right one.
    front : unit direction in which it faces, across ``up``.
    up : unit direction that points up.
    roles : of each joint.
    """

    root: tuple[int, ...]
    spine: tuple[int, ...]
    chest: int
    head: int | None
    limbs: tuple[LimbPlan, ...]
    front: tuple[float, float, float]
    up: tuple[float, float, float]
    roles: tuple[Role, ...]

    @property
    def pelvis(self) -> int:
        """The joint that holds legs and spine."""
        return self.root[-1]

    def of(self, kind: str, side: str) -> LimbPlan | None:
        """Return the first limb of a kind and side, or None."""
        return next((x for x in self.limbs if (x.kind, x.side) == (kind, side)), None)


@lru_cache(maxsize=16)
def plan_of(skeleton: Skeleton) -> BodyPlan:
    """Return how a character's skeleton is built; at rest it faces +Z."""
    place_m = rest_in_world(skeleton)[1]
    parents = skeleton.parents.tolist()
    return body_plan(skeleton.joints, parents, place_m, front=(0.0, 0.0, 1.0))


@lru_cache(maxsize=16)
def without_digits(skeleton: Skeleton) -> IntArray:
    """Return all joints but those beyond a hand or a foot.

    Fingers are quick: their turns do not say how long a body takes to get into a pose.
    """
    digits: set[int] = set()
    for limb in plan_of(skeleton).limbs:
        beyond = {limb.end}
        for joint, parent in enumerate(skeleton.parents.tolist()):
            if parent in beyond:
                beyond.add(joint)
        digits |= beyond - {limb.end}
    kept = np.array([joint for joint in range(len(skeleton)) if joint not in digits])
    kept.flags.writeable = False
    return kept


@lru_cache(maxsize=16)
def to_knuckles(skeleton: Skeleton) -> IntArray:
    """Return `without_digits`, and the first joint beyond each hand and foot.

    Fingers are many: in a mean over places, those of a hand would count more than all the rest.
    """
    limbs = plan_of(skeleton).limbs
    knuckles = {joint for limb in limbs for joint in limb.chain[limb.chain.index(limb.end) :][:2]}
    kept = np.union1d(without_digits(skeleton), np.array(sorted(knuckles), dtype=np.int64))
    kept.flags.writeable = False
    return kept


def body_plan(
    joints: Sequence[str],
    parents: Sequence[int],
    rest_position_m: FloatArray,
    *,
    front: Sequence[float] | None = None,
    up: Sequence[float] | None = UP,
) -> BodyPlan:
    """Return how a skeleton is built.

    Parameters
    ----------
    joints, parents
        Names, and each joint's parent, which comes before it; -1 for a root.
    rest_position_m
        ``(j, 3)`` in the world at rest.
    front
        Level direction in which it faces; by default guessed: from the sides that names say, else
        from where the toes point, else from where the head is.
    up
        Direction that points up. None guesses it among the axes: legs reach down farthest along
        it; +Y where there are no legs.

    Raises
    ------
    CharacterError
        If there is no joint, ``front`` has no level part, or ``up`` no length.
    """
    place = np.asarray(rest_position_m, dtype=np.float64)
    upward = np.asarray(_guessed_up(joints, parents, place) if up is None else up, dtype=np.float64)
    if np.linalg.norm(upward) < 1e-9:
        raise CharacterError(f"up: expected a direction, got {up}")
    ours_from_given = quaternion_between(upward, UP)
    if front is not None:
        front = rotate(ours_from_given, front).tolist()
    plan = _upright_plan(joints, parents, rotate(ours_from_given, place), front)
    return replace(
        plan,
        front=_triple(rotate(inverse(ours_from_given), plan.front)),
        up=_triple(normalized(upward)),
    )


def reaches_ground(parents: Sequence[int], rest_position_m: FloatArray) -> BoolArray:
    """Return of each joint ``(j,)`` whether it, or what hangs from it, is at the ground at rest."""
    height_m = rest_position_m[:, 1] - rest_position_m[:, 1].min()
    reaches = np.asarray(height_m < GROUNDED * height_m.max())
    for joint in range(len(reaches) - 1, 0, -1):  # parents come first
        if reaches[joint] and parents[joint] >= 0:
            reaches[parents[joint]] = True
    return reaches


def _triple(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z


def _guessed_up(
    joints: Sequence[str], parents: Sequence[int], place: FloatArray
) -> tuple[float, float, float]:
    """Return the axis along which legs reach down farthest, all together."""

    def reach(axis: tuple[float, float, float]) -> float:
        tree = _Tree(joints, parents, rotate(quaternion_between(axis, UP), place))
        return sum(float(np.ptp(tree.place[list(b), 1])) for pair in tree.legs() for b in pair)

    return max(_AXES, key=lambda axis: round(reach(axis), 6))


def _upright_plan(
    joints: Sequence[str],
    parents: Sequence[int],
    place: FloatArray,
    front: Sequence[float] | None,
) -> BodyPlan:
    """Return how a skeleton is built that stands with +Y up."""
    tree = _Tree(joints, parents, place)
    pairs = tree.pairs()
    legs = tree.legs()
    hips = tree.meeting([branch[0] for pair in legs for branch in pair]) if legs else None
    # Quadrupeds have two pairs of legs; the pelvis holds the hind ones and the spine.
    pelvis = tree.pelvis(legs, hips)
    head, spine = tree.spine(pelvis, [branch for pair in pairs for branch in pair])
    level = _front(tree, pairs, legs, pelvis, head, front)
    left = np.cross([0.0, 1.0, 0.0], level)
    limbs = [
        tree.limb(branch, "leg" if pair in legs else "arm", side)
        for pair in pairs
        for branch, side in zip(pair, tree.sides(pair, left), strict=True)
    ]
    behind = {x: round(float(tree.place[x.chain[0]] @ level) / tree.size, 1) for x in limbs}
    limbs.sort(key=lambda x: (x.kind != "leg", behind[x], x.side))
    others = [pair for pair in pairs if pair not in legs] or legs
    holders = [tree.parents[b[0]] for pair in others for b in pair if tree.parents[b[0]] in spine]
    chest = max(holders, key=spine.index) if holders else (spine[0] if spine else pelvis)
    root = tree.way(pelvis)
    roles: list[Role] = [
        "root"
        if j in root
        else "spine"
        if j in spine
        else "end_effector"
        if not tree.children[j]
        else "intermediate"
        for j in range(len(tree.names))
    ]
    return BodyPlan(
        root=root,
        spine=spine,
        chest=chest,
        head=head,
        limbs=tuple(limbs),
        front=(float(level[0]), 0.0, float(level[2])),
        up=UP,
        roles=tuple(roles),
    )


Branch = tuple[int, ...]
Pair = tuple[Branch, Branch]


class _Tree:
    """Joints with their children, and what follows from where they are."""

    def __init__(self, names: Sequence[str], parents: Sequence[int], place: FloatArray) -> None:
        if not len(names):
            raise CharacterError("skeleton: expected at least one joint")
        self.names = tuple(names)
        self.parents = [int(parent) for parent in parents]
        self.place = np.asarray(place, dtype=np.float64)
        self.children: list[list[int]] = [[] for _ in self.names]
        for j, parent in enumerate(self.parents):
            if parent >= 0:
                self.children[parent].append(j)
        self.under: list[list[int]] = [[j] for j in range(len(self.names))]
        for j in range(len(self.names) - 1, -1, -1):
            for child in self.children[j]:
                self.under[j] += self.under[child]
        self.step_m = [
            float(np.linalg.norm(self.place[j] - self.place[parent])) if parent >= 0 else 0.0
            for j, parent in enumerate(self.parents)
        ]
        # From the tips up, each joint once: a chain of many joints would else be gone through
        # anew from every joint on it.
        self.branches: list[Branch] = [()] * len(self.names)
        for j in range(len(self.names) - 1, -1, -1):
            below = (self.branches[child] for child in self.children[j])
            self.branches[j] = (j, *max(below, key=self.length, default=()))
        self.lowest = float(self.place[:, 1].min())
        self.height = max(float(np.ptp(self.place[:, 1])), 1e-9)
        self.size = max(float(np.ptp(self.place, axis=0).max()), 1e-9)

    def way(self, joint: int) -> tuple[int, ...]:
        """Return the joints from the first one to this one."""
        found = [joint]
        while self.parents[found[-1]] >= 0:
            found.append(self.parents[found[-1]])
        return tuple(reversed(found))

    def branch(self, joint: int) -> Branch:
        """Return the longest way from a joint to a tip."""
        return self.branches[joint]

    def length(self, chain: Sequence[int]) -> float:
        """Return how long a chain is, from its first joint's parent on."""
        return sum((self.step_m[j] for j in chain), 0.0)

    def pairs(self) -> list[Pair]:
        """Return pairs of alike branches that are long enough to be limbs."""
        found: list[Pair] = []
        for j, siblings in enumerate(self.children):
            if _CONTROL.search(self.names[j]):
                continue
            long = [c for c in siblings if self._could_be_a_limb(c)]
            while len(long) > 1:
                one = long.pop(0)
                other = min(long, key=lambda c: self._unlike(one, c))
                if self._unlike(one, other) < 0.15 * self.size:
                    long.remove(other)
                    found.append((self.branch(one), self.branch(other)))
        return found

    def legs(self) -> list[Pair]:
        """Return the pairs of which both come down to the ground."""
        return [pair for pair in self.pairs() if self.is_leg(pair[0]) and self.is_leg(pair[1])]

    def _could_be_a_limb(self, joint: int) -> bool:
        branch = self.branch(joint)
        inside = self.length(branch) - self.length(branch[:1])
        controls = _CONTROL.search(self.names[joint])
        return len(branch) >= 3 and inside > LEAST_LIMB * self.size and not controls

    def _unlike(self, one: int, other: int) -> float:
        """Return how far two branches differ in length, height and distance from their parent."""
        a, b = self.branch(one), self.branch(other)
        if len(a) != len(b):
            return float(self.size)
        holder = self.place[self.parents[one]]
        out = [np.linalg.norm(self.place[list(c)] - holder, axis=-1) for c in (a, b)]
        up = [self.place[list(c), 1] for c in (a, b)]
        return float(max(np.abs(out[0] - out[1]).max(), np.abs(up[0] - up[1]).max()))

    def is_leg(self, branch: Branch) -> bool:
        """Return whether a branch comes down to the ground."""
        up = self.place[list(branch), 1]
        descends = up.max() - up.min() > LEAST_DESCENT * self.height
        return bool(descends and up.min() - self.lowest < GROUNDED * self.height)

    def meeting(self, joints: Sequence[int]) -> int:
        """Return the last joint that is above all of some."""
        ways = [self.way(self.parents[j]) for j in joints]
        shared = [steps[0] for steps in zip(*ways, strict=False) if len(set(steps)) == 1]
        return shared[-1]

    def pelvis(self, legs: Sequence[Pair], hips: int | None) -> int:
        """Return the joint that holds the hind legs and the spine."""
        if hips is None:
            return 0
        holders = [self.meeting([branch[0] for branch in pair]) for pair in legs]
        return min(holders, key=lambda j: len(self.way(j)))

    def spine(self, pelvis: int, limbs: Sequence[Branch]) -> tuple[int | None, tuple[int, ...]]:
        """Return the head, if there is one, and the joints from the pelvis to it."""
        within = [j for j in self.under[pelvis] if j != pelvis]
        first = {branch[0] for branch in limbs}
        free = [j for j in within if not first & set(self.way(j))]
        named = [j for j in free if _HEAD.search(self.names[j])]
        if not limbs:  # a snake: the longest way there is
            branches = (self.branch(c) for c in self.children[pelvis])
            chain: tuple[int, ...] = max(branches, key=self.length, default=())
            return (named[0] if named else None), chain
        holds = {self.parents[branch[0]] for branch in limbs} - {pelvis}
        candidates = named or [j for j in free if holds <= set(self.way(j)) | {pelvis}]
        if not candidates:
            return None, self._above(pelvis, holds)
        head = candidates[0] if named else max(candidates, key=lambda j: self.place[j, 1])
        if not named and not self.children[head] and self.parents[head] not in holds | {pelvis}:
            head = self.parents[head] if len(self.way(head)) > 3 and self._is_tip(head) else head
        way = self.way(head)
        return head, way[way.index(pelvis) + 1 :]

    def _is_tip(self, joint: int) -> bool:
        """Return whether a leaf only marks the end of the bone above it."""
        return bool(re.search(r"end|leaf|tip|nub|site", self.names[joint], re.IGNORECASE))

    def _above(self, pelvis: int, holds: set[int]) -> tuple[int, ...]:
        """Return the joints from the pelvis to the last one that holds a limb."""
        if not holds:
            return ()
        way = self.way(max(holds, key=lambda j: len(self.way(j))))
        return way[way.index(pelvis) + 1 :] if pelvis in way else ()

    def sides(self, pair: Pair, left: FloatArray) -> tuple[Side, Side]:
        """Return which branch of a pair is the left one."""
        apart = self.place[list(pair[0])].mean(axis=0) - self.place[list(pair[1])].mean(axis=0)
        return ("left", "right") if apart @ left > 0.0 else ("right", "left")

    def limb(self, branch: Branch, kind: Literal["arm", "leg"], side: Side) -> LimbPlan:
        """Return a limb; its end is named a hand or foot, or is where little is left beyond it."""
        inner = list(range(2, len(branch)))
        patterns = (_FOOT, _ANKLE) if kind == "leg" else (_HAND,)
        named = [i for p in patterns for i in inner if p.search(self.names[branch[i]])]
        whole = self.length(branch[1:])
        near = [i for i in inner if self.length(branch[i + 1 :]) <= END_SHARE * whole]
        at = (named or near or inner[-1:])[0]
        return LimbPlan(kind, side, branch, branch[at - 2], branch[at - 1], branch[at])


def _front(
    tree: _Tree,
    pairs: Sequence[Pair],
    legs: Sequence[Pair],
    pelvis: int,
    head: int | None,
    given: Sequence[float] | None,
) -> FloatArray:
    """Return the level direction in which a skeleton faces."""
    if given is not None:
        level = np.array([given[0], 0.0, given[2]], dtype=np.float64)
        if np.linalg.norm(level) < 1e-9:
            raise CharacterError(f"front: expected a direction with a level part, got {given}")
        return normalized(level)
    left = np.zeros(3)
    for one, other in pairs:
        apart = tree.place[list(one)].mean(axis=0) - tree.place[list(other)].mean(axis=0)
        names = [" ".join(tree.names[j] for j in branch) for branch in (one, other)]
        if _LEFT.search(names[0]) and _RIGHT.search(names[1]):
            left += apart
        elif _RIGHT.search(names[0]) and _LEFT.search(names[1]):
            left -= apart
    guesses = [np.cross(left, [0.0, 1.0, 0.0])]
    toes = np.zeros(3)
    for pair in legs:
        for branch in pair:
            limb = tree.limb(branch, "leg", "left")
            toes += tree.place[branch[-1]] - tree.place[limb.end]
    if pairs:  # toes point roughly ahead: square to the line from side to side
        one, other = pairs[0]
        apart = tree.place[list(one)].mean(axis=0) - tree.place[list(other)].mean(axis=0)
        across = normalized(np.cross(apart, [0.0, 1.0, 0.0]))
        guesses.append(across * (toes @ across))
    if head is not None:
        guesses.append(tree.place[head] - tree.place[pelvis])
    elif len(tree.names) > 1:
        guesses.append(tree.place[pelvis] - tree.place[tree.under[pelvis][-1]])
    for guess in guesses:
        level = guess * [1.0, 0.0, 1.0]
        if np.linalg.norm(level) > 0.02 * tree.size:
            return normalized(level)
    return np.array([0.0, 0.0, 1.0])
