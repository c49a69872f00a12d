"""What the dragon's face does: smooth displacements around its landmarks, by name."""

from __future__ import annotations

from actions_library.authoring.displacement import Motion, on_both, puffed, pulled, summed, swung
from actions_library.authoring.rigging import Point

JAW_HINGE: Point = (0.0, 0.800, 0.385)
JAW_DEG = 30.0
"""Where the jaw turns, and how far it opens."""

BROW_IN: Point = (0.030, 0.893, 0.438)
BROW_OUT: Point = (0.078, 0.892, 0.398)
NOSTRIL: Point = (0.021, 0.846, 0.556)


def skin_motions() -> dict[str, Motion]:
    """Return what moves the skin of head and neck, and what lies on it."""
    angry = summed(
        pulled(BROW_IN, (0.050, 0.055, 0.060), (-4.0, -20.0, 6.0)),
        pulled(BROW_OUT, (0.045, 0.050, 0.055), (2.0, 5.0, 0.0)),
    )
    raised = summed(
        pulled(BROW_IN, (0.050, 0.055, 0.060), (-1.0, 15.0, 0.0)),
        pulled(BROW_OUT, (0.045, 0.050, 0.055), (1.0, 9.0, 0.0)),
    )
    flare = summed(
        puffed(NOSTRIL, (0.034, 0.036, 0.040), 6.0, (0.006, 0.826, 0.530)),
        pulled(NOSTRIL, (0.040, 0.036, 0.040), (5.0, 5.0, -2.0)),
    )
    snarl = summed(
        pulled((0.036, 0.800, 0.500), (0.034, 0.034, 0.060), (3.0, 19.0, 1.0)),
        pulled((0.026, 0.848, 0.490), (0.026, 0.030, 0.040), (0.0, 8.0, -3.0)),
    )
    throat = puffed((0.0, 0.690, 0.370), (0.130, 0.115, 0.130), 46.0, (0.0, 0.690, 0.285))
    return {
        "snarl": on_both(snarl),
        "brow_angry": on_both(angry),
        "brow_raise": on_both(raised),
        "nostril_flare": on_both(flare),
        "throat_puff": throat,
    }


def jaw_motion() -> Motion:
    """Return how the jaw turns, and what is on it."""
    return swung(JAW_HINGE, (1.0, 0.0, 0.0), JAW_DEG)
