"""USD: prims whose transforms are animated, each a device [1]_.

Every prim with time samples of its own transform, cameras apart, is a track of its pose in the
world. The stage says which axis is up, how long its unit is and how many time codes a second has;
scale and shear are left out.

References
----------
.. [1] https://openusd.org/release/api/class_usd_geom_xformable.html
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from laban.faults import Fault
from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import METRES_PER_UNIT, Mount, SourceFrame
from smd.formats.tracks import Content, Track, shown

if TYPE_CHECKING:
    from pxr import Usd, UsdGeom

_FRONT = {"Y": "z", "Z": "-y"}
"""Where a prop faces that stands along the axes, by the axis that is up: as in CAD and Blender."""


def read(file: RecordingFile) -> Content:
    """Return a track for every animated prim.

    Raises
    ------
    Fault
        If the file is no USD, its unit has no name here, or nothing in it is animated.
    """
    from pxr import Tf, Usd, UsdGeom

    try:
        stage = Usd.Stage.Open(str(file.path))
    except Tf.ErrorException as error:
        why = str(error).strip().splitlines()[-1]
        raise Fault("", "a USD file", shown(why)) from error
    up = UsdGeom.GetStageUpAxis(stage)
    frame = SourceFrame(up.lower(), _FRONT[up], "right", _unit(stage), "wxyz", Mount())
    prims = list(_animated(stage))
    if not prims:
        raise Fault("", "a prim whose transform is animated", "none")
    names = [prim.GetPrim().GetName() for prim in prims]
    tracks = tuple(
        _track(prim, own if names.count(own) == 1 else str(prim.GetPath()), stage)
        for prim, own in zip(prims, names, strict=True)
    )
    return Content(tracks, frame, order_is_given=True)


def _unit(stage: Usd.Stage) -> str:
    """Return the unit that is as long as the stage's."""
    from pxr import UsdGeom

    metres = UsdGeom.GetStageMetersPerUnit(stage)
    for unit, length in METRES_PER_UNIT.items():
        if abs(metres - length) < 1e-6 * length:
            return unit
    expected = f"metersPerUnit of {', '.join(map(str, METRES_PER_UNIT.values()))}"
    raise Fault("", expected, f"{metres:g}")


def _animated(stage: Usd.Stage) -> Iterator[UsdGeom.Xformable]:
    """Yield what moves of itself, not only with its parent."""
    from pxr import UsdGeom

    for prim in stage.Traverse():
        if prim.IsA(UsdGeom.Xformable) and not prim.IsA(UsdGeom.Camera):
            xformable = UsdGeom.Xformable(prim)
            if len(xformable.GetTimeSamples()) > 1:
                yield xformable


def _track(prim: UsdGeom.Xformable, device: str, stage: Usd.Stage) -> Track:
    """Return a prim's poses in the world, at its own times and those of its parents."""
    from pxr import UsdGeom

    codes: set[float] = set()
    above = prim.GetPrim()
    while above:
        if above.IsA(UsdGeom.Xformable):
            codes |= set(UsdGeom.Xformable(above).GetTimeSamples())
        above = above.GetParent()
    times = sorted(codes)
    position, quaternion = np.empty((len(times), 3)), np.empty((len(times), 4))
    for i, code in enumerate(times):
        matrix = prim.ComputeLocalToWorldTransform(code).RemoveScaleShear()
        turn = matrix.ExtractRotationQuat().GetNormalized()
        position[i] = matrix.ExtractTranslation()
        quaternion[i] = (turn.GetReal(), *turn.GetImaginary())
    return Track(
        device=device,
        time_s=np.array(times) / stage.GetTimeCodesPerSecond(),
        position=position,
        quaternion=quaternion,
        place=partial(_place, device, times),
    )


def _place(device: str, times: list[float], i: int) -> str:
    """Return where pose ``i`` of a device stands in the file."""
    return f"prim {device!r}, time code {times[i]:g}"


FORMAT = RecordingFormat("USD", (), read, only_named=(".usd", ".usda", ".usdc", ".usdz"))
"""A USD file may as well be an animation that was made of a recording."""
