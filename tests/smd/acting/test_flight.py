from __future__ import annotations

import numpy as np
import pytest

from smd.acting.flight import (
    GRAVITY_M_S2,
    HIGHEST,
    LOWEST,
    Height,
    apex_for,
    flights,
)
from smd.acting.legs import feet_of, legs_of, sole_height, world_of
from smd.acting.move import Move
from smd.character.clip import Clip
from smd.doodle import Doodle, Recording
from smd.pipeline import animate
from smd.score import Part, Phrase, Score
from smd.transfer.repertoire import piece_of
from smd.transfer.scene import scene_scale

RATE_HZ = 120.0


def hop(action: str, lasting_s: float, rise_m: float) -> tuple[Recording, Score]:
    """A prop that stands, flies along a parabola for a phrase, and stands again."""
    time_s = np.arange(round((lasting_s + 2.0) * 90) + 1) / 90.0
    s = np.clip((time_s - 1.0) / lasting_s, 0.0, 1.0)
    place = np.stack([0.0 * s, 0.8 + 4.0 * rise_m * s * (1.0 - s), 0.1 * s], axis=-1)
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(s), 1)), "fox")
    part = Part("fox", (Phrase(action, 1.0, 1.0 + lasting_s),))
    return Recording((doodle,), source="hop"), Score((part,))


def piece(library, name):
    clip = library.clip(name)
    return piece_of(clip, travels=True, legs=legs_of(clip.skeleton, feet_of(clip)))


def move_of(piece, start_s, end_s):
    n = 240
    return Move(
        piece=piece,
        start_s=start_s,
        end_s=end_s,
        time_s=np.linspace(start_s, end_s, n),
        root_m=np.zeros((n, 2)),
        heading_rad=np.zeros(n),
        frame=np.linspace(0.0, piece.last_frame, n),
        presence=np.ones(n),
        airborne=piece.airborne,
    )


def test_the_prop_rises_over_the_line_between_its_ends():
    time_s = np.linspace(0.0, 4.0, 401)
    s = np.clip(time_s - 1.0, 0.0, 1.0)
    height = Height(time_s, 2.0 + 0.7 * time_s + 4.0 * 0.3 * s * (1.0 - s))
    assert height.rise_m(1.0, 2.0) == pytest.approx(0.3, abs=1e-3)
    assert height.rise_m(2.5, 3.5) == pytest.approx(0.0, abs=1e-12)
    assert Height(time_s, -height.height_m).rise_m(1.0, 2.0) == pytest.approx(0.0, abs=1e-12)


def test_a_body_that_rises_as_far_as_gravity_has_it_goes_as_high_as_thrown():
    thrown_m = GRAVITY_M_S2 * 0.5**2 / 8.0
    assert apex_for(thrown_m, 0.5, thrown_m) == pytest.approx(thrown_m)
    assert apex_for(4.0 * thrown_m, 0.5, thrown_m) == pytest.approx(2.0 * thrown_m)
    assert apex_for(0.0, 0.5, 0.3) == pytest.approx(LOWEST * 0.3)
    assert apex_for(0.0, 0.8, 0.3) == pytest.approx(GRAVITY_M_S2 * 0.8**2 / 8.0 / 3.0)
    assert apex_for(50.0, 0.5, 0.3) == pytest.approx(HIGHEST * 0.3)
    assert apex_for(None, 0.5, thrown_m) == pytest.approx(thrown_m)


def test_what_flies_is_what_leaves_the_ground_once_and_rises(library):
    fly = {}
    for name in ("jump", "leap", "roll", "walk", "run", "fly", "fall", "punch", "idle", "cheer"):
        fly[name] = piece(library, name).airborne is not None
    assert [name for name, flies in fly.items() if flies] == ["jump", "leap"]


@pytest.mark.parametrize("lasting_s, rise_m", [(0.9, 0.0), (1.5, 0.5), (2.5, 3.0)])
@pytest.mark.parametrize("name", ["jump", "leap"])
def test_a_flight_is_a_parabola_and_joins_the_clip_without_a_jump(library, name, lasting_s, rise_m):
    studied = piece(library, name)
    time_s = np.linspace(0.0, 6.0, 6001)
    s = np.clip((time_s - 1.0) / lasting_s, 0.0, 1.0)
    height = Height(time_s, 4.0 * rise_m * s * (1.0 - s))
    move = move_of(studied, 1.0, 1.0 + lasting_s)
    (flight,) = flights([move], height)
    body_m, feet_m = flight.raised_m(time_s)
    own_m = np.interp(move.frame_at(time_s), np.arange(len(studied.clip)), flight.body_m)
    flies = (time_s > flight.take_off_s) & (time_s < flight.landing_s)
    bend = np.diff((own_m + body_m)[flies], 2) / 1e-6
    duration_s = flight.landing_s - flight.take_off_s
    assert bend == pytest.approx(-8.0 * flight.apex_m / duration_s**2, rel=1e-3)
    assert (feet_m[~flies] == 0.0).all()
    assert (body_m[time_s < 1.0] == 0.0).all()
    for at_s in (flight.take_off_s, flight.landing_s):
        near = np.abs(time_s - at_s) < 2.5e-3
        assert np.abs(np.diff(body_m[near])).max() < 0.015
        # The clip's own speed is read between its frames: what it gains in one may be left over.
        around = np.interp(
            [at_s - 0.03, at_s - 0.01, at_s + 0.01, at_s + 0.03], time_s, own_m + body_m
        )
        before, after = (around[1] - around[0]) / 0.02, (around[3] - around[2]) / 0.02
        assert abs(after - before) < 0.04 * 8.0 * flight.apex_m / duration_s**2 + 1.0


@pytest.mark.parametrize(
    ("name", "lasting_s", "rise_m"),
    [("jump", 2.0, 0.01), ("jump", 2.0, 0.03), ("jump", 2.5, 0.02), ("leap", 2.5, 0.02)],
)
def test_a_jump_is_as_high_as_drawn_and_its_feet_fly_as_long_as_its_body(
    library, name, lasting_s, rise_m
):
    recording, score = hop(name, lasting_s, rise_m)
    (actor,) = animate(score, recording, library, rate_hz=RATE_HZ, timing="drawn").actors
    skeleton, clip = library.character.skeleton, library.clip(name)
    legs, hips = legs_of(skeleton, feet_of(clip)), skeleton.index("hips")
    stage = scene_scale(recording, library.character.height_m, score.figure_height_m)
    flown = piece(library, name).airborne
    first, last, body_m = flown.first, flown.last, flown.body_m
    flown_s = lasting_s * (last - first) / (len(clip) - 1)  # the clip lasts as long as the phrase
    own_m = (body_m - np.interp(np.arange(len(clip)), [first, last], body_m[[first, last]])).max()
    apex_m = apex_for(stage.scale * rise_m, flown_s, own_m)
    assert LOWEST * own_m < apex_m < HIGHEST * own_m

    local = actor.poses
    soles = [sole_height(leg, *world_of(skeleton, leg.foot, *local)) for leg in legs]
    airborne = np.flatnonzero(np.min(soles, axis=0) > 1e-3)
    assert np.min(soles) > -1e-3
    take_off_s = 1.0 + lasting_s * first / (len(clip) - 1)
    inside = airborne / RATE_HZ
    assert inside[0] == pytest.approx(take_off_s, abs=0.03)
    assert inside[-1] == pytest.approx(take_off_s + flown_s, abs=0.03)
    assert (np.diff(airborne) == 1).all()
    bend = np.diff(world_of(skeleton, hips, *local)[1][airborne[2:-2], 1], 2) * RATE_HZ**2
    assert bend == pytest.approx(-8.0 * apex_m / flown_s**2, rel=0.02)


def test_who_falls_from_a_height_falls_along_a_parabola_too(skeleton):
    """From 1 m up, at rest, in the 0.45 s that it takes; the clip's own fall is a straight line."""
    n, first, last = 61, 15, 42
    phase = np.clip((np.arange(n) - first) / (last - first), 0.0, 1.0)
    translation = np.tile(skeleton.rest_translation_m, (n, 1, 1))
    translation[:, 1, 1] += 1.0 - phase + 0.2 * phase * (1.0 - phase)
    touches = (np.arange(n) <= first) | (np.arange(n) >= last)
    clip = Clip(
        name="drop",
        skeleton=skeleton,
        rate_hz=60.0,
        rotation_xyzw=np.tile(skeleton.rest_rotation_xyzw, (n, 1, 1)),
        translation_m=translation,
        stage_end_frames=np.array([0, first, last, n - 1, n - 1]),
        contact_joints=("left_foot", "right_foot"),
        contacts=np.stack([touches, touches], axis=-1),
    )
    studied = piece_of(clip, travels=False, legs=legs_of(skeleton, feet_of(clip)))
    flown = studied.airborne
    assert (flown.first, flown.last) == (first, last)
    time_s = np.linspace(0.0, 1.0, 1001)
    (flight,) = flights([move_of(studied, 0.0, 1.0)], Height(time_s, 0.0 * time_s))
    raised_m, _ = flight.raised_m(time_s)
    falls = (time_s > first / 60.0) & (time_s < last / 60.0)
    height_m = np.interp(60.0 * time_s, np.arange(n), flown.body_m) + raised_m
    apex_m = apex_for(0.0, (last - first) / 60.0, 0.05)
    s = (time_s - first / 60.0) / ((last - first) / 60.0)
    expected_m = skeleton.rest_translation_m[1, 1] + 1.0 - s + 4.0 * apex_m * s * (1.0 - s)
    assert height_m[falls] == pytest.approx(expected_m[falls], abs=2e-3)
