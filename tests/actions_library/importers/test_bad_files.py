"""Files that are damaged, or that mean harm: one line, little memory, little time."""

from __future__ import annotations

import base64
import copy
import functools
import io
import json
import os
import re
import struct
import tempfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image
from pxr import Sdf

from actions_library.importers import import_file
from smd.errors import ImportedFileError
from tests.actions_library.importers.test_bvh import ARM
from tests.actions_library.importers.test_gltf import document
from tests.actions_library.importers.test_usd import ARM as USD_ARM


def refused(path: Path, *said: str, **options) -> None:
    with pytest.raises(ImportedFileError) as error:
        import_file(path, **options)
    message = str(error.value)
    assert str(path) in message
    assert "expected" in message and "found" in message and "\n" not in message
    for words in said:
        assert words in message


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("HIERARCHY", "HIERARCHIE", "line 1"),
        ("ROOT Hips", "JOINT Hips", "line 2"),
        ("JOINT Neck", "ROOT Neck", "line 6"),
        ("OFFSET 0 1.5 0", "OFFSET 0 1.5", "line 8"),
        ("OFFSET 0 1.5 0", "OFFSET 0 nan 0", "line 8"),
        ("CHANNELS 3", "CHANNELS 4", "line 9"),
        ("CHANNELS 3 Yrotation", "CHANNELS 3 Wrotation", "line 9"),
        ("CHANNELS 3", "CHANNELS -3", "line 9"),
        ("\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 2.5e-1 0\n\t\t}\n", "\t\tTail\n", "line 10"),
        ("Frames: 2", "Frames: 3", "3 frames"),
        ("Frames: 2", "Frames: 0", "Frames"),
        ("Frames: 2", "Frames: 1", "1 frames"),
        ("Frames: 2", "Frames: 199999999", "Frames"),
        ("OFFSET 0 1.5 0", "OFFSET 0 1_5 0", "line 8"),
        ("Frames: 2", "Frames: 1e99", "Frames"),
        ("Frames: 2", "Frames: two", "line 17"),
        ("Frame Time: 0.04", "Frame Time: 0", "Frame Time"),
        ("Frame Time: 0.04", "Frame Time: -1", "Frame Time"),
        ("1 2 3 90", "1 2 90", "line 20"),
        ("1 2 3 90", "1 2 nan 90", "frame 1"),
        ("1 2 3 90", "1 2 three 90", "MOTION"),
        ("MOTION", "EMOTION", "MOTION"),
        ("\t}\n}\nMOTION", "\t}\nMOTION", "MOTION"),
    ],
)
def test_a_bvh_is_refused_with_the_place(tmp_path, old, new, said):
    assert old in ARM
    path = tmp_path / "a.bvh"
    path.write_text(ARM.replace(old, new))
    refused(path, said)


def test_a_bvh_of_endless_braces_or_two_names_alike(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_text("HIERARCHY\nROOT a\n" + "{\nOFFSET 0 0 0\nJOINT a\n" * 100_000 + "MOTION\n")
    refused(path, "brace")
    path.write_text(ARM.replace("Neck", "Hips"))
    assert import_file(path).skeleton.joints == ("Hips", "Hips_2", "Hips_end")


def test_a_bone_without_length_is_a_bone(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_text(ARM.replace("OFFSET 0 1.5 0", "OFFSET 0 0 0"))
    assert len(import_file(path).skeleton) == 3


CHANGES = {
    "no glTF 2": (lambda d: d["asset"].update(version="1.0"), "asset.version"),
    "a cycle of nodes": (lambda d: d["nodes"][1].update(children=[0]), "tree"),
    "a node twice": (lambda d: d["nodes"][2].update(children=[1]), "tree"),
    "a child that is not": (lambda d: d["nodes"][0].update(children=[9]), "children"),
    "a negative child": (lambda d: d["nodes"][0].update(children=[-1]), "children"),
    "a NaN place": (lambda d: d["nodes"][1].update(translation=[0, float("nan"), 0]), "nodes[1]"),
    "a zero scale": (lambda d: d["nodes"][0].update(scale=[0, 1, 1]), "scales above zero"),
    "a joint twice": (lambda d: d["skins"][0].update(joints=[0, 0]), "skins[0]"),
    "no inverse": (lambda d: d["skins"][0].update(inverseBindMatrices=4), "matrices"),
    "a negative count": (lambda d: d["accessors"][4].update(count=-3), "accessors[4].count"),
    "a huge count": (lambda d: d["accessors"][4].update(count=10**12), "accessors[4]"),
    "values outside": (lambda d: d["accessors"][4].update(byteOffset=4000), "accessors[4]"),
    "a view outside": (lambda d: d["bufferViews"][0].update(byteLength=10**9), "bufferViews[0]"),
    "a negative offset": (lambda d: d["bufferViews"][0].update(byteOffset=-1), "byteOffset"),
    "a short buffer": (lambda d: d["buffers"][0].update(byteLength=10**9), "buffers[0]"),
    "a path out": (lambda d: d["buffers"][0].update(uri="../../etc/passwd"), "same folder"),
    "an absolute path": (lambda d: d["buffers"][0].update(uri="/etc/passwd"), "same folder"),
    "a hidden path out": (lambda d: d["buffers"][0].update(uri="%2e%2e/secret"), "same folder"),
    "an address": (lambda d: d["buffers"][0].update(uri="http://a.b/c"), "same folder"),
    "a zero byte": (lambda d: d["buffers"][0].update(uri="a\0b"), "a file's name"),
    "a name too long": (lambda d: d["buffers"][0].update(uri="a" * 5000), "a file's name"),
    "no ASCII": (lambda d: d["buffers"][0].update(uri="data:;base64,é"), "base64"),
    "a number too large": (lambda d: d["nodes"][1].update(translation=[10**400, 0, 0]), "nodes[1]"),
    "compressed meshes": (
        lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]),
        "extensionsRequired",
    ),
    "a channel twice": (
        lambda d: d["animations"][0].update(channels=d["animations"][0]["channels"] * 2),
        "one channel",
    ),
    "uneven targets": (
        lambda d: d["meshes"][0]["primitives"].append(
            {**d["meshes"][0]["primitives"][0], "targets": [{}]}
        ),
        "targets",
    ),
    "no base64": (
        lambda d: d["buffers"][0].update(uri="data:application/octet-stream;base64,@@"),
        "base64",
    ),
    "another interpolation": (
        lambda d: d["animations"][0]["samplers"][0].update(interpolation="WILD"),
        "LINEAR",
    ),
    "too few values": (lambda d: d["accessors"][5].update(count=2), "rotation"),
    "no joints of points": (
        lambda d: d["meshes"][0]["primitives"][0]["attributes"].pop("JOINTS_0"),
        "JOINTS_0",
    ),
    "nothing that moves": (lambda d: (d.pop("skins"), d.pop("animations")), "skin"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_gltf_is_refused_with_the_place(tmp_path, change):
    whole = document()
    alter, said = CHANGES[change]
    alter(whole)
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(whole))
    refused(path, said)


def chain(whole: dict, count: int) -> dict:
    """Give a document so many joints, one below another."""
    whole["nodes"] = [{"children": [i + 1]} for i in range(count - 1)] + [
        {},
        {"mesh": 0, "skin": 0},
    ]
    whole["skins"] = [{"joints": list(range(count))}]
    return whole


def test_joints_may_be_many_but_not_endless(tmp_path):
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(chain(document(), 192)))
    assert import_file(path).skeleton.joints[-1] == "joint_191"
    path.write_text(json.dumps(chain(document(), 193)))
    refused(path, "one below another")
    path.write_text(json.dumps(chain(document(), 20_000)))
    refused(path, "1024 joints")


def test_names_are_unique_and_can_be_written(tmp_path):
    whole = document()
    whole["nodes"][0]["name"] = whole["nodes"][1]["name"] = "a\n\ud800"
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(whole))
    assert import_file(path).skeleton.joints == ("a__", "a___2")


@pytest.mark.parametrize("kind", ["EPS", "GIF", "PNG"])
def test_only_pictures_of_gltf_s_own_kinds_are_opened(tmp_path, kind):
    """EPS would be drawn by another program; this PNG lacks its second half."""
    whole, data = document(), io.BytesIO()
    Image.new("RGB", (64, 64)).save(data, kind)
    half = data.getvalue() if kind != "PNG" else data.getvalue()[:60]
    uri = "data:image/png;base64," + base64.b64encode(half).decode()
    whole["images"], whole["textures"] = [{"uri": uri}], [{"source": 0}]
    whole["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    whole["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC2"})
    primitive = whole["meshes"][0]["primitives"][0]
    primitive["attributes"]["TEXCOORD_0"] = len(whole["accessors"]) - 1
    primitive["material"] = 0
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(whole))
    refused(path, "picture")


def test_a_link_out_of_the_folder_is_no_way_out(tmp_path):
    (tmp_path / "secret.bin").write_bytes(bytes(4000))
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "a.bin").symlink_to(tmp_path / "secret.bin")
    whole = document()
    whole["buffers"][0]["uri"] = "a.bin"
    (inside / "a.gltf").write_text(json.dumps(whole))
    refused(inside / "a.gltf", "same folder")


def test_keys_that_are_no_numbers_or_go_back_are_refused(tmp_path):
    for at, value, said in ((1, float("nan"), "finite keys"), (1, 2.0, "increase")):
        whole = document()
        head, _, text = whole["buffers"][0]["uri"].partition(",")
        data = bytearray(base64.b64decode(text))
        struct.pack_into("<f", data, whole["bufferViews"][4]["byteOffset"] + 4 * at, value)
        whole["buffers"][0]["uri"] = head + "," + base64.b64encode(bytes(data)).decode()
        path = tmp_path / "a.gltf"
        path.write_text(json.dumps(whole))
        refused(path, said)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("deep.usda", b"#usda 1.0\n" + b'def "a" {' * 100_000),
        ("deep.gltf", b"[" * 100_000),
        ("deep2.gltf", b'{"a":' * 100_000),
        ("empty.gltf", b""),
        ("list.gltf", b"[]"),
        ("wrong.glb", b"FBX " + bytes(100)),
        ("short.glb", b"glTF" + struct.pack("<II", 2, 4000) + bytes(20)),
        ("chunk.glb", b"glTF" + struct.pack("<IIII", 2, 28, 4000, 0x4E4F534A) + bytes(8)),
        ("empty.usdc", b""),
        ("wrong.usda", b"#usda 9.0\nthis is no USD"),
        ("wrong.usdc", b"PXR-USDC" + bytes(200)),
        ("wrong.usdz", b"PK\x03\x04" + bytes(60)),
        ("nothing.usda", b'#usda 1.0\ndef Xform "A" {}\n'),
        ("picture.png", bytes(20)),
    ],
)
def test_other_things_are_refused(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data)
    refused(path)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("timeCodesPerSecond = 10", "timeCodesPerSecond = 0", "timeCodesPerSecond"),
        ("timeCodesPerSecond = 10", "timeCodesPerSecond = nan", "timeCodesPerSecond"),
        ("metersPerUnit = 1", "metersPerUnit = -1", "unit"),
        ('["Upper", "Upper/Lower"]', '["Upper/Lower", "Upper"]', "/Root/Arm"),
        ('["Upper", "Upper/Lower"]', '["Upper", "Upper"]', "/Root/Arm"),
        ('["Upper", "Upper/Lower"]', "[]", "no joints"),
        ("(0,0,1,0),(0,2,0,1))]", "(0,0,0,0),(0,2,0,1))]", "with an inverse"),
        ("10: [(0, 4, 0)]", "1e9: [(0, 4, 0)]", "frames"),
        ("10: [(0, 4, 0)]", "10: [(0, nan, 0)]", "/Root/Move.translations"),
        ("10: [(0, 4, 0)]", "10: []", "/Root/Move.translations"),
        ("faceVertexCounts = [4]", "faceVertexCounts = [-4]", "/Root/Skin"),
        ("faceVertexCounts = [4]", "faceVertexCounts = [5]", "/Root/Skin"),
        ("[0, 1, 2, 3]", "[0, 1, 2, 4]", "0 to 3"),
        ("jointIndices = [0,1", "jointIndices = [0,7", "0 to 1"),
        ("jointIndices = [0,1,", "jointIndices = [0,", "joint indices and weights"),
        ("float[] primvars:skel:jointW", "string[] primvars:skel:jointW", "USD file"),
        ("elementSize = 6", "elementSize = 0", "joint indices and weights"),
    ],
)
def test_a_usd_is_refused_with_the_place(tmp_path, old, new, said):
    assert old in USD_ARM
    path = tmp_path / "a.usda"
    path.write_text(USD_ARM.replace(old, new))
    refused(path, said)


def test_a_skeleton_that_is_not_there(tmp_path):
    path = tmp_path / "a.usda"
    path.write_text(USD_ARM)
    refused(path, "/Root/Arm", "/Root/Other", skeleton="Leg")
    path = tmp_path / "a.bvh"
    path.write_text(ARM)
    refused(path, "skeleton", skeleton="Hips")


@pytest.mark.parametrize("kind", ["above", "absolute", "link", "pipe", "expression"])
@pytest.mark.parametrize("manner", ["subLayers", "references", "payload"])
def test_a_usd_does_not_lead_out_of_its_asset(tmp_path, kind, manner):
    (tmp_path / "secret.usda").write_text(USD_ARM)
    inside = tmp_path / "asset" / "clips"
    inside.mkdir(parents=True)
    (inside / "link.usda").symlink_to(tmp_path / "secret.usda")
    if kind == "pipe":
        if not hasattr(os, "mkfifo"):
            pytest.skip("no named pipes on this system")
        os.mkfifo(inside / "pipe.usda")
    name = {
        "above": "../../secret.usda",
        "absolute": str(tmp_path / "secret.usda"),
        "link": "./link.usda",
        "pipe": "./pipe.usda",
        "expression": '`"../../${X}.usda"`',
    }[kind]
    variable = 'expressionVariables = { string X = "secret" }'
    if manner == "subLayers":
        text = f"#usda 1.0\n(\n{variable}\nsubLayers = [@{name}@]\n)\n"
    else:
        text = f'#usda 1.0\n(\n{variable}\n)\ndef "A" ({manner} = @{name}@</Root>)\n{{\n}}\n'
    path = inside / "a.usda"
    path.write_text(text)
    refused(path, "layers")
    if kind in ("above", "absolute"):
        with zipfile.ZipFile(inside / "a.usdz", "w") as archive:
            archive.writestr("a.usda", text)
        refused(inside / "a.usdz")


def test_value_clips_are_refused(tmp_path):
    clips = """clips = { dictionary default = {
        asset[] assetPaths = [@../secret.usda@] } }"""
    path = tmp_path / "a.usda"
    path.write_text(USD_ARM.replace('def SkelRoot "Root"\n', f'def SkelRoot "Root" ({clips})\n'))
    refused(path, "value clips")


def test_a_link_in_an_archive_is_refused(tmp_path):
    path = tmp_path / "a.usdz"
    with zipfile.ZipFile(path, "w") as archive:
        link = zipfile.ZipInfo("a.usda")
        link.external_attr = 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
    refused(path, "a link")


def test_a_file_that_is_not_there(tmp_path):
    refused(tmp_path / "none.bvh", "none")
    refused(tmp_path, "none")


def test_an_archive_that_would_fill_the_memory_or_leave_its_folder(tmp_path):
    path = tmp_path / "a.usdz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.usda", b"#usda 1.0\n" + bytes(50_000_000))
    assert path.stat().st_size < 1_000_000
    refused(path, "compressed")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("../a.usda", b"#usda 1.0\n")
    refused(path, "inside it")


@pytest.mark.parametrize("options", [{"up": "w"}, {"unit_m": 0.0}, {"unit_m": float("nan")}])
def test_options_that_mean_nothing(tmp_path, options):
    path = tmp_path / "a.bvh"
    path.write_text(ARM)
    refused(path, **options)


def _places(value, path=()):
    """Yield the way to every value in a document."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in items:
        yield (*path, key)
        if isinstance(inner, dict | list):
            yield from _places(inner, (*path, key))


MANY = settings(
    max_examples=150,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
ODD = st.sampled_from([None, -1, 0, 10**9, 1.5, float("nan"), "x", [], {}, [0], True])


@MANY
@given(data=st.data())
def test_no_change_to_a_gltf_is_a_traceback(tmp_path, data):
    whole = copy.deepcopy(document())
    way = data.draw(st.sampled_from(list(_places(whole))))
    inner = whole
    for key in way[:-1]:
        inner = inner[key]
    inner[way[-1]] = data.draw(ODD)
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(whole))
    try:
        imported = import_file(path)
    except ImportedFileError as error:
        assert "\n" not in str(error)
        return
    for animation in imported.animations:
        assert np.isfinite(animation.rotation_xyzw).all()


@MANY
@given(data=st.data())
def test_no_change_to_a_bvh_is_a_traceback(tmp_path, data):
    words = ARM.split(" ")
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(words) - 1))
        words[at] = data.draw(
            st.sampled_from(["", "0", "-1", "1e999", "{", "}", "x", "nan", "Frames:"])
        )
    path = tmp_path / "a.bvh"
    path.write_text(" ".join(words))
    try:
        imported = import_file(path)
    except ImportedFileError as error:
        assert "\n" not in str(error)
        return
    for animation in imported.animations:
        assert np.isfinite(animation.rotation_xyzw).all()


@MANY
@given(data=st.data())
def test_no_change_to_a_usd_is_a_traceback(tmp_path, data):
    words = re.split(r"([\s,()\[\]]+)", USD_ARM)
    for _ in range(data.draw(st.integers(1, 2))):
        at = 2 * data.draw(st.integers(0, len(words) // 2))
        words[at] = data.draw(
            st.sampled_from(["", "0", "-1", "1e300", "nan", "inf", "None", "[]", "()", "99999999"])
        )
    _read_or_refused(tmp_path / "a.usda", "".join(words).encode())


@MANY
@given(data=st.data())
def test_no_broken_byte_is_a_traceback(tmp_path, data):
    name = data.draw(st.sampled_from(["a.usdc", "a.usdz", "a.glb", "a.bvh"]))
    whole = bytearray(_whole_file(name))
    for _ in range(data.draw(st.integers(0, 8))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    kept = data.draw(st.one_of(st.just(len(whole)), st.integers(0, len(whole))))
    _read_or_refused(tmp_path / name, bytes(whole[:kept]))


def _read_or_refused(path: Path, data: bytes) -> None:
    path.write_bytes(data)
    try:
        imported = import_file(path)
    except ImportedFileError as error:
        assert "\n" not in str(error)
        return
    for animation in imported.animations:
        assert np.isfinite(animation.rotation_xyzw).all()


@functools.cache
def _whole_file(name: str) -> bytes:
    """A file of each kind, small and sound."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        if name == "a.bvh":
            return ARM.encode()
        if name == "a.glb":
            text = json.dumps(document()).encode()
            text += b" " * (-len(text) % 4)
            head = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A)
            return head + text
        layer = Sdf.Layer.CreateAnonymous(".usda")
        layer.ImportFromString(USD_ARM)
        layer.Export(str(path.with_suffix(".usdc")))
        if name == "a.usdz":
            with Sdf.ZipFileWriter.CreateNew(str(path)) as archive:
                archive.AddFile(str(path.with_suffix(".usdc")), "a.usdc")
        return path.read_bytes()
