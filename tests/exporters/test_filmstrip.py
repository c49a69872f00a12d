from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from exporters import filmstrip, strip
from exporters.figures import read_scene
from exporters.filmstrip import write_filmstrip
from exporters.usd import write_usd
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.errors import ExportError


@pytest.fixture(scope="module")
def usd(performance, tmp_path_factory):
    path = tmp_path_factory.mktemp("film") / "take.usdc"
    write_usd(performance, path)
    return path


@pytest.fixture(scope="module")
def picture(usd):
    """The filmstrip; a machine that cannot render has none, and says so."""
    path = usd.with_name("take.png")
    try:
        write_filmstrip(usd, path)
    except ExportError as error:
        if "this machine cannot render" not in str(error):
            raise
        pytest.skip(str(error))
    return path


def cell(image: np.ndarray, row: int, column: int) -> np.ndarray:
    """Return one picture of a strip, without its frame."""
    width, height = strip.CELL_PX
    left = strip.LABEL_PX + column * (width + strip.GAP_PX)
    top = strip.HEADER_PX + row * (height + strip.GAP_PX)
    return image[top + 25 : top + height - 2, left + 2 : left + width - 2].astype(float)


def body_pixels(pixels: np.ndarray) -> np.ndarray:
    """Return where the picture is neither ground nor grid nor shadow: dark or colourful."""
    return (pixels.min(axis=-1) < 130) & (np.ptp(pixels, axis=-1) < 180)


def test_a_row_per_phrase_and_eight_pictures_a_row(picture):
    image = np.asarray(Image.open(picture))
    rows = (image.shape[0] - strip.HEADER_PX) // (strip.CELL_PX[1] + strip.GAP_PX)
    assert rows == 4  # two phrases each
    for row in range(rows):
        for column in range(strip.COLUMNS):
            share = body_pixels(cell(image, row, column)).mean()
            assert 0.02 < share < 0.5


def test_neighbouring_pictures_differ_as_the_body_moves(picture):
    image = np.asarray(Image.open(picture))
    for column in range(strip.COLUMNS - 1):
        change = np.abs(cell(image, 0, column + 1) - cell(image, 0, column))
        assert (change.max(axis=-1) > 40).mean() > 0.01


def test_the_body_keeps_clear_of_the_pictures_edges(picture):
    image = np.asarray(Image.open(picture))
    for row in range(4):
        for column in range(strip.COLUMNS):
            body = body_pixels(cell(image, row, column))
            assert not body[:, :3].any()
            assert not body[:, -3:].any()


def test_fewer_rows_are_the_first_ones_drawn_the_same(usd, picture, tmp_path):
    write_filmstrip(usd, tmp_path / "short.png", rows=1)
    short = np.asarray(Image.open(tmp_path / "short.png"))
    assert short.shape[0] == strip.HEADER_PX + strip.CELL_PX[1] + 2 * strip.GAP_PX
    whole = np.asarray(Image.open(picture))
    assert np.array_equal(
        short[strip.HEADER_PX : -strip.GAP_PX],
        whole[strip.HEADER_PX : short.shape[0] - strip.GAP_PX],
    )


def test_what_is_read_back_stands_where_it_was_put(usd, performance):
    scene = read_scene(usd)
    assert [figure.name for figure in scene.figures] == ["left hand", "right-hand"]
    assert (scene.first_s, scene.last_s) == (10.0, 12.0)
    for figure, actor in zip(scene.figures, performance.actors, strict=True):
        assert figure.phrases == actor.phrases
    for figure, actor in zip(scene.figures, performance.actors, strict=True):
        skeleton = actor.character.skeleton
        for frame in (0, 11, 48):
            pose = forward_kinematics(
                skeleton, actor.poses.rotation_xyzw[frame], actor.poses.translation_m[frame]
            )
            code = scene.time_code(10.0 + frame / 24.0)
            ours = skin_points(actor.character.meshes[0], skeleton, *pose)
            np.testing.assert_allclose(figure.points_m(code), ours, atol=2e-5)
            np.testing.assert_allclose(figure.joints_m(code), pose[1], atol=2e-5)
            heading = 0.5 * frame / 24.0  # the wave turns left at 0.5 rad/s
            front = figure.front(code)
            assert np.arctan2(front[0], front[2]) == pytest.approx(heading, abs=0.25)


def test_a_stage_in_centimetres_with_z_up_is_read_in_metres_with_y_up(usd, tmp_path):
    from pxr import Sdf, Usd, UsdGeom

    stage = Usd.Stage.Open(Sdf.Layer.OpenAsAnonymous(str(usd)))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    stage.GetRootLayer().Export(str(tmp_path / "z.usdc"))
    ours, theirs = read_scene(usd).figures[0], read_scene(tmp_path / "z.usdc").figures[0]
    x, y, z = ours.points_m(3).T
    np.testing.assert_allclose(theirs.points_m(3), 0.01 * np.stack([x, z, -y], axis=-1), atol=1e-6)


def test_real_characters_are_read(shared_data):
    scene = read_scene(shared_data / "clips" / "usd" / "CesiumMan.usdz")
    (figure,) = scene.figures
    assert figure.phrases == ()
    height_m = np.ptp(figure.points_m(scene.start_code)[:, 1])
    assert 1.2 < height_m < 2.0
    rows = list(strip._rows(scene, 12))
    assert rows[0].start_s == scene.first_s
    assert rows[-1].end_s == pytest.approx(scene.last_s)


def test_windows_cover_all_the_time_in_as_many_rows_as_there_may_be(performance, tmp_path):
    actors = tuple(replace(actor, phrases=()) for actor in performance.actors)
    write_usd(replace(performance, actors=actors), tmp_path / "a.usdc")
    scene = read_scene(tmp_path / "a.usdc")
    for most in (1, 2, 3, 12):
        rows = list(strip._rows(scene, most))
        assert len(rows) <= max(most, 2)  # at least one of each figure
        assert (rows[0].start_s, rows[-1].end_s) == (10.0, 12.0)
        assert {row.figure for row in rows} == {0, 1}


@pytest.mark.parametrize(
    ("content", "named"), [(None, "found none"), (b"", "USD"), (b"#usda 1.0\n", "UsdSkel")]
)
def test_a_file_without_a_character_is_refused(tmp_path, content, named):
    path = tmp_path / "x.usda"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ExportError, match=named) as caught:
        read_scene(path)
    assert "x.usda" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_the_drawing_process_refuses_is_said_in_its_words(tmp_path):
    with pytest.raises(ExportError, match=r"^\S*x\.usda: expected a USD file, found none$"):
        write_filmstrip(tmp_path / "x.usda", tmp_path / "x.png")
    assert list(tmp_path.iterdir()) == []


def test_a_renderer_that_crashes_is_an_error_with_its_last_words(usd, tmp_path, monkeypatch):
    crash = tmp_path / "exporters"
    crash.mkdir()
    (crash / "__init__.py").write_text("")
    (crash / "strip.py").write_text(
        "import os, sys\n"
        "sys.stderr.write('\\x1b[33m( 1.0s) window:150   WARN| no graphics here\\x1b[0m\\n')\n"
        "sys.stderr.flush()\n"
        "os.abort()\n"
    )
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    with pytest.raises(ExportError, match=r"x\.png: .*cannot render.*: no graphics here$"):
        write_filmstrip(usd, tmp_path / "x.png")
    assert not (tmp_path / "x.png").exists()


def test_an_interpreter_that_does_not_start_is_an_error(usd, tmp_path, monkeypatch):
    monkeypatch.setattr(filmstrip.sys, "executable", str(tmp_path / "no-python"))
    with pytest.raises(ExportError, match="did not run"):
        write_filmstrip(usd, tmp_path / "x.png")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="hides Linux's graphics drivers")
def test_a_machine_without_graphics_is_told_so(usd, tmp_path, monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    monkeypatch.delenv("DISPLAY", raising=False)
    try:
        write_filmstrip(usd, tmp_path / "x.png")
    except ExportError as error:
        assert "this machine cannot render" in str(error)
        assert not (tmp_path / "x.png").exists()


def test_a_missing_folder_for_the_picture_is_named_before_anything_is_drawn(tmp_path):
    with pytest.raises(ExportError, match="nowhere"):
        write_filmstrip(tmp_path / "absent.usdc", tmp_path / "nowhere" / "x.png")
