"""The slow way to a terrain's height: every triangle, one after the other."""

from __future__ import annotations

import numpy as np


def height_over(points_m, triangles, x, z):
    """The highest of the triangles over a place; None beside all of them."""
    found = []
    for corners in np.asarray(points_m)[triangles]:
        (ax, _, az), (bx, _, bz), (cx, _, cz) = corners
        system = np.array([[ax, bx, cx], [az, bz, cz], [1.0, 1.0, 1.0]])
        if abs(np.linalg.det(system)) < 1e-12:
            continue
        weights = np.linalg.solve(system, [x, z, 1.0])
        if (weights >= -1e-9).all():
            found.append(float(weights @ corners[:, 1]))
    return max(found, default=None)
