from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from exporters import timeline
from exporters.palette import IDLE_RGB, action_colors
from exporters.timeline import write_timeline
from smd.doodle import Doodle, Dropout, Recording
from smd.errors import ExportError
from smd.recognition.tokens import Token, TokenRun
from smd.score import Alternative, Part, Score, Suggestion
from smd.score_file import score_from_json
from tests.naive.shaped import weights

ACTIONS = ("walk", "punch")


@pytest.fixture(scope="module")
def recording(performance) -> Recording:
    doodles = tuple(doodle for actor in performance.actors for doodle in actor.doodles)
    lost = Dropout("right-hand", 10.8, 11.2, "gap", bridged=False)
    return Recording(doodles, "made up", (lost,))


@pytest.fixture(scope="module")
def score(performance) -> Score:
    return score_from_json(performance.source["score"])


@pytest.fixture(scope="module")
def picture(recording, score, tmp_path_factory) -> np.ndarray:
    path = tmp_path_factory.mktemp("timeline") / "t.png"
    write_timeline(recording, score, path)
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def seconds(column: float, picture: np.ndarray) -> float:
    """Return the time at a column of the picture, whose lanes go from 10 to 12 s."""
    left, right = (timeline.DPI * inches for inches in timeline._SIDES_INCHES)
    return 10.0 + 2.0 * (column - left) / (picture.shape[1] - left - right)


def test_a_phrase_stands_over_its_time_in_its_colour(picture):
    for action, (start_s, end_s) in {"walk": (10.2, 10.9), "punch": (11.2, 11.8)}.items():
        rgb = np.round(255 * np.array(action_colors(ACTIONS)[action]))
        rows, columns = np.nonzero(np.abs(picture - rgb).max(axis=-1) <= 1)
        # Of the two devices, the first's lanes have no dropout over them.
        columns = columns[rows < picture.shape[0] / 2]
        assert seconds(columns.min(), picture) == pytest.approx(start_s, abs=0.01)
        assert seconds(columns.max() + 1, picture) == pytest.approx(end_s, abs=0.01)


def test_what_is_suggested_is_an_outline_over_its_time(recording, score, picture, tmp_path):
    walk = Alternative("walk", 12.0, 10.0, "too slow")
    first, *others = score.performers
    suggesting = replace(first, suggestions=(Suggestion(11.3, 11.7, (walk,)),), phrases=())
    suggests = replace(score, performers=(suggesting, *others))
    write_timeline(recording, suggests, tmp_path / "t.png")
    drawn = np.asarray(Image.open(tmp_path / "t.png").convert("RGB")).astype(int)
    rgb = np.round(255 * np.array(IDLE_RGB))
    upper = slice(0, picture.shape[0] // 2)
    outline = np.abs(drawn[upper] - rgb).max(axis=-1) <= 1
    rows, columns = np.nonzero(outline)
    sides = [columns.min(), columns.max()]
    assert [seconds(side + 0.5, picture) for side in sides] == pytest.approx([11.3, 11.7], abs=0.02)
    inside = drawn[rows.min() + 4 : rows.max() - 3, columns.min() + 4 : columns.max() - 3]
    assert (inside.min(axis=-1) >= 250).mean() > 0.5  # paper, but for the name


def test_an_implied_phrase_is_paler(score):
    (walk, *_), colors = score.performers[0].phrases, action_colors(ACTIONS)
    implied = Part("a", (replace(walk, implied=True),))
    (meant,) = timeline._phrase_blocks(Part("a", (walk,)), colors)
    (block,) = timeline._phrase_blocks(implied, colors)
    assert all(ours > theirs for ours, theirs in zip(block.color, meant.color, strict=True))
    assert (block.texts, block.half) == (("walk",), "lower")
    wave = Suggestion(10.3, 10.6, (Alternative("wave", 2.0),))
    (above,) = timeline._suggestion_blocks(replace(implied, suggestions=(wave,)))
    assert above.half == "upper"


def test_a_dropout_is_marked_over_its_time_in_its_device_alone(recording, score, picture, tmp_path):
    write_timeline(replace(recording, dropouts=()), score, tmp_path / "t.png")
    without = np.asarray(Image.open(tmp_path / "t.png").convert("RGB")).astype(int)
    rows, columns = np.nonzero((picture != without).any(axis=-1))
    assert rows.min() > 0.5 * picture.shape[0]
    assert seconds(columns.min(), picture) == pytest.approx(10.8, abs=0.01)
    assert seconds(columns.max() + 1, picture) == pytest.approx(11.2, abs=0.01)


def test_the_same_input_gives_the_same_bytes(recording, score, tmp_path):
    for name in ("a.png", "b.png"):
        write_timeline(recording, score, tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_equal_halves_of_neighbouring_tokens_are_one_block():
    ahead, up, left = (0, 0, 1), (0, 1, 0), (1, 0, 0)
    tokens = [Token(), Token(ahead), Token(ahead, left), Token(up, left), Token()]
    runs = [TokenRun(token, i, i + 1, float(i), i + 1.0) for i, token in enumerate(tokens)]
    moves = timeline._token_blocks([runs], lambda token: token.translation, "T")
    turns = timeline._token_blocks([runs], lambda token: token.rotation, "R")
    assert [(b.start_s, b.end_s, b.texts) for b in moves] == [(1, 3, ("T_Z",)), (3, 4, ("T_Y",))]
    assert [(b.start_s, b.end_s, b.texts) for b in turns] == [(2, 4, ("R_X",))]


def test_a_block_never_reaches_over_a_loss_of_tracking():
    runs = [TokenRun(Token((0, 0, 1)), 0, 1, 0.0, 1.0)]
    later = [TokenRun(Token((0, 0, 1)), 0, 1, 5.0, 6.0)]
    blocks = timeline._token_blocks([runs, later], lambda token: token.translation, "T")
    assert [(b.start_s, b.end_s) for b in blocks] == [(0.0, 1.0), (5.0, 6.0)]


def test_a_recording_of_one_sample_and_no_phrase_is_drawn_too(tmp_path):
    still = Doodle(np.array([1.0]), np.zeros((1, 3)), np.array([[0.0, 0.0, 0.0, 1.0]]))
    write_timeline(Recording((still,)), Score((Part("prop"),)), tmp_path / "t.png")
    assert (tmp_path / "t.png").stat().st_size > 1000


def test_an_hour_is_not_wider_than_a_picture_may_be(tmp_path):
    time_s = np.linspace(0.0, 3600.0, 40)
    slow = Doodle(time_s, np.zeros((40, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (40, 1)))
    figure, _ = timeline._sheet([False], 0.0, float(slow.duration_s))
    assert figure.get_figwidth() * timeline.DPI < 2**16 / 2


def test_a_missing_folder_is_named(recording, score, tmp_path):
    with pytest.raises(ExportError, match="nowhere"):
        write_timeline(recording, score, tmp_path / "nowhere" / "t.png")


def test_devices_that_the_score_leaves_out_are_left_out(recording, score, tmp_path):
    one = replace(score, performers=score.performers[:1])
    write_timeline(recording, one, tmp_path / "one.png")
    write_timeline(recording, score, tmp_path / "two.png")
    with Image.open(tmp_path / "one.png") as a, Image.open(tmp_path / "two.png") as b:
        assert a.height < 0.65 * b.height


def test_an_actor_s_tracks_are_drawn_in_a_lane_of_their_own(
    recording, score, performance, picture, tmp_path
):
    """The first of two actors has a face: its lane makes the picture higher, once."""
    faced = replace(performance.actors[0], tracks=weights(len(performance)))
    acted = replace(performance, actors=(faced, *performance.actors[1:]))
    drawn = []
    for name, acts in (("with", acted), ("without", performance)):
        write_timeline(recording, score, tmp_path / f"{name}.png", acts)
        drawn.append(np.asarray(Image.open(tmp_path / f"{name}.png").convert("RGB")).astype(int))
    assert np.array_equal(drawn[1], picture)
    higher = drawn[0].shape[0] - picture.shape[0]
    assert higher == pytest.approx(timeline._TRACKS_INCHES * timeline.DPI, abs=1)
    # The lane is below the first device's others; the track that changes most is drawn first.
    head = timeline._HEAD_INCHES + sum(timeline._LANES.values())
    first, end = (round(timeline.DPI * at) for at in (head, head + timeline._TRACKS_INCHES))
    rows, columns = np.nonzero(np.abs(drawn[0][first:end] - [0x1F, 0x77, 0xB4]).max(axis=-1) <= 2)
    value = weights(len(performance)).value
    most = value[:, np.ptp(value, axis=0).argmax()]
    share = (seconds(columns, drawn[0]) - 10.0) / 2.0
    shown = np.interp(share, np.linspace(0.0, 1.0, len(most)), most)
    low, high = -0.08, 1.08
    found = high - (rows + 0.5) / (end - first) * (high - low)
    inside = share <= 1.0  # names stand beside
    assert inside.sum() > 300
    assert np.abs(found - shown)[inside].max() < 0.1
