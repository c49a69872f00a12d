"""Every format takes a performance that no Score and no recording ever saw."""

from __future__ import annotations

import numpy as np
import pytest

import exporters
from exporters.figures import read_scene
from exporters.filmstrip import write_filmstrip
from exporters.phrases import COLUMNS, write_phrase_table
from exporters.usd import write_usd_layers
from smd.acting.act import grounded_actor
from smd.acting.legs import legs_of, sole_height, world_of
from smd.acting.move import Footwork
from smd.acting.performance import Performance
from smd.character.poses import Poses
from smd.errors import TransferError
from tests.naive.puppet import puppet, wave

SUFFIXES = sorted(suffix for one in exporters.FORMATS for suffix in one.suffixes)
USD = [suffix for suffix in SUFFIXES if suffix.startswith(".usd")]
RATE_HZ = 30.0


@pytest.fixture(scope="module")
def danced() -> Performance:
    """Two puppets that wave on one leg: poses and footwork, nothing else."""
    character = puppet()
    skeleton = character.skeleton
    legs = legs_of(skeleton, [skeleton.index(f"{side}_foot") for side in ("left", "right")])
    rotation, translation = wave(20, RATE_HZ)
    stands = np.tile([True, False], (20, 1))
    actors = []
    for index, name in enumerate(("swan", "prince")):
        moved = translation.copy()
        moved[:, 0, 0] += 1.5 * index
        poses, footwork = Poses(rotation, moved), Footwork(stands, np.zeros((20, 2)))
        actors.append(grounded_actor(name, character, poses, footwork, legs, rate_hz=RATE_HZ))
    return Performance(RATE_HZ, 0.0, tuple(actors))


@pytest.mark.parametrize("suffix", USD)
def test_it_is_written_and_read_back_where_it_was(danced, suffix, tmp_path):
    path = tmp_path / f"dance{suffix}"
    exporters.write(danced, path)
    scene = read_scene(path)
    assert [figure.name for figure in scene.figures] == ["swan", "prince"]
    assert (scene.first_s, scene.rate_hz) == (0.0, RATE_HZ)
    for figure, actor in zip(scene.figures, danced.actors, strict=True):
        _, place_m = world_of(
            actor.character.skeleton, actor.character.skeleton.index("head"), *actor.poses
        )
        head = actor.character.skeleton.index("head")
        read = [figure.joints_m(scene.time_code(i / RATE_HZ))[head] for i in range(len(danced))]
        np.testing.assert_allclose(read, place_m, atol=1e-4)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_performance_gives_the_same_bytes(danced, suffix, tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        exporters.write(danced, tmp_path / name / f"dance{suffix}")
    one, other = ((tmp_path / name / f"dance{suffix}").read_bytes() for name in ("a", "b"))
    assert one == other


def test_what_goes_beside_it_is_written_too(danced, tmp_path):
    write_usd_layers(danced, tmp_path / "dance.usda")
    assert {path.name for path in tmp_path.iterdir()} == {
        "dance.usda",
        "dance.swan.usdc",
        "dance.prince.usdc",
    }
    write_phrase_table(danced, tmp_path / "dance.csv")
    assert (tmp_path / "dance.csv").read_text(encoding="utf-8") == ",".join(COLUMNS) + "\n"
    write_filmstrip(tmp_path / "dance.usda", tmp_path / "dance.png", rows=2)
    assert (tmp_path / "dance.png").stat().st_size > 1000


def test_a_foot_that_should_stand_does_where_the_poses_slid(danced):
    """The poses slide at 1 m/s to where the leg no longer reaches; until then the sole rests."""
    actor = danced.actors[0]
    skeleton = actor.character.skeleton
    (leg,) = legs_of(skeleton, [skeleton.index("left_foot")])
    turn, ankle_m = world_of(skeleton, leg.foot, *actor.poses)
    slid_m = np.linalg.norm(ankle_m[8, [0, 2]] - ankle_m[2, [0, 2]])
    assert slid_m < 0.5 * 6 / RATE_HZ
    assert sole_height(leg, turn, ankle_m).min() > -1e-3


def test_actors_need_names_of_their_own(danced):
    one = danced.actors[0]
    with pytest.raises(TransferError, match="actor 'swan' appears twice"):
        Performance(RATE_HZ, 0.0, (one, one))
