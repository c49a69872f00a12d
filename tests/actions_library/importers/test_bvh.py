from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from actions_library.importers import import_file
from actions_library.importers.bvh import UNITS_M
from smd.character.kinematics import forward_kinematics

ARM = """HIERARCHY
ROOT Hips
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT Neck
\t{
\t\tOFFSET 0 1.5 0
\t\tCHANNELS 3 Yrotation Zrotation Xrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 2.5e-1 0
\t\t}
\t}
}
MOTION
Frames: 2
Frame Time: 0.04
0 1 0 0 0 0 0 0 0
1 2 3 90 0 0 0 0 90
"""


def written(tmp_path: Path, text: str = ARM, name: str = "a.bvh") -> Path:
    path = tmp_path / name
    path.write_bytes(text.encode())
    return path


def places(path: Path, **options) -> np.ndarray:
    imported = import_file(path, **options)
    (animation,) = imported.animations
    return forward_kinematics(imported.skeleton, animation.rotation_xyzw, animation.translation_m)[
        1
    ]


def test_offsets_channels_and_end_sites_are_read(tmp_path):
    imported = import_file(written(tmp_path), unit_m=1.0)
    assert imported.skeleton.joints == ("Hips", "Neck", "Neck_end")
    assert imported.skeleton.parents.tolist() == [-1, 0, 1]
    assert imported.animations[0].rate_hz == 25.0
    place = places(imported.path, unit_m=1.0)
    np.testing.assert_allclose(place[0], [[0, 1, 0], [0, 2.5, 0], [0, 2.75, 0]], atol=1e-12)
    # A quarter turn about Z carries the neck to -X; then one about X turns the end to +Z.
    np.testing.assert_allclose(place[1], [[1, 2, 3], [-0.5, 2, 3], [-0.5, 2, 3.25]], atol=1e-12)


def test_line_ends_tabs_and_blank_lines_do_not_matter(tmp_path):
    changed = ARM.replace("\n", "\r\n\r\n").replace("CHANNELS 3", "CHANNELS\t3 ")
    plain, odd = written(tmp_path), written(tmp_path, changed, "b.bvh")
    np.testing.assert_array_equal(places(plain, unit_m=1.0), places(odd, unit_m=1.0))


@pytest.mark.parametrize(
    "change",
    [
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n{", " {").replace("\t{", " {"),
        lambda text: text.replace("HIERARCHY", "Hierarchy").replace("MOTION", "Motion"),
        lambda text: text.replace("End Site", "End site").replace("rotation", "Rotation"),
        lambda text: text.replace("Frames: ", "Frames:\t").replace("Frame Time: ", "Frame Time:"),
        lambda text: text.replace("0 1 0 0 0 0", "0 1 0\n0 0 0"),
    ],
)
def test_manners_of_writing_do_not_matter(tmp_path, change):
    plain, odd = written(tmp_path), written(tmp_path, change(ARM), "b.bvh")
    assert change(ARM) != ARM
    np.testing.assert_array_equal(places(plain, unit_m=1.0), places(odd, unit_m=1.0))


def test_joints_without_a_name_are_given_one(tmp_path):
    imported = import_file(written(tmp_path, ARM.replace("JOINT Neck", "JOINT")))
    assert imported.skeleton.joints == ("Hips", "joint_1", "joint_1_end")


def test_a_file_longer_than_a_block_of_text_is_read_whole(tmp_path):
    rows = "".join(f"{i} 1 0 0 0 0 0 0 {i % 90}.000000000000\n" for i in range(40_000))
    text = ARM.partition("0 1 0")[0].replace("Frames: 2", "Frames: 40000") + rows
    (animation,) = import_file(written(tmp_path, text), unit_m=1.0).animations
    np.testing.assert_array_equal(animation.translation_m[:, 0, 0], np.arange(40_000))


def test_the_unit_is_the_one_in_which_a_skeleton_is_a_person(tmp_path):
    for factor, unit in ((1.0, "m"), (100.0, "cm"), (1000.0, "mm"), (1 / 0.0254, "in")):
        text = ARM.replace("0 1.5 0", f"0 {1.5 * factor} 0").replace("2.5e-1", f"{0.25 * factor}")
        imported = import_file(written(tmp_path, text))
        assert np.ptp(imported.skeleton.world_from_bind[:, 1, 3]) == pytest.approx(1.75, rel=1e-6)
        assert unit in UNITS_M


def test_the_up_axis_is_where_the_head_is(tmp_path):
    text = ARM.replace("0 1.5 0", "0 0 1.5").replace("0 2.5e-1 0", "0 0 2.5e-1")
    imported = import_file(written(tmp_path, text), unit_m=1.0)
    assert imported.skeleton.world_from_bind[2, :3, 3] == pytest.approx([0.0, 1.75, 0.0])
    said = import_file(imported.path, unit_m=1.0, up="z")
    np.testing.assert_array_equal(said.skeleton.world_from_bind, imported.skeleton.world_from_bind)


def five_frames_of(path: Path) -> str:
    """A file's text with five of its frames, from the first to the last."""
    head, time, motion = re.split(r"(Frame Time.*\n)", path.read_text())
    rows = [row for row in motion.splitlines() if row.strip()]
    kept = [rows[i] for i in np.linspace(0, len(rows) - 1, 5).astype(int)]
    return re.sub(r"Frames:\s*\d+", "Frames: 5", head) + time + "\n".join(kept) + "\n"


def test_a_second_reader_finds_every_joint_in_the_same_place(shared_data, tmp_path):
    """It takes seconds for each thousand frames, so it is given five of each file."""
    bvhio = pytest.importorskip("bvhio")
    for source in sorted((shared_data / "clips" / "bvh").glob("*.bvh")):
        path = written(tmp_path, five_frames_of(source), source.name)
        imported = import_file(path, up="y", unit_m=1.0)
        place = places(path, up="y", unit_m=1.0)
        assert len(place) == 5
        root = bvhio.readAsHierarchy(str(path))
        for frame in range(5):
            root.loadPose(frame)
            for joint, _, _ in root.layout():
                if joint.Name in imported.skeleton.joints:
                    at = place[frame, imported.skeleton.joints.index(joint.Name)]
                    # It reckons in single precision, and files are in centimetres or inches.
                    assert np.abs(np.array(joint.PositionWorld) - at).max() < 1e-4


def test_a_real_walk_is_as_tall_as_a_person(shared_data):
    place = places(shared_data / "clips" / "bvh" / "cmu_12_01_walk.bvh")
    assert 1.3 < np.ptp(place[0, :, 1]) < 1.8
    assert 3.0 < np.linalg.norm(place[-1, 0] - place[0, 0]) < 5.0
