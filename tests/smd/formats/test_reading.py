from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from smd.errors import RecordingError
from smd.formats import SourceFrame, read_recording

TUM = "# timestamp tx ty tz qx qy qz qw\n" + "".join(
    f"{1403636579.7 + i / 30:.4f} {i * 0.01:.2f} 2 3 0 0 0 1\n" for i in range(4)
)


def test_tum_counts_time_from_its_first_row_and_keeps_what_it_read_there(tmp_path):
    path = tmp_path / "take.tum"
    path.write_text(TUM)
    recording = read_recording(path)
    assert_allclose(recording.doodles[0].time_s, np.arange(4) / 30, atol=1e-4)
    assert_array_equal(recording.doodles[0].position_m[:, 0], [0, 0.01, 0.02, 0.03])
    assert float(recording.metadata["clock_zero_s"]) == 1403636579.7


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".json", ".TUM"])
def test_content_decides_and_not_the_suffix(tmp_path, suffix):
    path = tmp_path / f"take{suffix}"
    path.write_text(TUM)
    assert len(read_recording(path).doodles[0]) == 4


def test_the_users_frame_comes_before_the_formats(tmp_path):
    path = tmp_path / "take.tum"
    path.write_text(TUM)
    doodle = read_recording(path, SourceFrame.from_options(up="z", unit="cm")).doodles[0]
    assert_allclose(doodle.position_m[1], np.array([0.01, 3, -2]) * 0.01)


def test_an_order_is_refused_where_the_file_names_its_components(tmp_path):
    path = tmp_path / "take.csv"
    path.write_text("t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0,0,0,0,0,0,1\n")
    assert len(read_recording(path, SourceFrame(quaternion="xyzw")).doodles[0]) == 2
    with pytest.raises(RecordingError, match="expected no quaternion order, as the file names"):
        read_recording(path, SourceFrame(quaternion="wxyz"))


def test_quaternions_rounded_to_two_decimals_are_made_unit(tmp_path):
    path = tmp_path / "take.tum"
    q = np.round(Rotation.random(200, random_state=0).as_quat(), 2)
    path.write_text("".join(f"{i / 30} 0 0 {i} {' '.join(map(str, r))}\n" for i, r in enumerate(q)))
    lengths = np.linalg.norm(read_recording(path).doodles[0].orientation_xyzw, axis=1)
    assert_allclose(lengths, 1.0, atol=1e-12)


@pytest.mark.parametrize("wrapped", [False, True])
def test_aframe_is_degrees_in_order_yxz_of_devices_that_face_minus_z(tmp_path, wrapped):
    angles = np.array([[10.0, 20.0, 30.0], [90.0, 0.0, 0.0], [0.0, 90.0, 0.0], [-40.0, 170.0, 5.0]])
    poses = [
        {
            "position": {"x": 0.1 * i, "y": 1.0, "z": -0.5},
            "rotation": dict(zip("xyz", row, strict=True)),
            "timestamp": 5000.0 + 100.0 * i,
        }
        for i, row in enumerate(angles.tolist())
    ]
    devices = {"left": {"poses": poses, "events": []}, "right": {"poses": []}, "gamepad": 3}
    path = tmp_path / "take.json"
    path.write_text(json.dumps({"avatar": "a", "recording": devices} if wrapped else devices))
    recording = read_recording(path)
    assert recording.devices == ("left",)
    assert float(recording.metadata["clock_zero_s"]) == 5.0
    doodle = recording.doodles[0]
    assert_allclose(doodle.time_s, [0.0, 0.1, 0.2, 0.3], atol=1e-12)
    assert_allclose(doodle.position_m[:, 0], [0.0, 0.1, 0.2, 0.3])
    device = Rotation.from_euler("YXZ", angles[:, [1, 0, 2]], degrees=True)
    ours = Rotation.from_quat(doodle.orientation_xyzw)
    assert_allclose(ours.apply([0, 0, 1]), device.apply([0, 0, -1]), atol=1e-12)
    assert_allclose(ours.apply([1, 0, 0]), device.apply([-1, 0, 0]), atol=1e-12)
