"""Files without skeleton as rigs: what USD evaluates is what their own animation shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom

from actions_library.importers.usd_rig import read_usd_rig
from smd.character.rig import ControlRig
from smd.errors import CharacterError, ImportedFileError

LAMP = """#usda 1.0
(
    upAxis = "Z"
    metersPerUnit = 0.01
    timeCodesPerSecond = 10
)
def Xform "Lamp"
{
    double3 xformOp:translate = (10, 0, 0)
    double3 xformOp:translate.timeSamples = { 0: (10, 0, 0), 10: (20, 0, 5) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Xform "Arm"
    {
        float xformOp:rotateX = 30
        float xformOp:rotateX.timeSamples = { 0: 0, 5: 90, 10: 60 }
        quatf xformOp:orient.timeSamples = { 0: (1, 0, 0, 0), 10: (0.8, 0, 0, 0.6) }
        uniform token[] xformOpOrder = ["xformOp:rotateX", "xformOp:orient"]
        def Mesh "Shade"
        {
            int[] faceVertexCounts = [4]
            int[] faceVertexIndices = [0, 1, 2, 3]
            point3f[] points.timeSamples = {
                0: [(0, 0, 0), (1, 0, 0), (1, 2, 0), (0, 2, 0)],
                10: [(0, 0, 0), (1, 0, 0), (1, 2, 1), (0, 2, 1)],
            }
        }
    }
    def SphereLight "Bulb"
    {
        float inputs:intensity.timeSamples = { 0: 1, 10: 50 }
        color3f inputs:color.timeSamples = { 0: (1, 1, 1), 10: (1, 0.5, 0) }
        token visibility.timeSamples = { 0: "inherited", 10: "invisible" }
    }
    def Mesh "Foot"
    {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (5, 0, 0), (0, 5, 0)]
    }
}
"""


def written(tmp_path, text: str = LAMP) -> Path:
    path = tmp_path / "lamp.usda"
    path.write_text(text)
    return path


def plain_surface_m(path: Path, code: float) -> np.ndarray:
    """Return all points at a time code, from the file itself."""
    stage = Usd.Stage.Open(str(path))
    cache, found = UsdGeom.XformCache(code), []
    for prim in stage.Traverse():
        if prim.IsA(UsdGeom.Mesh):
            place = cache.GetLocalToWorldTransform(prim)
            points = UsdGeom.Mesh(prim).GetPointsAttr().Get(code)
            found += [place.Transform(point) for point in points]
    x, y, z = 0.01 * np.array(found).T
    return np.stack([x, z, -y], axis=-1)


def test_the_file_s_own_animation_is_what_its_poses_show(tmp_path):
    path = written(tmp_path)
    rig = read_usd_rig(path)
    assert (len(rig.animations["lamp"]), rig.rate_hz) == (11, 10.0)
    surface = rig.surface_m(rig.animations["lamp"])
    for code in range(11):
        np.testing.assert_allclose(surface[code], plain_surface_m(path, code), atol=1e-6)
    assert np.ptp(surface, axis=0).max() > 0.02


def test_a_pose_of_one_s_own_is_evaluated(tmp_path):
    """A quarter turn about X takes the shade's far edge from +Y up to +Z, our +Y."""
    rig: ControlRig = read_usd_rig(written(tmp_path))
    pose = dict(zip(rig.controls.names, rig.controls.rest, strict=True))
    pose["/Lamp/Arm.xformOp:rotateX"] = 90.0
    pose["/Lamp.xformOp:translate[0]"] = 100.0
    (surface,) = rig.surface_m([list(pose.values())])
    assert surface[:4] == pytest.approx(
        np.array([[1.0, 0, 0], [1.01, 0, 0], [1.01, 0.02, 0], [1.0, 0.02, 0]]), abs=1e-7
    )
    assert surface[4:] == pytest.approx(np.array([[1.0, 0, 0], [1.05, 0, 0], [1.0, 0, -0.05]]))


def test_controls_have_the_file_s_rest_and_ranges(tmp_path):
    rig = read_usd_rig(written(tmp_path))
    at = {name: k for k, name in enumerate(rig.controls.names)}
    assert len(at) == 3 + 1 + 4 + 12 + 1 + 3
    turn = at["/Lamp/Arm.xformOp:rotateX"]
    parts = (rig.controls.low[turn], rig.controls.rest[turn], rig.controls.high[turn])
    assert parts == (0.0, 30.0, 90.0)
    glow = at["/Lamp/Bulb.inputs:intensity"]
    assert (rig.controls.rest[glow], rig.controls.high[glow]) == (1.0, 50.0)
    assert rig.notes == ("/Lamp/Bulb.visibility is animated, but no number",)


def test_one_rig_leaves_the_file_and_another_rig_alone(tmp_path):
    path = written(tmp_path)
    one, other = read_usd_rig(path), read_usd_rig(path)
    before = other.surface_m(other.animations["lamp"][:1])
    one.surface_m(one.animations["lamp"][-1:])
    assert np.array_equal(other.surface_m(other.animations["lamp"][:1]), before)
    assert path.read_text() == LAMP


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("(1, 2, 1), (0, 2, 1)]", "(1, 2, 1)]", "Shade.points, time code .*: expected 12 finite"),
        ("10: 60", "10: nan", "rotateX, time code .*: expected 1 finite"),
        (
            "int[] faceVertexCounts = [4]\n",
            "int[] faceVertexCounts.timeSamples = { 0: [4], 10: [3] }\n",
            "faceVertexCounts: expected the same faces at all times",
        ),
        ("def SphereLight", "def Skeleton", "Bulb: expected a file without skeleton"),
        ("def Mesh", "def Xform", "a mesh that is seen"),
        ("timeSamples", "other", "usda|animated numbers"),
        ("metersPerUnit = 0.01", "metersPerUnit = 0", "unit"),
    ],
)
def test_what_is_no_rig_is_refused_in_one_line(tmp_path, old, new, said):
    assert old in LAMP
    with pytest.raises(ImportedFileError, match=said) as found:
        read_usd_rig(written(tmp_path, LAMP.replace(old, new)))
    assert "\n" not in str(found.value)
    assert "lamp.usda" in str(found.value)


def test_an_attribute_that_changes_its_type_from_layer_to_layer_is_refused(tmp_path):
    written(tmp_path)
    over = (
        "#usda 1.0\n( subLayers = [@./lamp.usda@] )\n"
        'over "Lamp"\n{\nover "Arm"\n{\ndouble3 xformOp:rotateX\n}\n}\n'
    )
    (tmp_path / "over.usda").write_text(over)
    with pytest.raises(ImportedFileError, match="rotateX: expected values of its type double3"):
        read_usd_rig(tmp_path / "over.usda")


def test_a_missing_file_and_other_poses_are_refused(tmp_path):
    with pytest.raises(ImportedFileError, match="a USD file"):
        read_usd_rig(tmp_path / "none.usda")
    with pytest.raises(CharacterError, match=r"poses: expected shape \(any, 24\)"):
        read_usd_rig(written(tmp_path)).surface_m([[0.0]])
