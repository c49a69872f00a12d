from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from smd.errors import RecordingError
from smd.formats import Mount, SourceFrame
from smd.formats.frame import AXES
from smd.geometry.rotations import matrix_from_quaternion

DIRECTION = {
    name: np.eye(3)["xyz".index(name[-1])] * (-1.0 if name[0] == "-" else 1.0) for name in AXES
}
FRAMES = [
    (up, front, hand)
    for up, front, hand in product(AXES, AXES, ("right", "left"))
    if up[-1] != front[-1]
]


def converted(frame: SourceFrame, position: np.ndarray, matrix: np.ndarray):
    """Pose in our convention, its rotation as a matrix."""
    quaternion = Rotation.from_matrix(matrix).as_quat()
    p, q = frame.completed(SourceFrame.ours()).conversion().poses(position[None], quaternion[None])
    return p[0], matrix_from_quaternion(q[0])


def world_matrix(frame: SourceFrame) -> np.ndarray:
    """The 3x3 matrix of the world's conversion, from how it moves the axes."""
    return np.stack([converted(frame, axis, np.eye(3))[0] for axis in np.eye(3)], axis=1)


@pytest.mark.parametrize(("up", "front", "hand"), FRAMES)
def test_the_world_is_set_upright_rigidly_and_mirrored_only_if_left_handed(up, front, hand):
    world = world_matrix(SourceFrame(up=up, front=front, handedness=hand))
    assert_allclose(world @ world.T, np.eye(3), atol=1e-12)
    assert_allclose(np.linalg.det(world), 1.0 if hand == "right" else -1.0)
    assert_allclose(world @ DIRECTION[up], [0, 1, 0], atol=1e-12)


@pytest.mark.parametrize(("up", "front", "hand"), FRAMES)
def test_a_device_at_identity_stands_upright_and_faces_where_its_front_goes(up, front, hand):
    frame = SourceFrame(up=up, front=front, handedness=hand)
    world, (_, rotation) = world_matrix(frame), converted(frame, np.zeros(3), np.eye(3))
    assert_allclose(rotation @ [0, 1, 0], [0, 1, 0], atol=1e-12)
    assert_allclose(rotation @ [0, 0, 1], world @ DIRECTION[front], atol=1e-12)


@pytest.mark.parametrize(("up", "front", "hand"), FRAMES)
def test_rotations_are_converted_as_their_matrices_between_the_two_frames(up, front, hand):
    """R' = W R W_device^-1: a point of the device lands at the same place of the world."""
    frame = SourceFrame(up=up, front=front, handedness=hand)
    world = world_matrix(frame)
    device = converted(frame, np.zeros(3), np.eye(3))[1].T @ world  # ours from the file's
    for seed in range(5):
        rotation = Rotation.random(random_state=seed).as_matrix()
        position = np.random.default_rng(seed).normal(size=3)
        p, ours = converted(frame, position, rotation)
        assert_allclose(p, world @ position, atol=1e-12)
        assert_allclose(ours, world @ rotation @ device.T, atol=1e-12)


def test_unity_is_mirrored_as_m_r_m():
    mirror = np.diag([-1.0, 1.0, 1.0])
    frame = SourceFrame.from_options(handedness="left")
    for seed in range(10):
        rotation = Rotation.random(random_state=seed).as_matrix()
        position = np.random.default_rng(seed).normal(size=3)
        p, ours = converted(frame, position, rotation)
        assert_allclose(p, mirror @ position)
        assert_allclose(ours, mirror @ rotation @ mirror, atol=1e-12)


def test_a_left_handed_turn_to_the_right_is_a_turn_to_the_right_of_ours():
    """Unity: a positive turn about Y brings forward Z to right X. Our right is -X."""
    forward_to_right = Rotation.from_euler("y", 90, degrees=True).as_matrix()
    _, ours = converted(SourceFrame(handedness="left"), np.zeros(3), forward_to_right)
    assert_allclose(ours @ [0, 0, 1], [-1, 0, 0], atol=1e-12)


def test_z_up_is_converted_as_cad_and_robots_expect():
    blender = SourceFrame.from_options(up="z")
    assert_allclose(world_matrix(blender), [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-12)
    assert_allclose(converted(blender, np.zeros(3), np.eye(3))[1], np.eye(3), atol=1e-12)
    ros = SourceFrame.from_options(up="z", front="x")  # x front, y left, z up
    _, rotation = converted(ros, np.zeros(3), np.eye(3))
    assert_allclose(rotation @ [0, 0, 1], world_matrix(ros) @ [1, 0, 0], atol=1e-12)
    assert_allclose(rotation @ [1, 0, 0], world_matrix(ros) @ [0, 1, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("unit", "metres"), [("cm", 0.01), ("mm", 1e-3), ("in", 0.0254), ("ft", 0.3048)]
)
def test_units_scale_positions_and_not_levers(unit, metres):
    frame = SourceFrame.from_options(unit=unit, mount="z=0.5")
    p, _ = converted(frame, np.array([1.0, 2.0, 3.0]), np.eye(3))
    assert_allclose(p, np.array([1.0, 2.0, 3.0]) * metres + [0, 0, 0.5])


def test_quaternions_may_come_with_their_real_part_first():
    q = Rotation.random(random_state=1).as_quat()
    frame = SourceFrame.from_options(quaternion="wxyz").completed(SourceFrame.ours())
    _, ours = frame.conversion().poses(np.zeros((1, 3)), np.roll(q, 1)[None])
    assert_allclose(ours[0], q)


def test_a_mount_turns_and_steps_in_the_trackers_frame():
    mount = Mount.parse("yaw=90,x=0.1,z=-0.05")
    tracker = Rotation.from_euler("y", 90, degrees=True)
    p, rotation = converted(SourceFrame(mount=mount), np.array([1.0, 0, 0]), tracker.as_matrix())
    assert_allclose(p, np.array([1.0, 0, 0]) + tracker.apply([0.1, 0, -0.05]), atol=1e-12)
    assert_allclose(rotation, Rotation.from_euler("y", 180, degrees=True).as_matrix(), atol=1e-12)


def test_mount_angles_are_yaw_then_pitch_then_roll():
    mount = Mount(yaw_deg=30, pitch_deg=-40, roll_deg=50)
    expected = Rotation.from_euler("YXZ", [30, -40, 50], degrees=True).as_matrix()
    assert_allclose(matrix_from_quaternion(mount.tracker_from_prop_xyzw), expected, atol=1e-12)


def test_a_prop_turned_about_its_centre_does_not_translate_once_its_lever_is_known():
    """The tracker circles the centre; with the mount, the prop stays where it is."""
    turns = Rotation.from_rotvec(np.outer(np.linspace(0, 2, 20), [0, 1, 0]))
    lever = np.array([0.0, -0.1, 0.07])
    tracker = np.array([1.0, 1.0, 1.0]) - turns.apply(lever)
    frame = SourceFrame.from_options(mount="y=-0.1,z=0.07").completed(SourceFrame.ours())
    p, _ = frame.conversion().poses(tracker, turns.as_quat())
    assert_allclose(p, np.ones((20, 3)), atol=1e-12)


@pytest.mark.parametrize(
    "frame",
    [
        SourceFrame(),
        SourceFrame.from_options(up="-Z", front="+x", handedness="LEFT", unit=" cm "),
        SourceFrame.from_options(quaternion="wxyz", mount="pitch=-90.5,y=0.1"),
        SourceFrame(mount=Mount()),
    ],
)
def test_options_read_back_as_they_are_written(frame):
    assert SourceFrame.from_options(**frame.options()) == frame


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"up": "w"}, "up: expected one of x -x y -y z -z, found 'w'"),
        ({"front": ""}, "front: expected one of x -x y -y z -z, found ''"),
        ({"handedness": "both"}, "handedness: expected one of right left, found 'both'"),
        ({"unit": "km"}, "unit: expected one of m cm mm in ft, found 'km'"),
        ({"quaternion": "zyxw"}, "quaternion: expected one of xyzw wxyz, found 'zyxw'"),
        *(
            (
                {"mount": text},
                "mount: expected yaw, pitch, roll, x, y, z each at most once, as in "
                f"yaw=180,z=-0.05 (degrees, metres), found {found!r}",
            )
            for text, found in [
                ("yaw", "yaw"),
                ("yaw=a", "yaw=a"),
                ("yaw=nan", "yaw=nan"),
                ("turn=3", "turn=3"),
                ("x=1, x=2", "x=2"),
                ("", ""),
            ]
        ),
    ],
)
def test_an_option_that_cannot_be_understood_is_named(options, message):
    with pytest.raises(RecordingError) as caught:
        SourceFrame.from_options(**options)
    assert str(caught.value) == message


def test_a_front_along_up_is_refused():
    with pytest.raises(
        RecordingError, match=r"front: expected an axis across up \(y\), found '-y'"
    ):
        SourceFrame(front="-y").completed(SourceFrame.ours()).conversion()


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize(("up", "front"), [("y", "z"), ("z", "-y"), ("-y", "x"), ("x", "-z")])
@pytest.mark.parametrize("quaternion", ["xyzw", "wxyz"])
def test_a_conversion_is_undone_to_the_sources_numbers(up, front, hand, quaternion):
    rng = np.random.default_rng(3)
    frame = SourceFrame(up, front, hand, "cm", quaternion, Mount(30.0, -50.0, 70.0, 0.1, -0.2, 0.3))
    conversion = frame.conversion()
    position, q = rng.standard_normal((5, 3)), rng.standard_normal((5, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    again, q_again = conversion.numbers(*conversion.poses(position, q))
    assert_allclose(again, position, atol=1e-9)
    assert_allclose(np.abs(np.sum(q_again * q, axis=1)), 1.0, atol=1e-12)
