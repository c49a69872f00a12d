"""Whoever brings poses is told in one line what does not fit."""

from __future__ import annotations

import numpy as np
import pytest

from smd.acting.act import grounded_actor
from smd.acting.grounding import level
from smd.acting.legs import legs_of
from smd.acting.move import Footwork
from smd.acting.performance import Actor, Performance
from smd.character.poses import Poses
from smd.errors import TransferError
from tests.naive.puppet import puppet, wave

RATE_HZ, COUNT = 30.0, 12
CHARACTER = puppet()
SKELETON = CHARACTER.skeleton
LEGS = legs_of(SKELETON, [SKELETON.index(f"{side}_foot") for side in ("left", "right")])
ROTATION, TRANSLATION = wave(COUNT, RATE_HZ)
STANDS, PIVOT_RAD = np.ones((COUNT, 2), dtype=bool), np.zeros((COUNT, 2))


def brought(
    rotation=ROTATION, translation=TRANSLATION, stands=STANDS, pivot_rad=PIVOT_RAD, **more
) -> Actor:
    poses, footwork = Poses(rotation, translation), Footwork(stands, pivot_rad)
    return grounded_actor("a", CHARACTER, poses, footwork, LEGS, **{"rate_hz": RATE_HZ} | more)


def danced(rotation=ROTATION, translation=TRANSLATION) -> Actor:
    return Actor("a", CHARACTER, Poses(rotation, translation))


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"rate_hz": 0.0}, "rate_hz: expected a positive number, got 0.0"),
        ({"rate_hz": float("nan")}, "rate_hz: expected a positive number, got nan"),
        ({"rotation": ROTATION[:, :5]}, r"rotation_xyzw: expected shape \(any, 55, 4\)"),
        ({"rotation": ROTATION[:0], "translation": TRANSLATION[:0]}, "at least one frame"),
        ({"rotation": 2.0 * ROTATION}, "rotation_xyzw: expected unit length"),
        ({"translation": TRANSLATION[:5]}, r"translation_m: expected shape \(12, 55, 3\)"),
        ({"stands": STANDS[:5]}, r"stands: expected shape \(12, 2\), got \(5, 2\)"),
        ({"stands": STANDS[:, :1]}, r"stands: expected shape \(12, 2\), got \(12, 1\)"),
        ({"pivot_rad": np.full((12, 2), np.nan)}, "pivot_rad: expected finite numbers"),
        ({"rise": level(5)}, "rise: expected 12 frames, as poses have, got 5"),
    ],
)
def test_what_does_not_fit_is_said(wrong, said):
    with pytest.raises(TransferError, match=said):
        brought(**wrong)


def test_lists_are_as_good_as_arrays():
    of_lists = brought(stands=STANDS.tolist(), pivot_rad=PIVOT_RAD.tolist())
    np.testing.assert_array_equal(of_lists.poses.rotation_xyzw, brought().poses.rotation_xyzw)


@pytest.mark.parametrize(
    ("rotation", "said"), [(ROTATION[:0], "at least one frame"), (0.0 * ROTATION, "unit length")]
)
def test_an_actor_is_somebody_who_is_posed(rotation, said):
    with pytest.raises(TransferError, match=said):
        danced(rotation, TRANSLATION[: len(rotation)])


def test_an_actor_turns_the_shorter_way_whatever_signs_its_quaternions_had():
    sign = np.where(np.arange(COUNT) % 2, 1.0, -1.0)[:, None, None]
    turned = danced(ROTATION * sign).poses.rotation_xyzw
    assert (np.sum(turned[1:] * turned[:-1], axis=-1) > 0.0).all()
    with pytest.raises(ValueError, match="read-only"):
        turned[0] = 0.0


def test_a_performance_begins_at_some_time():
    with pytest.raises(TransferError, match="start_s: expected a finite number, got nan"):
        Performance(RATE_HZ, float("nan"), (danced(),))


def test_actors_may_come_one_by_one():
    assert len(Performance(RATE_HZ, 0.0, (each for each in [danced()])).actors) == 1
