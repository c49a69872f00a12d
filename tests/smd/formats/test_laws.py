"""What holds of every format of recordings: a new one is tried as soon as it is listed.

A format brings one thing here, `WRITERS`: how poses in our convention stand in a file of its own.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from smd.errors import RecordingError
from smd.formats import SUFFIXES, SourceFrame, read_recording
from smd.formats.file import RecordingFile
from smd.formats.reading import FORMATS, READABLE, format_frame

PAGE = (Path(__file__).parents[3] / "docs" / "formats.md").read_text(encoding="utf-8")
FRAMES = 24
RATE_HZ = 32.0  # a step of 1/32 s is whole in binary: no format rounds it
HALF_TURN_Y = np.diag([-1.0, 1.0, -1.0])


def poses() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, positions ``(n, 3)`` and rotation matrices ``(n, 3, 3)`` of a prop that turns."""
    time_s = np.arange(FRAMES) / RATE_HZ
    position_m = np.column_stack([0.5 * time_s, 1.0 + 0.25 * time_s, -0.125 * time_s])
    pitch, yaw = 0.4 * time_s, 1.0 * time_s
    cp, sp, cy, sy = np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    zero, one = np.zeros(FRAMES), np.ones(FRAMES)
    turn_y = np.moveaxis(np.array([[cy, zero, sy], [zero, one, zero], [-sy, zero, cy]]), -1, 0)
    turn_x = np.moveaxis(np.array([[one, zero, zero], [zero, cp, -sp], [zero, sp, cp]]), -1, 0)
    return time_s, position_m, turn_y @ turn_x


def quaternions(matrix: np.ndarray) -> np.ndarray:
    """xyzw ``(n, 4)`` of rotations by less than half a turn."""
    w = 0.5 * np.sqrt(1.0 + np.trace(matrix, axis1=1, axis2=2))
    skew = matrix - np.swapaxes(matrix, 1, 2)
    axis = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1) / (4.0 * w[:, None])
    return np.column_stack([axis, w])


def native(path: Path, time_s, position, matrix) -> None:
    rows = np.column_stack([time_s, position, quaternions(matrix)])
    text = "\n".join(",".join(map(repr, row)) for row in rows.tolist())
    path.write_text(f"time_s,x,y,z,qx,qy,qz,qw\n{text}\n")


def motive(path: Path, time_s, position, matrix) -> None:
    above = [
        ("", "Type", *["Rigid Body"] * 7),
        ("", "Name", *["doll"] * 7),
        ("", "ID", *["1"] * 7),
        ("", "", *["Rotation"] * 4, *["Position"] * 3),
        ("Frame", "Time (Seconds)", *"XYZWXYZ"),
    ]
    rows = np.column_stack([np.arange(len(time_s)), time_s, quaternions(matrix), position])
    lines = [*above, *(map(repr, row) for row in rows.tolist())]
    said = "Format Version,1.23,Rotation Type,Quaternion,Length Units,Meters"
    path.write_text("\n".join([said, "", *(",".join(line) for line in lines), ""]))


def tum(path: Path, time_s, position, matrix) -> None:
    rows = np.column_stack([time_s, position, quaternions(matrix)])
    path.write_text("\n".join(" ".join(map(repr, row)) for row in rows.tolist()) + "\n")


def aframe(path: Path, time_s, position, matrix) -> None:
    """Controllers face their own -Z; Euler angles of order YXZ, as `poses` turns."""
    own = matrix @ HALF_TURN_Y
    x = np.arcsin(-own[:, 1, 2])
    y, z = np.arctan2(own[:, 0, 2], own[:, 2, 2]), np.arctan2(own[:, 1, 0], own[:, 1, 1])
    angles = np.degrees(np.column_stack([x, y, z])).tolist()
    listed = [
        {
            "timestamp": 1000.0 * t,
            "position": dict(zip("xyz", p, strict=True)),
            "rotation": dict(zip("xyz", angle, strict=True)),
        }
        for t, p, angle in zip(time_s.tolist(), position.tolist(), angles, strict=True)
    ]
    path.write_text(json.dumps({"prop": {"poses": listed}}))


def bsor(path: Path, time_s, position, matrix) -> None:
    """Unity is left-handed: its X points the other way."""
    mirror = np.diag([-1.0, 1.0, 1.0])
    q = quaternions(mirror @ matrix @ mirror)
    numbers = np.column_stack([position @ mirror, q]).astype("<f4")
    text = struct.pack("<i", 1) + b"a"
    data = struct.pack("<iBB", 0x442D3D69, 1, 0) + 13 * text + struct.pack("<i", 0) + 3 * text
    data += struct.pack("<f?ffffBi", 0, False, 0, 0, 0, 0, 1, len(time_s))
    for t, row in zip(time_s.tolist(), numbers, strict=True):
        data += struct.pack("<fi", t, 60) + 3 * row.tobytes()
    path.write_bytes(data)


def usd(path: Path, time_s, position, matrix) -> None:
    from pxr import Gf, Usd, UsdGeom

    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, "Y")
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(RATE_HZ)
    xform = UsdGeom.Xform.Define(stage, "/prop").AddTransformOp()
    for t, p, m in zip(time_s.tolist(), position.tolist(), matrix, strict=True):
        rows = np.eye(4)
        rows[:3, :3], rows[3, :3] = m.T, p
        xform.Set(Gf.Matrix4d(rows.tolist()), t * RATE_HZ)
    stage.Save()


WRITERS: dict[str, Callable[..., None]] = {
    "native CSV": native,
    "OptiTrack Motive": motive,
    "TUM": tum,
    "A-Frame motion capture": aframe,
    "Beat Saber Open Replay": bsor,
    "USD": usd,
}

every_format = pytest.mark.parametrize("kind", FORMATS, ids=lambda kind: kind.name)


def suffixes_of(kind) -> tuple[str, ...]:
    return (*kind.suffixes, *kind.only_named)


def written(kind, folder: Path, suffix: str | None = None, **changes) -> Path:
    """A file of a format; ``changes`` are of `poses`."""
    time_s, position, matrix = poses()
    # USD writes no archive by itself.
    path = folder / f"take{suffix or suffixes_of(kind)[0]}"
    WRITERS[kind.name](path, time_s, changes.get("position", position), matrix)
    return path


def refused(path: Path) -> str:
    """The message of a recording that cannot be read, without its file."""
    with pytest.raises(RecordingError) as caught:
        read_recording(path)
    message = str(caught.value)
    assert message.startswith(str(path)) and message.count(str(path)) == 1
    assert ": expected " in message and ", found " in message and message.isprintable()
    return message.removeprefix(str(path))


@every_format
def test_the_contract_is_kept(kind):
    assert suffixes_of(kind)
    assert all(each == each.lower() and each.startswith(".") for each in suffixes_of(kind))
    assert set(suffixes_of(kind)) <= set(READABLE) and set(kind.suffixes) <= set(SUFFIXES)
    assert f"| {kind.name} |" in PAGE


def test_a_suffix_without_a_text_is_of_one_format():
    binary = [s for kind in FORMATS if kind.matches is None for s in suffixes_of(kind)]
    others = [s for kind in FORMATS if kind.matches is not None for s in suffixes_of(kind)]
    assert len(set(binary)) == len(binary) and not set(binary) & set(others)


@every_format
def test_poses_read_back_as_they_were_meant(kind, tmp_path):
    time_s, position, matrix = poses()
    for suffix in suffixes_of(kind):
        if suffix == ".usdz":
            continue
        doodle = read_recording(written(kind, tmp_path, suffix)).doodles[0]
        assert_allclose(doodle.time_s, time_s, atol=1e-9)
        tolerance = 1e-6  # of bsor's 32 bits; the others keep 64
        assert_allclose(doodle.position_m, position, atol=tolerance)
        expected = quaternions(matrix)
        sign = np.sign(np.sum(doodle.orientation_xyzw * expected, axis=1, keepdims=True))
        assert_allclose(sign * doodle.orientation_xyzw, expected, atol=tolerance)


@every_format
def test_a_file_is_known_by_its_own_format_alone(kind, tmp_path):
    file = RecordingFile(written(kind, tmp_path))
    if kind.matches is None:
        return
    knows = [each for each in FORMATS if each.matches is not None and each.matches(file.text)]
    assert knows[0] is kind


@every_format
def test_every_question_of_the_frame_is_answered(kind, tmp_path):
    path = written(kind, tmp_path)
    frame = format_frame(path)
    assert None not in (frame.up, frame.front, frame.handedness, frame.unit, frame.quaternion)
    assert len(read_recording(path, SourceFrame(unit="cm")).doodles) > 0


@every_format
@pytest.mark.parametrize("axis", range(3))
def test_an_absurd_position_is_refused_with_its_place(kind, axis, tmp_path):
    _, position, _ = poses()
    position[FRAMES // 2, axis] = 1e9
    message = refused(written(kind, tmp_path, position=position))
    assert message.startswith(", ") and "expected positions within" in message


@every_format
def test_an_empty_file_is_refused(kind, tmp_path):
    path = written(kind, tmp_path)
    path.write_bytes(b"")
    refused(path)


@every_format
def test_a_file_cut_anywhere_is_read_or_refused(kind, tmp_path):
    path = written(kind, tmp_path)
    data = path.read_bytes()
    read = 0
    for count in np.linspace(0, len(data) - 1, 60).astype(int).tolist():
        path.write_bytes(data[:count])
        try:
            read += len(read_recording(path).doodles) > 0
        except RecordingError as error:
            assert str(error).startswith(str(path)) and str(error).isprintable()
    assert read < 60


@every_format
@pytest.mark.parametrize("seed", range(3))
def test_a_damaged_file_is_read_or_refused(kind, seed, tmp_path):
    if kind.name == "USD":
        pytest.skip("a damaged crate ends USD's own process, not with an error")
    path = written(kind, tmp_path)
    data = path.read_bytes()
    rng = np.random.default_rng(seed)
    for _ in range(60):
        damaged = bytearray(data)
        for at in rng.integers(0, len(data), 3):
            damaged[at] = rng.integers(0, 256)
        path.write_bytes(damaged)
        try:
            read_recording(path)
        except RecordingError as error:
            assert str(error).startswith(str(path)) and str(error).isprintable()


@every_format
def test_nothing_and_a_folder_are_refused(kind, tmp_path):
    path = tmp_path / f"none{suffixes_of(kind)[0]}"
    assert refused(path) == ": expected a recording, found no such file"
    path.mkdir()
    assert refused(path) == ": expected a recording, found a folder"
