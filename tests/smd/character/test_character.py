from __future__ import annotations

import numpy as np
import pytest

from smd.character.blend_shape import BlendShape
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError


def skeleton() -> Skeleton:
    return Skeleton(
        joints=("root", "end"),
        parents=np.array([-1, 0]),
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (2, 1)),
        rest_translation_m=np.zeros((2, 3)),
        world_from_bind=np.tile(np.eye(4), (2, 1, 1)),
        roles=("root", "end_effector"),
    )


def parts() -> dict[str, object]:
    """What a mesh of one triangle is made of."""
    return {
        "name": "sail",
        "points_m": np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.5, 0.0]]),
        "triangles": np.array([[0, 1, 2]]),
        "joint_indices": np.array([[0, 1, 0, 0]] * 3),
        "joint_weights": np.array([[0.25, 0.75, 0.0, 0.0]] * 3),
    }


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("points_m", np.zeros((3, 2)), r"points_m: expected shape \(any, 3\)"),
        ("points_m", np.full((3, 3), np.inf), "points_m: expected finite numbers, got inf"),
        ("triangles", np.zeros((0, 3)), "triangles: expected indices below 3"),
        ("triangles", [[0, 1, 3]], "triangles: expected indices below 3"),
        ("triangles", [[0, 1, -1]], "triangles: expected indices below 3"),
        ("joint_indices", np.zeros((3, 2)), r"joint_indices: expected shape \(3, 4\)"),
        ("joint_weights", np.zeros((2, 4)), r"joint_weights: expected shape \(3, 4\)"),
        ("joint_weights", [[0.5, 0.4, 0.0, 0.0]] * 3, "joint_weights: expected sums of 1"),
        ("joint_weights", [[1.5, -0.5, 0.0, 0.0]] * 3, "joint_weights: expected sums of 1"),
    ],
)
def test_what_is_no_mesh_is_refused_by_name(name, value, message):
    with pytest.raises(CharacterError, match=message):
        Mesh(**(parts() | {name: value}))


@pytest.mark.parametrize("joint", [-1, 2])
def test_a_mesh_must_name_joints_of_its_skeleton(joint):
    indices = np.array([[0, 1, 0, joint]] * 3)
    with pytest.raises(CharacterError, match="'sail': joint_indices beyond the skeleton"):
        Character("boat", skeleton(), (Mesh(**(parts() | {"joint_indices": indices})),))


def test_a_characters_height_is_that_of_its_highest_point():
    low = Mesh(**(parts() | {"points_m": np.zeros((3, 3))}))
    assert Character("boat", skeleton(), (low, Mesh(**parts()))).height_m == 2.5


def test_a_mesh_does_not_change_with_the_arrays_it_was_made_of():
    given = parts()
    mesh = Mesh(**given)
    given["points_m"][0] = 9.0
    assert mesh.points_m.max() == 2.5


def test_a_shape_of_another_meshs_size_is_refused():
    shape = BlendShape("smile", np.array([0, 3]), np.zeros((2, 3)))
    with pytest.raises(CharacterError, match="'sail': shape 'smile': expected indices below 3"):
        Mesh(**(parts() | {"shapes": (shape,)}))


def test_a_mesh_has_each_shape_once_and_a_character_names_shapes_of_all_meshes_once():
    one, two = (BlendShape(n, np.array([0]), np.zeros((1, 3))) for n in ("smile", "jaw"))
    with pytest.raises(CharacterError, match="'sail': shapes: expected unique names"):
        Mesh(**(parts() | {"shapes": (one, one)}))
    meshes = [Mesh(**(parts() | {"shapes": shapes})) for shapes in ((one,), (), (two, one))]
    assert Character("boat", skeleton(), tuple(meshes)).shapes == ("smile", "jaw")
