"""A face of one's own, from its file to the animation: what a user types."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdSkel, Vt

from actions_library.folder import load_library
from exporters.usd import write_usd
from smd.acting.performance import Performance
from tests.naive.shaped import NAMES, shaped_performance
from tests.smd.cli.test_library_making import content, refused

ANIMATION = "/Performance/Actors/left_hand_character/left_hand_animation"
MESH = "/Performance/Actors/left_hand_character/Body"


def one_actor() -> Performance:
    whole = shaped_performance(seconds=2.0)
    return replace(whole, actors=whole.actors[:1])


@pytest.fixture
def file(tmp_path) -> Path:
    write_usd(one_actor(), tmp_path / "face.usdc")
    return tmp_path / "face.usdc"


@pytest.fixture
def mine(run_smd, file, tmp_path) -> Path:
    code, out, _ = run_smd("library", "new", tmp_path / "mine", "--character", file)
    assert code == 0
    assert "2 meshes, 3 shapes" in out
    return tmp_path / "mine"


def test_a_story_is_acted_out_with_its_clips_faces(run_smd, mine, file, stories, tmp_path):
    code, out, _ = run_smd("library", "import", mine, file, "--action", "idle")
    assert code == 0
    assert "moves 3 shapes: smile, jaw open, müde" in out
    assert run_smd("library", "check", "--library", mine)[0] == 0
    code, _, err = run_smd(
        *("convert", stories / "duel.csv", "--library", mine, "-o", tmp_path / "duel.usdc")
    )
    assert code == 0, err
    stage = Usd.Stage.Open(str(tmp_path / "duel.usdc"))
    found = [UsdSkel.Animation(p) for p in stage.Traverse() if p.IsA(UsdSkel.Animation)]
    assert len(found) == 2
    for animation in found:
        assert set(animation.GetBlendShapesAttr().Get()) == set(NAMES)
        weights = [animation.GetBlendShapeWeightsAttr().Get(code) for code in range(0, 120, 10)]
        assert (np.ptp(weights, axis=0) > 0.3).all()


def test_a_clip_for_a_character_without_a_face_says_what_it_leaves_out(run_smd, file, tmp_path):
    shipped = load_library().folder / "character.usdc"
    run_smd("library", "new", tmp_path / "plain", "--character", shipped)
    code, out, _ = run_smd("library", "import", tmp_path / "plain", file, "--action", "walk")
    assert code == 0
    assert (
        "note: the character lacks 3 shapes that the file moves, left out: smile, jaw open" in out
    )


def edited(file: Path, path: str, value: object) -> None:
    """Give an attribute of a file another value, at each of its times."""
    layer = Sdf.Layer.FindOrOpen(str(file))
    times = layer.ListTimeSamplesForPath(path)
    for time in times:
        layer.SetTimeSample(path, time, value)
    if not times:
        layer.GetAttributeAtPath(path).default = value
    layer.Save()


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (f"{MESH}/smile.offsets", Vt.Vec3fArray(3), r"Body/smile: expected \d+ offsets, found 3"),
        (f"{MESH}/smile.offsets", Vt.Vec3fArray(1, (np.nan, 0.0, 0.0)), "expected finite offsets"),
        (f"{MESH}/smile.pointIndices", Vt.IntArray(1, 99999), "expected 1 offsets, found"),
        (
            f"{ANIMATION}.blendShapes",
            Vt.TokenArray(["smile", "jaw open", "frown"]),
            "blendShapes: expected shapes of its meshes, found 'frown'",
        ),
        (
            f"{ANIMATION}.blendShapeWeights",
            Vt.FloatArray(4),
            "blendShapeWeights, time code .*: expected 3 finite values, found 4",
        ),
    ],
)
def test_damaged_faces_are_refused_and_the_library_stays(
    run_smd, mine, file, tmp_path, path, value, said
):
    before = content(mine)
    edited(file, path, value)
    refused(run_smd("library", "import", mine, file, "--action", "wave"), "face.usdc", said)
    refused(run_smd("library", "new", tmp_path / "new", "--character", file), "face.usdc", said)
    assert content(mine) == before
    assert not (tmp_path / "new").exists()
