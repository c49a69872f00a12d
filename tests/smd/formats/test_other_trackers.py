"""Motive CSV, Beat Saber Open Replay and USD: a movement known in closed form, written as their
specifications say, reads as that movement."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose

from smd.errors import RecordingError
from smd.formats import read_recording
from smd.geometry.rotations import inverse, multiply, quaternion_from_euler, rotvec_from_quaternion

T = np.arange(60) / 60
POSITION = np.stack([np.sin(T), 1.0 + 0.1 * T, np.cos(T)], axis=1)
Q = quaternion_from_euler("YXZ", np.stack([T, 0.3 * np.sin(T), 0.2 * T], axis=1))


def assert_reads_as(recording, device, *, places=1e-5):
    (doodle,) = recording.of(device)
    assert_allclose(doodle.time_s, T, atol=1e-6)
    assert_allclose(doodle.position_m, POSITION, atol=places)
    apart = rotvec_from_quaternion(multiply(inverse(Q), doodle.orientation_xyzw))
    assert np.abs(apart).max() < places


# OptiTrack Motive: columns of a rigid body, of one of its markers, and of the body's error


def motive(unit="Millimeters", rotation="Quaternion", unseen=range(0), version="1.23") -> str:
    kinds = ["Rigid Body"] * 8 + ["Rigid Body Marker"] * 3
    names = ["doll"] * 8 + ["doll:Marker1"] * 3
    whats = ["Rotation"] * 4 + ["Position"] * 3 + ["Mean Marker Error"] + ["Position"] * 3
    lead = ["Type", "Name", "ID"] if version == "1.23" else ["", "", ""]
    lines = [
        f"Format Version,{version},Take Name,walk,Capture Frame Rate,60.000000,"
        f"Rotation Type,{rotation},Length Units,{unit},Coordinate Space,Global",
        "",
        *(
            ",".join(["", label, *cells])
            for label, cells in zip(lead, (kinds, names, ["A1"] * 11), strict=True)
        ),
        ",".join(["", "", *whats]),
        "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z",
    ]
    for i, (t, p, q) in enumerate(zip(T, 1000 * POSITION, Q, strict=True)):
        numbers = [f"{value:.6f}" for value in (*q, *p)]
        body = [""] * 8 if i in unseen else [*numbers, "0.0001"]
        lines.append(",".join([str(i), f"{t:.6f}", *body, "", "", ""]))
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("version", ["1.2", "1.23"])
def test_a_motive_export_reads_as_what_moved(tmp_path, version):
    (tmp_path / "take.csv").write_text(motive(version=version))
    recording = read_recording(tmp_path / "take.csv")
    assert recording.devices == ("doll",)
    assert recording.metadata["take"] == "walk"
    assert_reads_as(recording, "doll")


def test_cells_that_motive_leaves_empty_are_a_loss(tmp_path):
    (tmp_path / "take.csv").write_text(motive(unseen=range(20, 40)))
    recording = read_recording(tmp_path / "take.csv")
    assert [len(doodle) for doodle in recording.doodles] == [20, 20]
    (lost,) = recording.dropouts
    assert (lost.kind, lost.bridged) == ("invalid", False)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (motive(rotation="XYZ"), r"line 1: expected rotations as Quaternion.*'XYZ'"),
        (motive(unit="Furlongs"), r"line 1: expected length units of meters.*'Furlongs'"),
        (motive().replace("Rigid Body,", "Bone,"), "rigid bodies"),
        (motive().replace("Frame,Time", "Bild,Zeit"), "Frame,Time"),
        (motive().replace(",Name,doll", ",Name"), "above the columns"),
        (motive().replace("Rotation,Rotation,", "Rotation,Turn,"), r"'doll'.*found no qw, qy"),
        (motive().replace("\n5,", "\n5,0,"), r"line 13: expected 13 columns.*found 14"),
        (motive().split("\n0,")[0], "rows of poses"),
        ("Format Version,1.23", "Frame,Time"),
    ],
)
def test_a_motive_export_that_is_not_as_described_is_named(tmp_path, content, said):
    (tmp_path / "take.csv").write_text(content)
    with pytest.raises(RecordingError, match=said):
        read_recording(tmp_path / "take.csv")


# Beat Saber Open Replay: Unity's left-handed axes are ours mirrored across x = 0


def bsor(times=T, *, magic=0x442D3D69, version=1, count=None) -> bytes:
    def text(value: str) -> bytes:
        return struct.pack("<i", len(value.encode())) + value.encode()

    info = [text(f"text {i} ✓") for i in range(13)]
    info += [struct.pack("<i", 12345), *(text(value) for value in ("Standard", "Nice", "FS"))]
    info += [struct.pack("<f?ffff", 18.0, False, 1.7, 0.0, 0.0, 1.0)]
    frames = [struct.pack("<i", len(times) if count is None else count)]
    mirrored_p, mirrored_q = POSITION * [-1, 1, 1], Q * [1, -1, -1, 1]
    for t, p, q in zip(times, mirrored_p, mirrored_q, strict=True):
        pose = struct.pack("<7f", *p, *q)
        frames.append(struct.pack("<fi", t, 90) + 3 * pose)
    head = struct.pack("<iBB", magic, version, 0)
    return head + b"".join(info) + b"\1" + b"".join(frames) + b"\2" + struct.pack("<i", 0)


def test_an_open_replay_reads_as_what_moved(tmp_path):
    (tmp_path / "take.bsor").write_bytes(bsor())
    recording = read_recording(tmp_path / "take.bsor")
    assert recording.devices == ("head", "left", "right")
    assert dict(recording.metadata) == {
        "hmd": "text 7 ✓",
        "controller": "text 8 ✓",
        "song": "text 10 ✓",
    }
    for device in recording.devices:
        assert_reads_as(recording, device)


def test_frames_before_the_song_begins_count_once(tmp_path):
    (tmp_path / "take.bsor").write_bytes(bsor(np.maximum(T - 0.1, 0.0)))
    doodle = read_recording(tmp_path / "take.bsor").of("left")[0]
    assert len(doodle) == len(T) - 6
    assert doodle.time_s[0] == 0.0


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "byte 0: expected 5 bytes more, found 0"),
        (bsor(magic=7), "magic number 0x442d3d69, found 0x7"),
        (bsor(version=2), "version 1 of Beat Saber Open Replay, found version 2"),
        (bsor(count=10**6), "92000000 bytes more"),
        (bsor(count=-1), "at least two poses, found 0"),
        (bsor()[:5] + b"\x03" + bsor()[6:], "byte 5: expected the start of section 0, found 3"),
    ],
)
def test_an_open_replay_that_is_broken_is_named(tmp_path, content, said):
    (tmp_path / "take.bsor").write_bytes(content)
    with pytest.raises(RecordingError, match=said):
        read_recording(tmp_path / "take.bsor")


def test_an_open_replay_that_is_cut_anywhere_is_refused(tmp_path):
    whole = bsor()
    for length in range(0, len(whole) - 5, 97):
        (tmp_path / "take.bsor").write_bytes(whole[:length])
        with pytest.raises(RecordingError, match="bytes more"):
            read_recording(tmp_path / "take.bsor")


# USD: poses in the stage's own axes, unit and time codes


@pytest.fixture
def stage(tmp_path):
    def write(name="take.usda", up="Y", metres=1.0, codes_per_s=30.0, parent=False):
        from pxr import Gf, Usd, UsdGeom

        stage = Usd.Stage.CreateNew(str(tmp_path / name))
        UsdGeom.SetStageUpAxis(stage, up)
        UsdGeom.SetStageMetersPerUnit(stage, metres)
        stage.SetTimeCodesPerSecond(codes_per_s)
        outer = UsdGeom.Xform.Define(stage, "/room")
        if parent:  # moves the world, and takes it back in the prop's own transform
            outer.AddTranslateOp().Set(Gf.Vec3d(3.0, 0.0, 0.0))
        prop = UsdGeom.Xform.Define(stage, "/room/doll")
        UsdGeom.Xform.Define(stage, "/room/table").AddTranslateOp().Set(Gf.Vec3d(1, 2, 3))
        move, turn = prop.AddTranslateOp(), prop.AddOrientOp(UsdGeom.XformOp.PrecisionDouble)
        prop.AddScaleOp().Set(Gf.Vec3f(2.0))
        for t, p, q in zip(T, POSITION / metres, Q, strict=True):
            if up == "Z":  # the same in a world that is turned by a quarter about X
                p, q = np.array([p[0], -p[2], p[1]]), np.array([q[0], -q[2], q[1], q[3]])
            code = float(t * codes_per_s)
            move.Set(Gf.Vec3d(*(p - [3.0 * parent, 0.0, 0.0]).tolist()), code)
            turn.Set(Gf.Quatd(float(q[3]), Gf.Vec3d(*q[:3].tolist())), code)
        stage.GetRootLayer().Save()
        return tmp_path / name

    return write


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"name": "take.usdc", "metres": 0.01},
        {"up": "Z", "codes_per_s": 24.0},
        {"parent": True},
    ],
    ids=["ours", "centimetres", "Z up", "in a moved room"],
)
def test_an_animated_prim_reads_as_what_moved(stage, options):
    recording = read_recording(stage(**options))
    assert recording.devices == ("doll",)
    assert_reads_as(recording, "doll")


def test_usd_without_animation_or_of_an_odd_unit_is_named(stage, tmp_path):
    with pytest.raises(RecordingError, match=r"metersPerUnit of 1.0.*found 0.3"):
        read_recording(stage(metres=0.3))
    (tmp_path / "still.usda").write_text('#usda 1.0\ndef Xform "doll" {}\n')
    with pytest.raises(RecordingError, match="animated, found none"):
        read_recording(tmp_path / "still.usda")
    (tmp_path / "broken.usda").write_text("#usda 1.0\ndef Xform {")
    with pytest.raises(RecordingError, match="expected a USD file"):
        read_recording(tmp_path / "broken.usda")
