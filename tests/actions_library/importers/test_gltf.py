from __future__ import annotations

import base64
import json
import struct
from pathlib import Path

import numpy as np
import pytest

from actions_library.importers import import_file
from actions_library.importers.gltf import sampled
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.rotations import quaternion_about, rotate

HALF = np.sqrt(0.5)


def document(**changes) -> dict:
    """A bar of two joints, the upper one turning a quarter about Z in a second."""
    points = np.array([[0, 0, 0], [0, 2, 0], [1, 2, 0]], dtype="<f4")
    joints = np.array([[0, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]], dtype="<u1")
    weights = np.array([[1, 0, 0, 0]] * 3, dtype="<f4")
    inverse = np.tile(np.eye(4, dtype="<f4"), (2, 1, 1))
    inverse[1, 3, 1] = -1.0  # rows are columns of the file
    times = np.array([0.0, 0.5, 1.0], dtype="<f4")
    turns = np.array(
        [[0, 0, 0, 1], [0, 0, np.sin(np.pi / 8), np.cos(np.pi / 8)], [0, 0, HALF, HALF]]
    )
    order = np.array([0, 1, 2], dtype="<u2")
    arrays = [points, joints, weights, inverse, times, turns.astype("<f4"), order]
    kinds = ["VEC3", "VEC4", "VEC4", "MAT4", "SCALAR", "VEC4", "SCALAR"]
    components = [5126, 5121, 5126, 5126, 5126, 5126, 5123]
    data, views, accessors = b"", [], []
    for array, kind, component in zip(arrays, kinds, components, strict=True):
        data += b"\0" * (-len(data) % 4)
        raw = array.tobytes()
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(raw)})
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": component,
                "count": len(array),
                "type": kind,
            }
        )
        data += raw
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    whole = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"name": "lower", "children": [1]},
            {"name": "upper", "translation": [0, 1, 0]},
            {"name": "bar", "mesh": 0, "skin": 0},
        ],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 3}],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "indices": 6}
                ]
            }
        ],
        "animations": [
            {
                "name": "bend",
                "samplers": [{"input": 4, "output": 5}],
                "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
            }
        ],
        "buffers": [{"uri": uri, "byteLength": len(data)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    return {**whole, **changes}


def written(tmp_path: Path, whole: dict | None = None, name: str = "a.gltf") -> Path:
    path = tmp_path / name
    path.write_text(json.dumps(document() if whole is None else whole))
    return path


def test_a_bar_bends_as_its_file_says(tmp_path):
    imported = import_file(written(tmp_path))
    (mesh,), (animation,) = imported.meshes, imported.animations
    assert imported.skeleton.joints == ("lower", "upper")
    assert (animation.name, animation.rate_hz) == ("bend", 24.0)
    assert animation.duration_s == pytest.approx(1.0)
    q, p = forward_kinematics(imported.skeleton, animation.rotation_xyzw, animation.translation_m)
    points = skin_points(mesh, imported.skeleton, q, p)
    np.testing.assert_allclose(points[0], [[0, 0, 0], [0, 2, 0], [1, 2, 0]], atol=1e-6)
    np.testing.assert_allclose(points[-1], [[0, 0, 0], [-1, 1, 0], [-1, 2, 0]], atol=1e-6)


def test_a_glb_says_what_its_gltf_does(tmp_path):
    whole = document()
    data = base64.b64decode(whole["buffers"][0].pop("uri").partition(",")[2])
    text = json.dumps(whole).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(data), 0x004E4942) + data
    path = tmp_path / "a.glb"
    path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)
    one, other = import_file(written(tmp_path)), import_file(path)
    np.testing.assert_array_equal(
        one.animations[0].rotation_xyzw, other.animations[0].rotation_xyzw
    )
    np.testing.assert_array_equal(one.meshes[0].points_m, other.meshes[0].points_m)


def test_scale_and_turn_above_the_joints_are_folded_into_them(tmp_path):
    whole = document()
    whole["nodes"].append({"children": [0], "scale": [0.01] * 3, "rotation": [-HALF, 0, 0, HALF]})
    whole["scenes"] = [{"nodes": [3, 2]}]
    imported = import_file(written(tmp_path, whole))
    _, p = forward_kinematics(
        imported.skeleton,
        imported.skeleton.rest_rotation_xyzw,
        imported.skeleton.rest_translation_m,
    )
    np.testing.assert_allclose(p[1], [0.0, 0.0, -0.01], atol=1e-9)
    assert imported.meshes[0].points_m[1] == pytest.approx([0.0, 0.0, -0.02], abs=1e-9)


def test_every_kind_of_interpolation_is_what_its_formula_says():
    times, at = np.array([0.0, 1.0, 3.0]), np.array([-1.0, 0.0, 0.25, 1.0, 2.0, 3.0, 9.0])
    values = np.array([[0.0], [2.0], [4.0]])
    linear = sampled(times, values, at, "LINEAR", "translation")[:, 0]
    assert linear == pytest.approx([0.0, 0.0, 0.5, 2.0, 3.0, 4.0, 4.0])
    step = sampled(times, values, at, "STEP", "translation")[:, 0]
    assert step == pytest.approx([0.0, 0.0, 0.0, 2.0, 2.0, 4.0, 4.0])
    # Tangents of the cubic t^3 make the spline that cubic itself, whatever the keys' spacing.
    cubic = np.array([[3 * t * t, t**3, 3 * t * t] for t in times]).reshape(-1, 1)
    inside = np.linspace(0.0, 3.0, 13)
    found = sampled(times, cubic, inside, "CUBICSPLINE", "translation")[:, 0]
    assert found == pytest.approx(inside**3)
    turns = np.stack([quaternion_about([0, 1, 0], a) for a in (0.0, 1.0, 2.0)])
    turns[1] *= -1.0  # either sign is the same turn
    half = sampled(times, turns, np.array([0.5, 2.0]), "LINEAR", "rotation")
    ahead = rotate(half, np.broadcast_to([0.0, 0.0, 1.0], (2, 3)))
    assert np.arctan2(ahead[:, 0], ahead[:, 2]) == pytest.approx([0.5, 1.5])


def test_several_skins_share_one_skeleton_and_loose_pieces_go_with_their_joint(shared_data):
    knight = import_file(shared_data / "clips" / "gltf" / "Knight.glb")
    assert len(knight.skeleton) == 41
    assert len(knight.animations) == 76
    assert 1 < len(knight.meshes) <= 12
    hand = knight.skeleton.index("handslot.r")
    carried = [np.unique(m.joint_indices[m.joint_weights == 1.0]) for m in knight.meshes]
    assert any(hand in joints for joints in carried)


def test_animations_without_a_mesh_are_read_and_what_vanishes_is_left_out(shared_data):
    pack = import_file(shared_data / "clips" / "gltf" / "Med_General.glb")
    assert pack.meshes == ()
    assert any("Spawn" in note for note in pack.notes)
    assert not any("Spawn" in a.name for a in pack.animations)


@pytest.mark.parametrize("name", ["CesiumMan", "RiggedFigure"])
def test_gltf_and_usd_hold_the_same_figure(shared_data, name):
    """Two readers of two formats; the files may face differently, by quarter turns."""
    one = import_file(shared_data / "clips" / "gltf" / name / "glTF-Binary" / f"{name}.glb")
    other = import_file(shared_data / "clips" / "usd" / f"{name}.usdz")
    rest = [
        forward_kinematics(s, s.rest_rotation_xyzw, s.rest_translation_m)[1]
        for s in (one.skeleton, other.skeleton)
    ]
    points = [np.concatenate([m.points_m for m in x.meshes]) for x in (one, other)]
    worst = {}
    for quarter in range(4):
        turn = quaternion_about([0.0, 1.0, 0.0], quarter * np.pi / 2)
        turned = rotate(turn, rest[1])
        apart = np.linalg.norm(rest[0][:, None] - turned[None], axis=-1)
        spans = np.ptp(points[0], axis=0) - np.ptp(rotate(turn, points[1]), axis=0)
        worst[quarter] = max(apart.min(axis=0).max(), apart.min(axis=1).max(), np.abs(spans).max())
    assert min(worst.values()) < 1e-4
