"""What the moon's face does: smooth displacements around its landmarks, by name."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.displacement import (
    Motion,
    near,
    on_both,
    puffed,
    pulled,
    sided,
    step,
    summed,
)
from actions_library.authoring.moon.mouth import MOUTH_M, lip_line_m, parting
from smd.geometry.arrays import FloatArray

JAW_MM = (0.0, -40.0, -9.0)
"""How far the jaw goes when it is open."""

_SIDED = (
    *("blink", "eye_wide", "eye_squint", "brow_down", "brow_up"),
    *("smile", "frown", "cheek_up", "nose_wrinkle", "upper_lip_up", "lower_lip_down"),
)
MOON_SHAPES = (
    *("jaw_open", "pucker", "cheek_puff", "brow_inner_up", "pupils_wide"),
    *(f"{side}_{name}" for side in ("left", "right") for name in _SIDED),
)
"""All shapes of the moon."""


def mouth_motions(side: FloatArray) -> dict[str, Motion]:
    """Return what moves lips, for points each of which belongs to a lip (1 upper, -1 lower)."""
    below = 0.5 - 0.5 * side

    def lower(points: FloatArray) -> FloatArray:
        """Return how far points go with the jaw: at the corners both lips go alike."""
        x = np.abs(points[:, 0])
        along = np.minimum(x / MOUTH_M[0], 1.0) ** 2.5
        lip = below * (1.0 - 0.55 * along) + (1.0 - below) * 0.45 * along
        away = np.abs(points[:, 1] - lip_line_m(x))
        return np.asarray(lip + (below - lip) * step(away, 0.0, 0.065))

    def jaw_open(points: FloatArray) -> FloatArray:
        share = lower(points) * step(points[:, 2], -0.03, 0.07)
        return np.outer(share, 0.001 * np.array(JAW_MM))

    def pucker(points: FloatArray) -> FloatArray:
        x = points[:, :1]
        up = points[:, 1:2] - lip_line_m(x)
        way = np.concatenate([-0.62 * x, 0.45 * up, 0.024 + 0.0 * x], axis=1)
        return near(points, (0.0, MOUTH_M[1], 0.105), (0.095, 0.056, 0.080)) * way

    def lip(up: float, by_m: float) -> Motion:
        def motion(points: FloatArray) -> FloatArray:
            own = np.maximum(up * side, 0.0) * parting(points[:, 0]) ** 0.7
            half = step(points[:, :1], -0.024, 0.024)
            way = np.outer(own * by_m, [0.0, up, 0.12])
            return half * near(points, (0.0, MOUTH_M[1], 0.100), (0.08, 0.052, 0.07)) * way

        return motion

    narrower = on_both(pulled((0.078, 0.112, 0.075), (0.06, 0.07, 0.075), (-7.0, 0.0, 0.0)))
    return {
        "jaw_open": summed(jaw_open, narrower),
        "pucker": pucker,
        **sided({"upper_lip_up": lip(1.0, 0.012), "lower_lip_down": lip(-1.0, 0.013)}),
    }


def skin_motions() -> dict[str, Motion]:
    """Return what moves skin wherever it is: brows, cheeks, corners of the mouth, nose."""
    corner = (0.052, 0.110, 0.092)
    brow_in, brow_out = (0.030, 0.258, 0.098), (0.080, 0.256, 0.080)
    cheek = (0.085, 0.150, 0.082)
    smile = summed(
        pulled(corner, (0.055, 0.055, 0.075), (13.0, 21.0, -6.0)),
        pulled((0.080, 0.158, 0.082), (0.046, 0.042, 0.065), (3.0, 7.0, 9.0)),
    )
    frown = summed(
        pulled(corner, (0.055, 0.055, 0.075), (3.0, -21.0, -3.0)),
        pulled((0.0, 0.065, 0.09), (0.035, 0.028, 0.05), (0.0, 1.5, 2.0)),
    )
    down = summed(
        pulled(brow_in, (0.046, 0.042, 0.07), (-6.0, -17.0, 4.0)),
        pulled(brow_out, (0.046, 0.042, 0.07), (-2.0, -4.0, 1.0)),
    )
    wrinkle = summed(
        pulled((0.024, 0.152, 0.120), (0.030, 0.040, 0.06), (3.0, 8.0, 2.0)),
        pulled((0.020, 0.200, 0.105), (0.025, 0.036, 0.05), (0.0, 5.0, 3.0)),
    )
    puff = puffed((0.085, 0.115, 0.075), (0.060, 0.062, 0.08), 26.0, (0.0, 0.13, 0.0))
    inner_up = summed(
        pulled(brow_in, (0.048, 0.045, 0.07), (-2.0, 18.0, 1.0)),
        pulled(brow_out, (0.040, 0.040, 0.06), (0.0, -5.0, 0.0)),
    )
    return {
        "cheek_puff": on_both(puff),
        "brow_inner_up": on_both(inner_up),
        **sided(
            {
                "brow_down": down,
                "brow_up": summed(
                    pulled(brow_in, (0.045, 0.045, 0.07), (0.0, 9.0, 0.0)),
                    pulled(brow_out, (0.052, 0.048, 0.07), (1.0, 15.0, 0.0)),
                ),
                "smile": smile,
                "frown": frown,
                "cheek_up": pulled(cheek, (0.050, 0.045, 0.075), (1.0, 10.0, 9.0)),
                "nose_wrinkle": wrinkle,
            }
        ),
    }
