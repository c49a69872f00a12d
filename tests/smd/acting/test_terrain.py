from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom
from scipy.spatial import Delaunay

from actions_library.importers.usd_ground import read_terrain
from smd.acting.terrain import Terrain
from smd.errors import ImportedFileError, TransferError
from tests.naive.triangles import height_over

SQUARE = np.array([[-2.0, 0.0, -2.0], [-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def hills(seed: int, count: int = 40) -> Terrain:
    """Points at random heights, joined as Delaunay did it over the ground."""
    rng = np.random.default_rng(seed)
    places = rng.uniform(-5.0, 5.0, (count, 2))
    triangles = Delaunay(places).simplices
    points = np.stack([places[:, 0], rng.normal(0.0, 0.02, count), places[:, 1]], axis=-1)
    corners = points[triangles]
    up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 1]
    triangles[up < 0] = triangles[up < 0][:, ::-1]
    return Terrain(points, triangles)


@pytest.mark.parametrize("seed", range(2))
def test_heights_are_those_of_looking_at_every_triangle(seed):
    terrain = hills(seed)
    places = np.random.default_rng(seed + 100).uniform(-6.0, 6.0, (60, 2))
    found = terrain.height_at(places)
    for place, height in zip(places, found, strict=True):
        expected = height_over(terrain.points_m, terrain.triangles, *place)
        assert np.isnan(height) if expected is None else height == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(4))
def test_over_every_corner_and_edge_there_is_ground(seed):
    terrain = hills(seed)
    assert terrain.height_at(terrain.points_m[:, [0, 2]]) == pytest.approx(terrain.points_m[:, 1])
    inside = terrain.points_m[terrain.triangles].mean(axis=1)
    assert terrain.height_at(inside[:, [0, 2]]) == pytest.approx(inside[:, 1])
    middles = terrain.points_m[terrain.triangles][:, [0, 1]].mean(axis=1)
    assert not np.isnan(terrain.height_at(middles[:, [0, 2]])).any()


def test_a_slope_has_its_heights_and_its_normal():
    points = SQUARE + SQUARE[:, [0]] * [[0.0, 0.5, 0.0]]
    terrain = Terrain(points, FACES)
    places = np.random.default_rng(0).uniform(-2.0, 2.0, (3, 5, 2))
    assert terrain.height_at(places) == pytest.approx(0.5 * places[..., 0])
    normal = np.array([-0.5, 1.0, 0.0]) / np.hypot(0.5, 1.0)
    assert terrain.normal_at(places) == pytest.approx(np.broadcast_to(normal, (3, 5, 3)))
    assert np.isnan(terrain.normal_at(np.array([9.0, 9.0]))).all()


def test_of_a_slab_the_top_counts_and_walls_do_not():
    box = np.concatenate([SQUARE, SQUARE - [0.0, 1.0, 0.0]])
    under = FACES[:, ::-1] + 4
    wall = np.array([[0, 4, 5], [0, 5, 1]])
    terrain = Terrain(box, np.concatenate([FACES, under, wall]))
    places = np.random.default_rng(0).uniform(-2.0, 2.0, (50, 2))
    assert terrain.height_at(places) == pytest.approx(0.0, abs=1e-12)
    assert not terrain.storeys_at(places).any()


def test_a_bridge_is_a_second_storey_below_and_above_which_is_none():
    bridge = SQUARE * [0.25, 1.0, 1.0] + [0.0, 2.5, 0.0]
    terrain = Terrain(np.concatenate([SQUARE, bridge]), np.concatenate([FACES, FACES + 4]))
    assert terrain.storeys_at(np.array([[0.0, 0.0], [1.0, 0.0], [9.0, 0.0]])).tolist() == [
        True,
        False,
        False,
    ]
    assert terrain.height_at(np.array([[0.0, 0.0], [1.0, 0.0]])) == pytest.approx([2.5, 0.0])


def test_a_ground_wound_the_other_way_round_is_ground():
    assert Terrain(SQUARE, FACES[:, ::-1]).height_at(np.zeros(2)) == 0.0


@pytest.mark.parametrize(
    ("points", "triangles", "message"),
    [
        (SQUARE, np.zeros((0, 3), int), "expected triangles, got none"),
        (SQUARE, [[0, 1, 4]], "expected triangles of its points"),
        (SQUARE[:, [1, 0, 2]], FACES, "expected a surface to stand on, found none"),
        (0.0 * SQUARE, FACES, "expected a surface to stand on, found none"),
    ],
)
def test_what_nobody_can_stand_on_is_refused(points, triangles, message):
    with pytest.raises(TransferError, match=f"^hill: {message}"):
        Terrain(points, triangles, name="hill")


def written(path, up=UsdGeom.Tokens.y, unit_m=1.0, points=SQUARE, **how):
    """A quad as a USD mesh."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, unit_m)
    mesh = UsdGeom.Mesh.Define(stage, "/World/Ground")
    mesh.CreatePointsAttr([Gf.Vec3f(*map(float, point)) for point in points])
    mesh.CreateFaceVertexCountsAttr([4])
    mesh.CreateFaceVertexIndicesAttr(how.get("corners", [0, 1, 2, 3]))
    if "orientation" in how:
        mesh.CreateOrientationAttr(how["orientation"])
    if "moved" in how:
        UsdGeom.Xformable(mesh).AddTranslateOp().Set(Gf.Vec3d(*how["moved"]))
    if how.get("hidden"):
        mesh.MakeInvisible()
    stage.GetRootLayer().Save()
    return path


def test_a_file_s_up_axis_unit_and_transforms_are_honoured(tmp_path):
    slope = SQUARE + SQUARE[:, [0]] * [[0.0, 0.25, 0.0]]
    places = np.random.default_rng(0).uniform(-1.5, 1.5, (20, 2))
    plain = read_terrain(written(tmp_path / "y.usda", points=slope, moved=(0.0, 3.0, 0.0)))
    assert plain.height_at(places) == pytest.approx(3.0 + 0.25 * places[:, 0], abs=1e-6)
    z_up = 100.0 * np.stack([slope[:, 0], -slope[:, 2], slope[:, 1]], axis=-1)
    other = written(tmp_path / "z.usda", up=UsdGeom.Tokens.z, unit_m=0.01, points=z_up)
    assert read_terrain(other).height_at(places) == pytest.approx(0.25 * places[:, 0], abs=1e-6)
    left = written(tmp_path / "l.usda", orientation="leftHanded", corners=[3, 2, 1, 0])
    assert read_terrain(left).normal_at(np.zeros(2)) == pytest.approx([0.0, 1.0, 0.0])


def test_a_file_without_ground_is_refused_in_one_line(tmp_path):
    (tmp_path / "no.usda").write_text("no USD at all", encoding="utf-8")
    empty = Usd.Stage.CreateNew(str(tmp_path / "empty.usda"))
    empty.GetRootLayer().Save()
    for path, message in (
        (tmp_path / "none.usda", "expected a USD file, found none"),
        (tmp_path / "no.usda", "expected a USD file"),
        (tmp_path / "empty.usda", "expected a mesh to walk on, found none"),
        (written(tmp_path / "hidden.usda", hidden=True), "expected a mesh to walk on, found none"),
        (written(tmp_path / "wrong.usda", corners=[0, 1, 2, 7]), "expected corners from 0 to 3"),
        (written(tmp_path / "few.usda", corners=[0, 1, 2]), "expected 4 corners of faces"),
        (written(tmp_path / "nan.usda", points=SQUARE * np.nan), "expected finite points"),
    ):
        with pytest.raises(ImportedFileError, match=message) as caught:
            read_terrain(path)
        assert "\n" not in str(caught.value)
