"""What of a skeleton is posed, by name: a body, chains of joints, legs by name and number."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from actions_library.authoring.keys import Vector
from actions_library.authoring.legs import RigLeg
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError

BODY, PLACE = "body", "place"
"""Names of the parts that every rig has: how its body is turned, and where it is."""


@dataclass(frozen=True, slots=True)
class Chain:
    """Joints that turn together: a spine, a neck, a tail, an ear, a wing, a jaw, segments.

    Attributes
    ----------
    name : of its keys and waves; ``left_…`` and ``right_…`` are mirror images of each other.
    joints : from root to tip, each one's parent before it.
    shares : what part of a key's turn each joint takes; even parts by default.
    lag_s : how long each joint comes after the one before it, so that tips follow.
    steady : keys are turns in the clip's world, not from what holds the chain: a head that
        looks ahead whatever the body does. Its joints share the way there.
    """

    name: str
    joints: tuple[str, ...]
    shares: tuple[float, ...] = ()
    lag_s: float = 0.0
    steady: bool = False

    def share(self, k: int) -> float:
        """Return the part of a key's turn that the k-th joint takes."""
        return self.shares[k] if self.shares else 1.0 / len(self.joints)


@dataclass(frozen=True, slots=True, eq=False)
class Rig:
    """A skeleton, and the parts of it that keys name.

    Attributes
    ----------
    skeleton : whose joint 0 is the ground root.
    body : the joint below the ground root, which ``place`` moves and ``body`` turns.
    chains : posed in their order, each after what holds it.
    legs : posed last.
    pivot_m : where the body turns about, from its joint at rest: the middle of a long one.
    tracks : names of numbers that keys set beside the joints: weights of shapes, other controls.

    Raises
    ------
    CharacterError
        If a joint is missing, is posed twice, or a name is used twice.
    """

    skeleton: Skeleton
    body: str
    chains: tuple[Chain, ...] = ()
    legs: tuple[RigLeg, ...] = ()
    pivot_m: Vector = (0.0, 0.0, 0.0)
    tracks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        names = [BODY, PLACE, *(chain.name for chain in self.chains)]
        names += [*(leg.name for leg in self.legs), *self.tracks]
        joints = [self.body, *(joint for chain in self.chains for joint in chain.joints)]
        for leg in self.legs:
            joints += [j for j in (leg.blade, leg.upper, leg.lower, leg.foot, leg.toes) if j]
        for what, found in (("part", names), ("joint", joints)):
            twice = sorted({name for name in found if found.count(name) > 1})
            if twice:
                raise CharacterError(f"rig: expected each {what} once, found {twice[0]!r} twice")
        for joint in joints:
            self.skeleton.index(joint)
        for chain in self.chains:
            if chain.shares and len(chain.shares) != len(chain.joints):
                raise CharacterError(
                    f"rig: chain {chain.name!r}: expected {len(chain.joints)} shares, "
                    f"got {len(chain.shares)}"
                )
            for holder, joint in pairwise(chain.joints):
                if self.skeleton.parents[self.skeleton.index(joint)] != self.skeleton.index(holder):
                    raise CharacterError(
                        f"rig: chain {chain.name!r}: expected {holder!r} to hold {joint!r}"
                    )

    def leg(self, name: str) -> RigLeg:
        """Return the leg of that name, or raise CharacterError naming those there are."""
        for leg in self.legs:
            if leg.name == name:
                return leg
        known = ", ".join(leg.name for leg in self.legs)
        raise CharacterError(f"rig: expected a leg of {known}; got {name!r}")
