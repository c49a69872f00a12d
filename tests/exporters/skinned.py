"""Where USD's own skinning puts a character that we wrote."""

from __future__ import annotations

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel


def skinned(stage: Usd.Stage, root: str, frame: float) -> np.ndarray:
    """Return a character's points in the world, skinned by USD."""
    cache, prim = UsdSkel.Cache(), UsdSkel.Root(stage.GetPrimAtPath(root))
    cache.Populate(prim, Usd.PrimDefaultPredicate)
    (binding,) = cache.ComputeSkelBindings(prim, Usd.PrimDefaultPredicate)
    query = cache.GetSkelQuery(binding.GetSkeleton())
    (target,) = binding.GetSkinningTargets()
    points = UsdGeom.Mesh(target.GetPrim()).GetPointsAttr().Get()
    assert target.ComputeSkinnedPoints(query.ComputeSkinningTransforms(frame), points, frame)
    return np.array(points)
