"""A prop is held in a fist: it goes where the hand goes, and nothing else moves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import smd
from actions_library.library import Library
from smd.acting.grip import grip_of, with_props_held
from smd.acting.performance import Actor, HeldProp
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.doodle import Doodle
from smd.errors import TransferError
from smd.geometry.rotations import inverse, multiply, rotate
from tests.naive.puppet import performance, puppet

SKELETON = puppet().skeleton
FINGERS = [
    SKELETON.index(joint)
    for joint in SKELETON.joints
    if joint.startswith("right_")
    and any(name in joint for name in ("thumb", "index", "middle", "ring", "little"))
]
THUMB, KNUCKLES, TIP = (
    SKELETON.index(f"right_{name}")
    for name in ("thumb_metacarpal", "middle_proximal", "middle_distal")
)
HAND = SKELETON.index("right_hand")
STORY = Path(__file__).parents[3] / "recordings" / "postman.csv"


@pytest.fixture(scope="module")
def actor() -> Actor:
    """Somebody who waves, and was drawn."""
    one = performance(seconds=1.0, rate_hz=24.0).actors[0]
    time_s = np.array([0.0, 1.0])
    doodle = Doodle(time_s, np.zeros((2, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (2, 1)))
    return replace(one, doodles=one.doodles or (doodle,))


def test_the_prop_stays_in_the_hand(actor: Actor) -> None:
    (held,) = with_props_held([actor])
    assert held.held is not None
    world, place = forward_kinematics(SKELETON, *held.poses)
    in_hand_m = rotate(inverse(world[:, HAND]), held.held.position_m - place[:, HAND])
    turned = multiply(inverse(world[:, HAND]), held.held.orientation_xyzw)
    np.testing.assert_allclose(in_hand_m, in_hand_m[:1].repeat(len(in_hand_m), 0), atol=1e-12)
    np.testing.assert_allclose(np.abs(np.sum(turned * turned[:1], axis=-1)), 1.0, atol=1e-12)
    knuckles_m = np.linalg.norm(SKELETON.rest_translation_m[KNUCKLES])
    assert np.linalg.norm(in_hand_m[0]) < knuckles_m


def test_it_lies_across_the_palm_with_its_front_at_the_thumb() -> None:
    grip = grip_of(SKELETON)
    assert grip is not None
    world, place = forward_kinematics(
        SKELETON, SKELETON.rest_rotation_xyzw, SKELETON.rest_translation_m
    )
    turned = multiply(world[HAND], grip.orientation_xyzw)
    front, top = (
        rotate(turned, np.array([0.0, 0.0, 1.0])),
        rotate(turned, np.array([0.0, 1.0, 0.0])),
    )
    thumb, fingers = (place[joint] - place[HAND] for joint in (THUMB, KNUCKLES))
    assert front @ thumb > 0.0
    assert front @ fingers == pytest.approx(0.0, abs=1e-9)
    assert top @ fingers == pytest.approx(np.linalg.norm(fingers))
    # The palm of a hanging hand faces the body: the prop is on that side of the hand.
    at = rotate(world[HAND], grip.position_m)
    assert at[0] > (at @ top) * top[0] + 0.005


def test_fingers_close_as_in_the_fist_of_the_punch(library: Library) -> None:
    clip = library.clip("punch")
    skeleton = library.character.skeleton
    fist = clip.rotation_xyzw[clip.stage_end_frames[2]].copy()
    grip = grip_of(skeleton)
    assert grip is not None
    closed = fist.copy()
    for joint, turned in grip.closed_xyzw.items():
        closed[joint] = turned
    tips = []
    for pose in (fist, closed):
        world, _ = forward_kinematics(skeleton, pose, skeleton.rest_translation_m)
        bone = skeleton.rest_translation_m[TIP]
        tips.append(rotate(inverse(world[HAND]), rotate(world[TIP], bone)))
    along = skeleton.rest_translation_m[KNUCKLES]
    between = [
        np.degrees(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)))
        for a, b in ((tips[0], along), (tips[1], along), tips)
    ]
    assert min(between[:2]) > 80.0  # the last bones do not point along the hand
    assert between[2] < 60.0


def test_only_the_fingers_of_one_hand_move(actor: Actor) -> None:
    (held,) = with_props_held([actor])
    others = [joint for joint in range(len(SKELETON)) if joint not in FINGERS]
    np.testing.assert_allclose(
        held.poses.rotation_xyzw[:, others], actor.poses.rotation_xyzw[:, others], atol=1e-12
    )


def test_nothing_is_held_without_a_prop_or_a_hand(actor: Actor) -> None:
    undrawn = replace(actor, doodles=())
    assert with_props_held([undrawn])[0].held is None
    kept = [i for i in range(len(SKELETON)) if i not in FINGERS or i == KNUCKLES]
    mitten = replace(
        SKELETON,
        joints=tuple(SKELETON.joints[i] for i in kept),
        parents=np.array([kept.index(p) if (p := SKELETON.parents[i]) >= 0 else -1 for i in kept]),
        rest_rotation_xyzw=SKELETON.rest_rotation_xyzw[kept],
        rest_translation_m=SKELETON.rest_translation_m[kept],
        world_from_bind=SKELETON.world_from_bind[kept],
        roles=tuple(SKELETON.roles[i] for i in kept),
    )
    assert grip_of(mitten) is None


def test_who_cannot_hold_a_prop_is_named(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("smd.acting.grip.grip_of", lambda skeleton: None)
    recording = smd.read_recording(STORY)
    performance = smd.animate(smd.parse(recording, library), recording, library, hold=True)
    (line,) = [line for line in performance.warnings if "hold" in line]
    assert line.startswith("postman: its character has no hand with fingers and a thumb")
    assert "--hold" in line


def test_another_number_of_frames_is_refused(actor: Actor) -> None:
    held = HeldProp(np.zeros((3, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (3, 1)))
    with pytest.raises(TransferError, match=r"held: expected \d+ frames, as poses have, got 3"):
        replace(actor, held=held)


def test_a_story_is_played_with_props_in_hand(library: Library) -> None:
    recording = smd.read_recording(STORY)
    score = smd.parse(recording, library)
    free, held = (smd.animate(score, recording, library, hold=hold) for hold in (False, True))
    assert free.actors[0].held is None
    assert held.actors[0].held is not None
    assert held.warnings == free.warnings
    assert isinstance(held.actors[0].poses, Poses)
