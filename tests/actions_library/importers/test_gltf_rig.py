"""glTF files without skin as rigs."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.importers import import_file
from actions_library.importers.gltf_rig import read_gltf_rig
from smd.character.kinematics import forward_kinematics
from smd.character.rig import ControlRig
from smd.character.skinning import skin_points
from smd.errors import ImportedFileError
from smd.geometry.rotations import quaternion_about, rotate
from tests.actions_library.importers.test_gltf import animated, appended, document, written

HALF = np.sqrt(0.5)


def lamp() -> dict:
    """A foot that moves, an arm on it that turns, and a shade on that which opens."""
    whole = document()
    whole.pop("skins")
    mesh = whole["meshes"][0]
    primitive = mesh["primitives"][0]
    points = np.array([[0, 0, 0], [0, 1, 0], [1, 1, 0]], dtype="<f4")
    primitive["attributes"] = {"POSITION": appended(whole, points, "VEC3", 5126)}
    opened = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 0]], dtype="<f4")
    primitive["targets"] = [{"POSITION": appended(whole, opened, "VEC3", 5126)}]
    mesh |= {"weights": [0.0], "extras": {"targetNames": ["open"]}}
    whole["nodes"] = [
        {"name": "foot", "children": [1]},
        {"name": "arm", "children": [2], "translation": [0, 2, 0]},
        {"name": "shade", "mesh": 0},
    ]
    whole["scenes"] = [{"nodes": [0]}]
    whole["animations"] = [{"name": "nod", "samplers": [], "channels": []}]
    turns = [[0, 0, 0, 1], [0, 0, HALF, HALF]]
    animated(whole, "translation", [0, 1], [[0, 0, 0], [3, 0, 0]], "LINEAR", node=0)
    animated(whole, "rotation", [0, 1], turns, "LINEAR", node=1)
    animated(whole, "weights", [0, 1], [0.0, 1.0], "LINEAR", node=2)
    return whole


def test_poses_place_the_points_as_the_nodes_say(tmp_path):
    rig: ControlRig = read_gltf_rig(written(tmp_path, lamp()))
    assert rig.controls.names == (
        *(f"foot.translation[{k}]" for k in range(3)),
        *(f"arm.rotation[{k}]" for k in range(4)),
        "open",
    )
    assert rig.controls.rest.tolist() == [0, 0, 0, 0, 0, 0, 1, 0]
    rng = np.random.default_rng(0)
    for _ in range(5):
        move, angle, weight = rng.normal(size=3), rng.uniform(-3, 3), rng.uniform()
        turn = quaternion_about([0.0, 0.0, 1.0], angle)
        (surface,) = rig.surface_m([[*move, *turn, weight]])
        points = np.array([[0, 0, 0], [0, 1, weight], [1, 1, 0]])
        place = move + np.array([0.0, 2.0, 0.0])
        np.testing.assert_allclose(surface, rotate(turn, points) + place, atol=1e-12)
    assert rig.triangles.tolist() == [[0, 1, 2]]


def test_animations_are_poses(tmp_path):
    rig = read_gltf_rig(written(tmp_path, lamp()))
    assert list(rig.animations) == ["nod"]
    nod = rig.animations["nod"]
    assert len(nod) == rig.rate_hz + 1
    assert nod[0].tolist() == rig.controls.rest.tolist()
    assert nod[-1] == pytest.approx(np.array([3, 0, 0, 0, 0, HALF, HALF, 1]), abs=1e-7)
    assert rig.surface_m(nod[-1:])[0, 1] == pytest.approx(np.array([2.0, 2.0, 1.0]), abs=1e-6)


def test_units_and_axes_are_changed(tmp_path):
    path = written(tmp_path, lamp())
    metres, plain = read_gltf_rig(path, up="z", unit_m=0.01), read_gltf_rig(path)
    x, y, z = 0.01 * np.moveaxis(plain.surface_m(plain.animations["nod"]), -1, 0)
    found = metres.surface_m(metres.animations["nod"])
    np.testing.assert_allclose(found, np.stack([x, z, -y], axis=-1), atol=1e-12)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d.update(skins=[{"joints": [0]}]), "a file without skeleton"),
        (lambda d: d.pop("animations"), "animated nodes"),
        (lambda d: [node.pop("mesh", 0) for node in d["nodes"]], "morph targets|a mesh"),
        (lambda d: d["meshes"][0]["primitives"][0].pop("targets"), "morph targets|weights"),
    ],
)
def test_what_is_no_rig_is_refused_in_one_line(tmp_path, change, said):
    whole = lamp()
    change(whole)
    with pytest.raises(ImportedFileError, match=said) as found:
        read_gltf_rig(written(tmp_path, whole))
    assert "\n" not in str(found.value)


def test_the_importer_s_joints_carry_the_same_points(tmp_path):
    """Read as joints and skinned, the same nodes bring the points to the same places."""
    path = written(tmp_path, lamp())
    rig, imported = read_gltf_rig(path), import_file(path)
    (animation,), (mesh,) = imported.animations, imported.meshes
    assert animation.rate_hz == rig.rate_hz
    pose = forward_kinematics(imported.skeleton, animation.rotation_xyzw, animation.translation_m)
    weights = animation.tracks.of(shape.name for shape in mesh.shapes)
    skin = skin_points(mesh, imported.skeleton, *pose, weights)
    np.testing.assert_allclose(rig.surface_m(rig.animations["nod"]), skin, atol=1e-5)
