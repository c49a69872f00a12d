from __future__ import annotations

import base64
import json
import struct
from pathlib import Path

import numpy as np
import pytest

from actions_library.importers import import_file
from actions_library.importers.gltf_animations import sampled
from actions_library.importers.gltf_file import GltfFile
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.errors import ImportedFileError
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


def appended(whole: dict, array: np.ndarray, kind: str, component: int, **more) -> int:
    """Add a buffer with an accessor to a document; return the accessor's index."""
    raw = array.tobytes()
    uri = "data:application/octet-stream;base64," + base64.b64encode(raw).decode()
    whole["buffers"].append({"uri": uri, "byteLength": len(raw)})
    view = {"buffer": len(whole["buffers"]) - 1, "byteLength": len(raw)}
    whole["bufferViews"].append(view)
    whole["accessors"].append(
        {
            "bufferView": len(whole["bufferViews"]) - 1,
            "componentType": component,
            "count": len(array),
            "type": kind,
            **more,
        }
    )
    return len(whole["accessors"]) - 1


def animated(whole: dict, path: str, times, values, manner: str, node: int = 1) -> dict:
    """Give a document one channel more."""
    values = np.asarray(values, dtype="<f4")
    kind = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[1 if values.ndim == 1 else values.shape[1]]
    animation = whole["animations"][0]
    animation["samplers"].append(
        {
            "input": appended(whole, np.asarray(times, dtype="<f4"), "SCALAR", 5126),
            "output": appended(whole, values, kind, 5126),
            "interpolation": manner,
        }
    )
    target = {"node": node, "path": path}
    animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": target})
    return whole


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


def test_channels_of_every_manner_follow_their_closed_forms_through_a_whole_file(tmp_path):
    cubic = [[0, 3 * t * t, 0, 0, t**3, 0, 0, 3 * t * t, 0] for t in (0.0, 1.0, 2.0)]
    for manner, values, form in (
        ("STEP", [[0, 1, 0], [0, 2, 0], [0, 3, 0]], lambda t: 1 + np.floor(t + 1e-6)),
        ("LINEAR", [[0, 1, 0], [0, 2, 0], [0, 3, 0]], lambda t: 1 + t),
        ("CUBICSPLINE", np.reshape(cubic, (-1, 3)), lambda t: t**3),
    ):
        whole = animated(document(), "translation", [0, 1, 2], values, manner)
        (animation,) = import_file(written(tmp_path, whole)).animations
        t = np.arange(len(animation.translation_m)) / animation.rate_hz
        np.testing.assert_allclose(animation.translation_m[:, 1, 1], form(t), atol=1e-5)


def test_an_interpolation_test_of_another_s_making_is_read(shared_data):
    path = shared_data / "clips" / "gltf" / "interpolation_test.gltf"
    if not path.with_suffix(".bin").is_file():
        pytest.skip(f"its numbers are absent: {path.with_suffix('.bin')}")
    imported = import_file(path)
    assert len(imported.animations) == 9


def test_channels_that_are_constant_may_have_two_keys_far_apart(tmp_path):
    whole = animated(document(), "translation", [0, 7], [[0, 1, 0], [0, 1, 0]], "LINEAR")
    (animation,) = import_file(written(tmp_path, whole)).animations
    assert animation.duration_s == pytest.approx(7.0)
    np.testing.assert_allclose(animation.translation_m[:, 1], [[0, 1, 0]] * 169, atol=1e-7)


def test_a_smooth_scale_is_not_taken_for_one_that_vanishes(tmp_path):
    keys = [[0] * 3, [1] * 3, [0] * 3, [0] * 3, [2] * 3, [0] * 3]
    whole = animated(document(), "scale", [0, 1], keys, "CUBICSPLINE", node=0)
    imported = import_file(written(tmp_path, whole))
    assert imported.notes == ()
    (animation,) = imported.animations
    assert animation.translation_m[-1, 1] == pytest.approx([0, 2, 0])


def test_sparse_interleaved_and_normalised_numbers_are_read(tmp_path):
    whole = document()
    plain = import_file(written(tmp_path, whole)).meshes[0]
    row = np.zeros(3, dtype=[("p", "<f4", 3), ("w", "<u2", 4), ("j", "u1", 4)])
    row["p"], row["w"], row["j"][1:, 0] = [[0, 0, 0], [0, 2, 0], [1, 0, 0]], [65535, 0, 0, 0], 1
    first = appended(whole, row, "VEC3", 5126)
    view = whole["accessors"][first]["bufferView"]
    whole["bufferViews"][view]["byteStride"] = row.itemsize
    whole["accessors"] += [
        {**whole["accessors"][first], "byteOffset": 12, "type": "VEC4", "componentType": 5123}
        | {"normalized": True},
        {**whole["accessors"][first], "byteOffset": 20, "type": "VEC4", "componentType": 5121},
    ]
    at = appended(whole, np.array([2], dtype="<u2"), "SCALAR", 5123)
    new = appended(whole, np.array([[1, 2, 0]], dtype="<f4"), "VEC3", 5126)
    whole["accessors"][first]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": whole["accessors"][at]["bufferView"], "componentType": 5123},
        "values": {"bufferView": whole["accessors"][new]["bufferView"]},
    }
    whole["meshes"][0]["primitives"][0]["attributes"] = {
        "POSITION": first,
        "WEIGHTS_0": first + 1,
        "JOINTS_0": first + 2,
    }
    mesh = import_file(written(tmp_path, whole)).meshes[0]
    np.testing.assert_array_equal(mesh.points_m, plain.points_m)
    np.testing.assert_allclose(mesh.joint_weights, plain.joint_weights, atol=1e-12)
    np.testing.assert_array_equal(mesh.joint_indices, plain.joint_indices)


def test_a_node_s_matrix_says_what_its_parts_would(tmp_path):
    whole = document()
    plain = import_file(written(tmp_path, whole))
    whole["nodes"][1] = {
        "name": "upper",
        "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1],
    }
    imported = import_file(written(tmp_path, whole))
    np.testing.assert_allclose(
        imported.skeleton.rest_translation_m, plain.skeleton.rest_translation_m
    )


def test_buffers_lie_in_the_file_s_own_folder_or_below(tmp_path):
    whole = document()
    data = base64.b64decode(whole["buffers"][0]["uri"].partition(",")[2])
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "a b.bin").write_bytes(data)
    whole["buffers"][0]["uri"] = "parts/a%20b.bin"
    assert len(import_file(written(tmp_path, whole)).skeleton) == 2


def morphed() -> dict:
    """The arm with two morph targets of one name, the second at a quarter."""
    whole = document()
    moved = np.array([[0, 0, 0.5], [0, 0, 0], [1, 0, 0]], dtype="<f4")
    first = appended(whole, moved, "VEC3", 5126)
    second = appended(whole, -moved, "VEC3", 5126)
    mesh = whole["meshes"][0]
    mesh["primitives"][0]["targets"] = [{"POSITION": first}, {"POSITION": second}]
    mesh |= {"weights": [0.0, 0.25], "extras": {"targetNames": ["smile", "smile"]}}
    return whole


def test_morph_targets_come_with_their_offsets(tmp_path):
    imported = import_file(written(tmp_path, morphed()))
    assert imported.shapes == ("smile", "smile_2")
    (mesh,) = imported.meshes
    for shape, sign in zip(mesh.shapes, (1.0, -1.0), strict=True):
        moved = np.zeros((3, 3))
        moved[shape.indices] = sign * shape.offsets_m
        assert moved == pytest.approx(np.array([[0, 0, 0.5], [0, 0, 0], [1, 0, 0]]))
    assert imported.rest_tracks.of(imported.shapes).tolist() == [[0.0, 0.25]]


def test_weights_of_morph_targets_are_sampled(tmp_path):
    whole = morphed()
    still = import_file(written(tmp_path, whole)).animations[0].tracks
    assert still.of(["smile", "smile_2"]) == pytest.approx(np.tile([0.0, 0.25], (len(still), 1)))
    animated(whole, "weights", [0, 1], [0.0, 0.5, 1.0, 0.5], "LINEAR", node=2)
    (animation,) = import_file(written(tmp_path, whole)).animations
    assert animation.tracks.names == ("smile", "smile_2")
    assert animation.tracks.value.shape == (25, 2)
    np.testing.assert_allclose(animation.tracks.value[:, 0], np.arange(25) / 24, atol=1e-6)
    np.testing.assert_allclose(animation.tracks.value[:, 1], 0.5)


def test_a_morph_target_that_moves_nothing_is_left_out(tmp_path):
    whole = morphed()
    nothing = appended(whole, np.zeros((3, 3), dtype="<f4"), "VEC3", 5126)
    whole["meshes"][0]["primitives"][0]["targets"][0] = {"POSITION": nothing}
    imported = import_file(written(tmp_path, whole))
    assert imported.shapes == ("smile_2",)
    assert imported.animations[0].tracks.names == ("smile_2",)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (np.zeros((2, 3)), r"targets\[1\]: expected 3 offsets of 3 numbers, found \(2, 3\)"),
        (np.zeros((4, 3)), r"targets\[1\]: expected 3 offsets of 3 numbers, found \(4, 3\)"),
        (np.full((3, 3), np.nan), r"targets\[1\]: expected finite offsets"),
        (np.full((3, 3), np.inf), r"targets\[1\]: expected finite offsets"),
    ],
)
def test_damaged_morph_targets_are_refused_in_one_line(tmp_path, rows, said):
    whole = morphed()
    bad = appended(whole, rows.astype("<f4"), "VEC3", 5126)
    whole["meshes"][0]["primitives"][0]["targets"][1] = {"POSITION": bad}
    with pytest.raises(ImportedFileError, match=said) as found:
        import_file(written(tmp_path, whole))
    assert "\n" not in str(found.value)


def test_weights_without_morph_targets_and_too_many_of_them_are_refused(tmp_path):
    whole = document()
    animated(whole, "weights", [0, 1], [0.0, 1.0], "LINEAR", node=2)
    with pytest.raises(ImportedFileError, match="node 2: expected morph targets of its weights"):
        import_file(written(tmp_path, whole))
    whole = morphed()
    whole["meshes"][0]["primitives"][0]["targets"] *= 5000
    del whole["meshes"][0]["weights"]
    with pytest.raises(ImportedFileError, match="at most 4096 morph targets"):
        import_file(written(tmp_path, whole))


def test_real_morph_targets_open_the_robot_s_face(shared_data):
    """Its head is of several colours, cut into meshes; each of its points is in one of them."""
    path = shared_data / "clips" / "gltf" / "RobotExpressive.glb"
    robot = import_file(path)
    file = GltfFile(path)
    targets = [
        (file.accessor(target["POSITION"], "x") != 0.0).any(axis=1).sum()
        for mesh in file.document["meshes"]
        for primitive in mesh["primitives"]
        for target in primitive.get("targets", [])
    ]
    moved = [len(shape.indices) for mesh in robot.meshes for shape in mesh.shapes]
    assert sum(moved) >= sum(targets) > 1000  # a point on the border of two colours is in both
    assert robot.shapes == ("Angry", "Surprised", "Sad")
    assert {a.tracks.names for a in robot.animations if a.tracks.names} <= {robot.shapes}


@pytest.mark.parametrize(("other", "names"), [(0.5, {"smile"}), (0.6, {"smile", "smile_2"})])
def test_shapes_of_one_name_are_one_where_they_always_weigh_the_same(tmp_path, other, names):
    """A face of two meshes has a smile in each of them."""
    whole = morphed()
    mesh = whole["meshes"][0]
    mesh["primitives"][0]["targets"].pop()
    mesh |= {"weights": [0.0], "extras": {"targetNames": ["smile"]}}
    whole["meshes"].append({**mesh, "name": "lips"})
    whole["nodes"].append({**whole["nodes"][2], "mesh": 1})
    whole["scenes"][0]["nodes"].append(3)
    for node, end in ((2, 0.5), (3, other)):
        animated(whole, "weights", [0, 1], [0.0, end], "LINEAR", node=node)
    imported = import_file(written(tmp_path, whole))
    assert {*imported.shapes} == names
    for animation in imported.animations:
        assert {*animation.tracks.names} <= names
    moved = sum(len(shape.indices) for mesh in imported.meshes for shape in mesh.shapes)
    assert moved == 4


def test_gltf_and_usd_move_the_same_figure_alike(shared_data):
    """CesiumMan's glTF starts a 24th of a second before its USD; and turns a quarter."""
    for name, quarter, rows in (
        ("CesiumMan", 1, (slice(1, None), slice(None))),
        ("RiggedFigure", 0, (slice(0, 36, 5), slice(0, 29, 4))),  # 30 and 24 Hz: each 1/6 s
    ):
        one = import_file(shared_data / "clips" / "gltf" / name / "glTF-Binary" / f"{name}.glb")
        other = import_file(shared_data / "clips" / "usd" / f"{name}.usdz")
        turn = quaternion_about([0.0, 1.0, 0.0], quarter * np.pi / 2)
        rests, moving = [], []
        for x in (one, other):
            s, a = x.skeleton, x.animations[0]
            rests.append(forward_kinematics(s, s.rest_rotation_xyzw, s.rest_translation_m)[1])
            moving.append(forward_kinematics(s, a.rotation_xyzw, a.translation_m)[1])
        apart = np.linalg.norm(rests[0][:, None] - rotate(turn, rests[1])[None], axis=-1)
        same = apart.argmin(axis=1)
        assert sorted(same) == list(range(len(same)))
        theirs = rotate(turn, moving[1][rows[1]])[:, same]
        np.testing.assert_allclose(moving[0][rows[0]], theirs, atol=1e-4)
