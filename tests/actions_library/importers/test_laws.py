"""What holds of every format of characters and clips: a new one is tried as soon as it is listed.

A format brings one thing here, `WRITERS`: how an arm that turns stands in a file of its own.
"""

from __future__ import annotations

import base64
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from actions_library.importers import FORMATS, SUFFIXES, import_file
from smd.character.kinematics import forward_kinematics
from smd.errors import ImportedFileError

PAGE = (Path(__file__).parents[3] / "docs" / "importing.md").read_text(encoding="utf-8")
FRAMES, RATE_HZ = 26, 25.0
SHOULDER, LENGTH = np.array([0.25, 0.5, 0.0]), 1.0


def angles() -> np.ndarray:
    """Of the upper arm about +Z, in radians, by frame: a quarter turn in a second."""
    return np.linspace(0.0, 0.5 * np.pi, FRAMES)


def bvh(path: Path, turn_rad: np.ndarray) -> None:
    x, y, z = SHOULDER
    head = (
        f"HIERARCHY\nROOT upper\n{{\nOFFSET {x} {y} {z}\nCHANNELS 1 Zrotation\nJOINT lower\n{{\n"
        f"OFFSET 0 {LENGTH} 0\nCHANNELS 0\n}}\n}}\nMOTION\n"
        f"Frames: {len(turn_rad)}\nFrame Time: {1.0 / RATE_HZ}\n"
    )
    path.write_text(head + "".join(f"{value!r}\n" for value in np.degrees(turn_rad).tolist()))


def gltf(path: Path, turn_rad: np.ndarray) -> None:
    times = np.arange(len(turn_rad)) / RATE_HZ
    zero = np.zeros(len(turn_rad))
    turns = np.column_stack([zero, zero, np.sin(0.5 * turn_rad), np.cos(0.5 * turn_rad)])
    arrays = [times.astype("<f4"), turns.astype("<f4")]
    data = b"".join(array.tobytes() for array in arrays)
    views, accessors, at = [], [], 0
    for i, (array, kind) in enumerate(zip(arrays, ("SCALAR", "VEC4"), strict=True)):
        views.append({"buffer": 0, "byteOffset": at, "byteLength": array.nbytes})
        accessors.append(
            {"bufferView": i, "componentType": 5126, "count": len(array), "type": kind}
        )
        at += array.nbytes
    target = {"node": 0, "path": "rotation"}
    whole = {
        "asset": {"version": "2.0"},
        "nodes": [
            {"name": "upper", "translation": SHOULDER.tolist(), "children": [1]},
            {"name": "lower", "translation": [0, LENGTH, 0]},
        ],
        "skins": [{"joints": [0, 1]}],
        "animations": [
            {
                "samplers": [{"input": 0, "output": 1}],
                "channels": [{"sampler": 0, "target": target}],
            }
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [
            {
                "byteLength": len(data),
                "uri": "data:a/b;base64," + base64.b64encode(data).decode(),
            }
        ],
    }
    text = json.dumps(whole).encode()
    if path.suffix == ".glb":  # a GLB may keep its buffers in URIs as well
        text += b" " * (-len(text) % 4)
        sizes = (2, 20 + len(text), len(text))
        head = [b"glTF", *(n.to_bytes(4, "little") for n in sizes), b"JSON"]
        text = b"".join(head) + text
    path.write_bytes(text)


def usd(path: Path, turn_rad: np.ndarray) -> None:
    from pxr import Gf, Usd, UsdGeom, UsdSkel

    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, "Y")
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(RATE_HZ)
    UsdSkel.Root.Define(stage, "/root")
    skeleton = UsdSkel.Skeleton.Define(stage, "/root/arm")
    joints = ["upper", "upper/lower"]
    shoulder, elbow = Gf.Vec3d(*SHOULDER.tolist()), Gf.Vec3d(0, LENGTH, 0)
    skeleton.CreateJointsAttr(joints)
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d().SetTranslate(v) for v in (shoulder, elbow)])
    places = (shoulder, shoulder + elbow)
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d().SetTranslate(v) for v in places])
    moved = UsdSkel.Animation.Define(stage, "/root/move")
    moved.CreateJointsAttr(joints)
    moved.CreateTranslationsAttr([Gf.Vec3f(shoulder), Gf.Vec3f(elbow)])
    moved.CreateScalesAttr([Gf.Vec3h(1, 1, 1)] * 2)
    turns = moved.CreateRotationsAttr()
    for i, angle in enumerate(turn_rad.tolist()):
        turn = Gf.Quatf(float(np.cos(0.5 * angle)), 0, 0, float(np.sin(0.5 * angle)))
        turns.Set([turn, Gf.Quatf(1)], float(i))
    binding = UsdSkel.BindingAPI.Apply(skeleton.GetPrim())
    binding.CreateAnimationSourceRel().SetTargets([moved.GetPath()])
    stage.Save()


WRITERS: dict[str, Callable[[Path, np.ndarray], None]] = {"BVH": bvh, "glTF": gltf, "USD": usd}

every_format = pytest.mark.parametrize("kind", FORMATS, ids=lambda kind: kind.name)


def written(kind, folder: Path, suffix: str | None = None, turn_rad=None) -> Path:
    path = folder / f"arm{suffix or kind.suffixes[0]}"
    WRITERS[kind.name](path, angles() if turn_rad is None else turn_rad)
    return path


def elbow_m(path: Path, **options) -> np.ndarray:
    """Where the lower arm begins, ``(n, 3)``."""
    imported = import_file(path, **options)
    (animation,) = imported.animations
    assert animation.rate_hz == RATE_HZ
    _, place = forward_kinematics(
        imported.skeleton, animation.rotation_xyzw, animation.translation_m
    )
    return place[:, imported.skeleton.joints.index("lower")]


def meant_m() -> np.ndarray:
    turn = angles()
    way = np.column_stack([-np.sin(turn), np.cos(turn), np.zeros(FRAMES)])
    return SHOULDER + LENGTH * way


def refused(path: Path, **options) -> str:
    """The message of a file that cannot be imported, without the file."""
    with pytest.raises(ImportedFileError) as caught:
        import_file(path, **options)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and not message.startswith(f"{path}: {path}")
    assert "expected " in message and ", found " in message and message.isprintable()
    return message.removeprefix(f"{path}: ")


@every_format
def test_the_contract_is_kept(kind):
    assert kind.suffixes and set(kind.suffixes) <= set(SUFFIXES)
    assert all(each == each.lower() and each.startswith(".") for each in kind.suffixes)
    (header,) = (line for line in PAGE.splitlines() if line.startswith("| | "))
    assert kind.name in header


def test_a_suffix_is_of_one_format_and_none_is_loaded_before_it_is_asked_for():
    assert len(set(SUFFIXES)) == len(SUFFIXES)
    code = "import sys, actions_library.importers; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    loaded = set(done.stdout.split())
    assert "pxr" not in loaded and "actions_library.importers.bvh" not in loaded


@every_format
def test_an_arm_turns_as_it_was_meant(kind, tmp_path):
    for suffix in kind.suffixes:
        if suffix == ".usdz":
            continue  # USD writes no archive by itself
        path = written(kind, tmp_path, suffix)
        np.testing.assert_allclose(elbow_m(path), meant_m(), atol=1e-6)


@every_format
def test_what_is_said_of_a_file_overrules_it(kind, tmp_path):
    path = written(kind, tmp_path)
    x, y, z = meant_m().T
    upright = np.column_stack([x, z, -y])
    np.testing.assert_allclose(elbow_m(path, up="z", unit_m=1.0), upright, atol=1e-6)
    np.testing.assert_allclose(elbow_m(path, up="y", unit_m=0.01), 0.01 * meant_m(), atol=1e-8)
    assert refused(path, up="upwards").startswith("up: expected one of x, y, z")
    for wrong in (0.0, -1.0, np.nan, np.inf):
        assert refused(path, unit_m=wrong).startswith("unit: expected a positive number")


@every_format
def test_a_skeleton_is_chosen_only_where_a_file_may_have_several(kind, tmp_path):
    path = written(kind, tmp_path)
    message = refused(path, skeleton="nobody's")
    several = ", ".join(each.name for each in FORMATS if each.has_skeletons)
    expected = "one of /" if kind.has_skeletons else f"a {several} file"
    assert message.startswith(f"skeleton: expected {expected}")


@every_format
@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_a_turn_that_is_no_number_is_refused_with_its_place(kind, wrong, tmp_path):
    turn_rad = angles()
    turn_rad[FRAMES // 2] = wrong
    with np.errstate(invalid="ignore"):
        message = refused(written(kind, tmp_path, turn_rad=turn_rad))
    assert "finite" in message and not message.startswith("expected")


@every_format
def test_an_empty_file_is_refused(kind, tmp_path):
    for suffix in kind.suffixes:
        path = tmp_path / f"arm{suffix}"
        path.write_bytes(b"")
        refused(path)


@every_format
def test_a_file_cut_anywhere_is_refused_or_read(kind, tmp_path):
    data = written(kind, tmp_path).read_bytes()
    path = tmp_path / f"cut{kind.suffixes[0]}"
    for count in np.linspace(0, len(data) - 2, 40).astype(int).tolist():
        path.write_bytes(data[:count])
        try:
            import_file(path)
        except ImportedFileError as error:
            assert str(error).startswith(f"{path}: ") and str(error).isprintable()


@every_format
def test_nothing_and_a_folder_are_refused(kind, tmp_path):
    path = tmp_path / f"none{kind.suffixes[0]}"
    assert refused(path) == "expected a file, found none"
    path.mkdir()
    assert refused(path) == "expected a file, found none"
