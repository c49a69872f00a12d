"""`smd calibrate` prints the mount under which the turned prop stays in its place."""

from __future__ import annotations

import re

import numpy as np
import pytest

from smd.doodle import Doodle, Recording
from smd.formats import SourceFrame, read_recording, write_recording
from smd.geometry.rotations import quaternion_from_rotvec, rotate

LEVER_M = np.array([0.012, 0.064, -0.008])


@pytest.fixture
def turned(tmp_path):
    """Write a recording of a prop that is turned about its centre, and return its file."""

    def write(*axes: int, device: str = "prop", name: str = "turned.csv"):
        t = np.arange(0.0, 15.0, 1 / 60)
        turn = np.zeros((len(t), 3))
        for axis in axes:
            turn[:, axis] = np.sin(2 * np.pi * (0.31 + 0.1 * axis) * t)
        orientation = quaternion_from_rotvec(turn)
        doodle = Doodle(t, [0.2, 1.0, 0.1] - rotate(orientation, LEVER_M), orientation, device)
        write_recording(Recording((doodle,)), tmp_path / name)
        return tmp_path / name

    return write


@pytest.mark.parametrize("mount", [[], ["--mount", "yaw=180"], ["--mount", "roll=30,x=0.1"]])
def test_the_printed_mount_keeps_the_centre_in_its_place(run_smd, turned, mount):
    file = turned(0, 1, 2)
    code, out, err = run_smd("calibrate", file, *mount)
    assert (code, err) == (0, "")
    found = re.fullmatch(r"--mount (\S+)", out.splitlines()[-1])[1]
    doodle = read_recording(file, SourceFrame.from_options(mount=found)).doodles[0]
    np.testing.assert_allclose(doodle.position_m, [[0.2, 1.0, 0.1]] * len(doodle), atol=1e-3)


def test_one_axis_is_refused_with_the_files_name(run_smd, turned):
    code, out, err = run_smd("calibrate", turned(1))
    assert (code, out) == (3, "")
    assert len(err.splitlines()) == 1
    assert re.search(r"turned\.csv.*two axes.*mostly y", err)


def test_of_several_devices_one_must_be_named(run_smd, turned, tmp_path):
    files = [turned(0, 1, 2, device=name, name=f"{name}.csv") for name in ("left", "right")]
    doodles = tuple(read_recording(file).doodles[0] for file in files)
    write_recording(Recording(doodles), tmp_path / "both.csv")
    code, _, err = run_smd("calibrate", tmp_path / "both.csv")
    assert code == 3
    assert re.search(r"both\.csv.*--device.*left, right", err)
    assert run_smd("calibrate", tmp_path / "both.csv", "--device", "left")[0] == 0
    code, _, err = run_smd("calibrate", tmp_path / "both.csv", "--device", "top")
    assert (code, "'top'" in err) == (3, True)
