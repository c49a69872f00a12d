from __future__ import annotations

import pytest

from actions_library.authoring.keys import (
    PARTS,
    ArmKey,
    Gaze,
    Key,
    Place,
    Turn,
    both_sides,
    carried,
    mirrored,
    part_curve,
)

POSE = Key(
    0.25,
    place=Place(left=0.1, up=-0.2, ahead=0.3),
    hips=Turn(yaw=10.0, lean=20.0, tilt=30.0),
    head=Turn(yaw=-5.0, lean=1.0, tilt=2.0),
    left_arm=ArmKey(bend=40.0),
)


def test_the_mirror_s_mirror_is_the_key():
    assert mirrored(mirrored(POSE)) == POSE


def test_a_mirrored_key_leans_alike_and_turns_and_tilts_the_other_way():
    other = mirrored(POSE)
    assert other.hips == Turn(yaw=-10.0, lean=20.0, tilt=-30.0)
    assert other.place == Place(left=-0.1, up=-0.2, ahead=0.3)
    assert (other.right_arm, other.left_arm) == (POSE.left_arm, None)


def test_both_sides_repeats_the_half_as_its_mirror_half_a_cycle_later():
    first, second = both_sides([POSE])
    assert first == POSE
    assert second.at == 0.75
    assert mirrored(second).hips == POSE.hips


def test_four_quarter_turns_bring_a_key_back_round():
    key = POSE
    for _ in range(4):
        key = carried(key, yaw=90.0)
    assert (key.place.left, key.place.ahead) == pytest.approx((0.1, 0.3))
    assert key.hips.yaw == 370.0


def test_a_quarter_turn_to_the_left_takes_ahead_to_the_left():
    key = carried(Key(0.0, place=Place(ahead=1.0)), yaw=90.0)
    assert (key.place.left, key.place.ahead) == pytest.approx((1.0, 0.0))


def test_a_part_without_keys_has_no_curve():
    assert part_curve([POSE], "chest", 10, 60.0, cyclic=False) is None


def test_a_part_runs_through_its_own_keys_only():
    keys = [Key(0.0, place=Place(up=1.0)), POSE, Key(1.0, place=Place(up=3.0))]
    curve = part_curve(keys, "hips", 61, 60.0, cyclic=False)
    assert (curve == [10.0, 20.0, 30.0]).all()
    assert len(PARTS) == 11


def test_eyes_look_the_other_way_in_a_mirrored_key():
    assert mirrored(Key(0.0, gaze=Gaze(left=12.0, up=3.0))).gaze == Gaze(left=-12.0, up=3.0)
    assert mirrored(Key(0.0)).gaze is None
