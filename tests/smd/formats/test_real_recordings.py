"""Files that nobody here made; skipped where they are absent."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from smd.formats import SourceFrame, read_recording
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_about,
    rotate,
    rotvec_from_quaternion,
)
from smd.smoothing import smooth

AFRAME = [
    ("tracked-recording", "left"),
    ("tracked-recording", "right"),
    ("tracked-recording", "camera"),
    ("dev-recording", "left"),
    ("grabLeft", "right"),
    ("grabRight", "left"),
    ("dance", "leftHand"),
    ("dance", "rightHand"),
]


@pytest.mark.parametrize(("session", "device"), AFRAME)
def test_aframe_json_agrees_with_its_table(shared_data, session, device):
    """The tables are in A-Frame's own frame: ours is half a turn about Y from it."""
    folder = shared_data / "controllers" / "aframe"
    ours = read_recording(folder / "raw" / f"{session}.json", device=device).doodles
    table = np.loadtxt(folder / f"{session}_{device}.csv", delimiter=",", skiprows=1)
    assert len(ours) == 1
    assert_allclose(ours[0].time_s, table[:, 0], atol=1e-6)
    assert_allclose(ours[0].position_m, table[:, 1:4], atol=1e-6)
    faced = multiply(table[:, 4:8], quaternion_about([0, 1, 0], np.pi))
    off = multiply(inverse(normalized(faced)), ours[0].orientation_xyzw)
    assert_allclose(rotvec_from_quaternion(off), 0.0, atol=5e-6)


def test_aframe_reads_every_device_of_both_layouts(shared_data):
    raw = shared_data / "controllers" / "aframe" / "raw"
    assert read_recording(raw / "dance.json").devices == ("camera", "leftHand", "rightHand")
    assert read_recording(raw / "tracked-recording.json").devices == ("camera", "right", "left")


def test_idle_hands_are_split_where_tracking_was_lost_and_no_leap_is_left(shared_data):
    frame = SourceFrame.from_options(handedness="left")
    files = sorted((shared_data / "idle").glob("*.csv"))
    assert len(files) == 18
    for path in files:
        for doodle in read_recording(path, frame).doodles:
            steps_m = np.linalg.norm(np.diff(doodle.position_m, axis=0), axis=1)
            assert (steps_m / np.diff(doodle.time_s)).max() < 20.0, path


def test_a_kettle_that_reports_every_second_row_is_never_lost(shared_data):
    for path in (shared_data / "controllers" / "kettle").glob("*.csv"):
        recording = read_recording(path)
        assert recording.dropouts == ()
        assert len(recording.doodles) == 1


def test_the_kettles_quaternions_are_xyzw(shared_data):
    """All six pourings turn about one axis of the world, whatever reference was tracked."""
    agreement = {}
    for order in ("xyzw", "wxyz"):
        axes = []
        for path in sorted((shared_data / "controllers" / "kettle").glob("*_ref_*.csv")):
            motion = smooth(read_recording(path, SourceFrame(quaternion=order)).doodles[0])
            spin = rotate(motion.orientation_xyzw, motion.angular_velocity_rad_s)
            axes.append(np.linalg.svd(spin, full_matrices=False)[2][0])
        cosines = np.abs(np.array(axes) @ np.array(axes).T)
        agreement[order] = np.degrees(np.arccos(np.clip(cosines.min(), 0, 1)))
    assert agreement["xyzw"] < 12.0
    assert agreement["wxyz"] > 60.0
