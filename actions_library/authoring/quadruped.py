"""Legs of animals on four feet: they stand on their toes, elbows bend back, knees ahead."""

from __future__ import annotations

from actions_library.authoring.legs import BEHIND, RigLeg


def hind_leg(side: str) -> RigLeg:
    """Return a hind leg, from hip to toes."""
    return RigLeg(
        f"{side}_hind",
        f"{side}_hip",
        f"{side}_knee",
        f"{side}_hock",
        f"{side}_hind_toes",
        on_toes=True,
    )


def fore_leg(side: str) -> RigLeg:
    """Return a front leg, which a shoulder blade carries."""
    return RigLeg(
        f"{side}_fore",
        f"{side}_shoulder",
        f"{side}_elbow",
        f"{side}_wrist",
        f"{side}_fore_toes",
        blade=f"{side}_shoulder_blade",
        blade_share=0.45,
        knee=BEHIND,
        on_toes=True,
    )
