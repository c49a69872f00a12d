from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pxr import Usd, UsdGeom

from exporters.scenery import BACK, camera_place
from exporters.usd import write_usd
from smd import StageFrame
from tests.exporters.skinned import skinned


@pytest.fixture(scope="module", params=["y", "z"])
def stage(request, performance, tmp_path_factory):
    """A doodle that reaches far from its character, on a stage in centimetres."""
    first, second = performance.actors
    far = replace(
        second.doodles[1], position_m=second.doodles[1].position_m + np.array([9.0, 2.0, -6.0])
    )
    second = replace(second, doodles=(second.doodles[0], far))
    path = tmp_path_factory.mktemp("camera") / "take.usdc"
    frame = StageFrame(request.param, 0.01)
    write_usd(replace(performance, actors=(first, second)), path, frame=frame)
    return Usd.Stage.Open(str(path))


def seen(stage: Usd.Stage, points) -> np.ndarray:
    """Return where points are in the picture: within -1 and 1, both ways, when they are seen."""
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/Performance/Scenery/Camera")).GetCamera(0)
    matrix = np.array(camera.frustum.ComputeViewMatrix() * camera.frustum.ComputeProjectionMatrix())
    projected = np.column_stack([points, np.ones(len(points))]) @ matrix
    assert (projected[:, 3] > 0).all()  # before the camera
    return projected[:, :3] / projected[:, 3:]


def test_bodies_doodles_and_props_are_in_the_picture_at_every_frame(stage):
    everything = []
    for name in ("left_hand", "right_hand"):
        curves = UsdGeom.BasisCurves(stage.GetPrimAtPath(f"/Performance/Doodles/{name}_doodle"))
        everything.append(np.array(curves.GetPointsAttr().Get()))
        dart = UsdGeom.Mesh(stage.GetPrimAtPath(f"/Performance/Props/{name}_prop/Dart"))
        for code in range(49):
            everything.append(skinned(stage, f"/Performance/Actors/{name}_character", code)[::5])
            world = UsdGeom.Xformable(dart).ComputeLocalToWorldTransform(code)
            points = dart.GetPointsAttr().Get()
            everything.append(np.array([world.Transform(point) for point in points]))
    pictured = seen(stage, np.concatenate(everything))
    assert np.abs(pictured).max() < 1.0
    # … and no smaller than need be.
    assert np.abs(pictured[:, :2]).max() > 0.8


@pytest.mark.parametrize("seed", range(10))
def test_the_nearest_place_touches_the_border_of_the_picture(seed):
    rng = np.random.default_rng(seed)
    boxes = np.sort(rng.normal(0.0, 3.0, (5, 2, 3)), axis=1)
    half_width, half_height = 0.45, 0.25
    eye, _ = camera_place(boxes, BACK, half_width, half_height)
    right = np.cross([0.0, 1.0, 0.0], BACK)
    right /= np.linalg.norm(right)
    up = np.cross(BACK, right)
    corners = np.array(
        [[b[i, 0], b[j, 1], b[k, 2]] for b in boxes for i, j, k in np.ndindex(2, 2, 2)]
    )
    away = (eye - corners) @ BACK
    assert (away > 0).all()
    x = (corners - eye) @ right / away / half_width
    y = (corners - eye) @ up / away / half_height
    largest = max(np.abs(x).max(), np.abs(y).max())
    assert largest == pytest.approx(1.0)
    assert x.max() == pytest.approx(-x.min()) or y.max() == pytest.approx(-y.min())
