"""Allotment: the least sum is found, and what must hold holds whatever is wished."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from smd.transfer.allotment import DRAWN_WEIGHT, Wish, allotted
from tests.naive.allotment import least_moments

MIXED = 2e-3
"""Most of the way back to the drawn times: a thousandth is gone, so that nothing lasts no time."""

FIRM_S = 1e-3
"""Time that phrases may overlap in the sum, which is then cut: their order has a large weight."""


def moments_of(share):
    every = (share.start_s, share.strike_s, share.end_s)
    return [time_s for time_s in every if time_s is not None]


@st.composite
def takes(
    draw: st.DrawFn, longest_s: float = 6.0, shortest_s: float = 0.02, most: int = 6
) -> tuple[list[Wish], float]:
    """Wishes of some phrases, with and without pauses between them, and the take's end."""
    now_s, wishes = 0.0, []
    for _ in range(draw(st.integers(1, most))):
        now_s += draw(st.sampled_from([0.0, 0.01, 0.1, 0.4, 1.0, 3.0]))
        lasting_s = draw(st.floats(0.05, 3.0))
        before_s = draw(st.floats(shortest_s, longest_s))
        if draw(st.booleans()):
            wish = Wish(now_s, now_s + lasting_s, before_s)
        else:
            wish = Wish(
                now_s,
                now_s + lasting_s,
                before_s,
                draw(st.just(0.0) | st.floats(shortest_s, longest_s)),
                draw(st.just(0.0) | st.floats(shortest_s, longest_s)),
                now_s + lasting_s * draw(st.floats(0.05, 0.95)),
            )
        wishes.append(wish)
        now_s += lasting_s
    return wishes, now_s + draw(st.sampled_from([0.0, 0.05, 0.5, 2.0]))


def drawn_moments(wish):
    return [time_s for time_s in (wish.start_s, wish.strike_s, wish.end_s) if time_s is not None]


@pytest.mark.parametrize("seed", range(20))
def test_the_sum_is_as_small_as_a_general_solver_makes_it(seed):
    rng = np.random.default_rng(seed)
    now_s, wishes = 0.0, []
    for _ in range(rng.integers(1, 6)):
        now_s += rng.choice([0.0, 0.1, 0.4, 1.0])
        wish = Wish(now_s, now_s + rng.uniform(0.1, 2.0), rng.uniform(0.05, 4.0))
        now_s = wish.end_s
        if rng.random() < 0.6:
            later_s = rng.choice([0.0, 1.0], 2) * rng.uniform(0.05, 2.0, 2)
            struck_s = wish.start_s + rng.uniform(0.1, 0.9) * (now_s - wish.start_s)
            wish = replace(wish, after_s=later_s[0], return_s=later_s[1], strike_s=struck_s)
        wishes.append(wish)
    end_s = now_s + rng.choice([0.0, 0.5])
    expected = np.concatenate(least_moments(wishes, 0.0, end_s))
    found = np.concatenate([moments_of(share) for share in allotted(wishes, 0.0, end_s)])
    drawn = np.concatenate([drawn_moments(wish) for wish in wishes])
    assert np.abs(expected - drawn).max() > 0.01
    within = np.maximum.accumulate(np.clip(expected, 0.0, end_s))
    assert np.abs(found - within).max() < 1e-4 + MIXED * np.abs(drawn - within).max()


@given(takes(longest_s=600.0, shortest_s=0.01, most=12))
def test_order_and_ends_of_the_take_hold_and_every_phrase_lasts(take):
    wishes, end_s = take
    shares = allotted(wishes, 0.0, end_s)
    assert len(shares) == len(wishes)
    moments = [time_s for share in shares for time_s in moments_of(share)]
    assert np.isfinite(moments).all()
    assert moments[0] >= 0.0 and moments[-1] <= end_s
    assert (np.diff(moments) >= 0.0).all()
    for share in shares:
        assert share.end_s > share.start_s
    for share, wish in zip(shares, wishes, strict=True):
        assert (share.strike_s is None) == (wish.strike_s is None)


@given(takes())
def test_where_every_phrase_has_the_time_that_it_needs_nothing_moves(take):
    wishes, end_s = take
    starts_s = [*(wish.start_s for wish in wishes[1:]), end_s]
    # A part that is shorter than the least time asks for that, whatever is wished.
    assume(all(min(np.diff(drawn_moments(wish))) > 0.05 for wish in wishes))
    modest = []
    for wish, next_s in zip(wishes, starts_s, strict=True):
        struck_s = wish.end_s if wish.strike_s is None else wish.strike_s
        calm = replace(wish, before_s=0.99 * (struck_s - wish.start_s))
        if wish.strike_s is not None:
            calm = replace(
                calm,
                after_s=0.99 * (wish.end_s - struck_s),
                return_s=0.99 * (next_s - wish.end_s),
            )
        modest.append(calm)
    found = [moments_of(share) for share in allotted(modest, 0.0, end_s)]
    expected = [drawn_moments(wish) for wish in modest]
    assert np.concatenate(found) == pytest.approx(np.concatenate(expected), abs=1e-9)


@pytest.mark.parametrize("needed_s", [1.1, 1.3, 1.5])
def test_alone_a_phrase_takes_equally_from_both_pauses_what_it_lacks_but_for_its_drawn_ends(
    needed_s,
):
    """Closed form: x/2 to both sides; (x - needed)² / needed² + 2 w (x - 1)² / 4 is least."""
    (share,) = allotted([Wish(4.0, 5.0, needed_s)], 0.0, 9.0)
    pull = 0.5 * DRAWN_WEIGHT * needed_s**2
    lasting_s = (needed_s + pull) / (1.0 + pull)
    assert share.end_s - share.start_s == pytest.approx(lasting_s, abs=MIXED * needed_s)
    assert share.start_s + share.end_s == pytest.approx(9.0, abs=1e-9)
    assert lasting_s > 0.98 * needed_s


def test_what_one_phrase_lacks_moves_nothing_that_is_not_beside_it():
    calm = [Wish(1.0, 2.0, 0.9), Wish(8.0, 9.0, 0.5, 0.3, 0.2, 8.6)]
    (first, short, last) = allotted([calm[0], Wish(4.0, 4.5, 1.2), calm[1]], 0.0, 10.0)
    assert short.end_s - short.start_s > 1.1
    assert moments_of(first) == pytest.approx([1.0, 2.0], abs=1e-9)
    assert moments_of(last) == pytest.approx([8.0, 8.6, 9.0], abs=1e-9)


@pytest.mark.parametrize("needed_s", [0.3, 0.6, 1.0, 1.4])
def test_a_strike_keeps_within_a_tenth_of_a_second_where_there_is_a_pause_before_it(needed_s):
    (share,) = allotted([Wish(3.0, 3.6, needed_s, 0.4, 0.3, 3.2)], 0.0, 6.0)
    assert abs(share.strike_s - 3.2) <= 0.1
    assert share.strike_s - share.start_s > 0.9 * needed_s


@given(takes(longest_s=6.0, shortest_s=0.3, most=8))
def test_no_strike_is_moved_by_more_than_two_tenths_of_a_second(take):
    wishes, end_s = take
    for share, wish in zip(allotted(wishes, 0.0, end_s), wishes, strict=True):
        if wish.strike_s is not None:
            assert abs(share.strike_s - wish.strike_s) < 0.21


def apart_from_reversed_s(wishes, end_s):
    """How far shares are at most from those of the wishes played backwards."""
    forth = [replace(w, return_s=0.0) for w in wishes]
    back = [
        Wish(end_s - w.end_s, end_s - w.start_s, w.before_s)
        if w.strike_s is None
        else Wish(
            end_s - w.end_s, end_s - w.start_s, w.after_s, w.before_s, 0.0, end_s - w.strike_s
        )
        for w in forth
    ]
    found = [moments_of(share) for share in allotted(forth, 0.0, end_s)]
    mirrored = [moments_of(share) for share in allotted(back[::-1], 0.0, end_s)][::-1]
    expected = np.concatenate([end_s - np.array(moments)[::-1] for moments in mirrored])
    return np.abs(np.concatenate(found) - expected).max()


@given(takes())
def test_time_reversed_wishes_get_time_reversed_shares(take):
    assert apart_from_reversed_s(*take) < FIRM_S


@pytest.mark.parametrize("seed", range(4))
def test_in_a_long_take_the_least_sum_is_found_and_not_only_neared(seed):
    """From either end, the same."""
    rng = np.random.default_rng(seed)
    now_s, wishes = 0.0, []
    for _ in range(75):
        now_s += rng.uniform(0.0, 1.2)
        lasting_s, more = rng.uniform(0.8, 3.0), rng.uniform(0.5, 2.5)
        whole = Wish(now_s, now_s + lasting_s, more * lasting_s)
        strikes = {
            "before_s": 0.6 * whole.before_s,
            "after_s": 0.4 * whole.before_s,
            "strike_s": now_s + 0.6 * lasting_s,
        }
        wishes.append(replace(whole, **strikes) if rng.random() < 0.6 else whole)
        now_s += lasting_s
    assert apart_from_reversed_s(wishes, now_s + 1.0) < 1e-5


@given(takes(), st.floats(-50.0, 500.0))
def test_a_later_take_is_shared_out_alike(take, later_s):
    wishes, end_s = take
    moved = [
        replace(
            w,
            start_s=w.start_s + later_s,
            end_s=w.end_s + later_s,
            strike_s=None if w.strike_s is None else w.strike_s + later_s,
        )
        for w in wishes
    ]
    found = [moments_of(share) for share in allotted(wishes, 0.0, end_s)]
    other = [moments_of(share) for share in allotted(moved, later_s, later_s + end_s)]
    expected = np.concatenate(found) + later_s
    assert np.concatenate(other) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("strikes", [False, True])
@pytest.mark.parametrize("times", [2.0, 100.0])
def test_where_there_is_no_time_at_all_phrases_share_it_evenly(strikes, times):
    """Thirty phrases of a second, without a pause; each wishes for the same too much."""
    wishes = [
        Wish(k, k + 1.0, 0.5 * times, 0.5 * times, 0.0, k + 0.5)
        if strikes
        else Wish(k, k + 1.0, times)
        for k in map(float, range(30))
    ]
    shares = allotted(wishes, 0.0, 30.0)
    found = np.array([[share.start_s, share.end_s] for share in shares])
    expected = np.array([[wish.start_s, wish.end_s] for wish in wishes])
    assert found == pytest.approx(expected, abs=1e-3)


def test_a_phrase_beyond_the_take_ends_with_it_and_lasts():
    for last in (Wish(4.0, 5.04, 0.5), Wish(4.0, 5.04, 2.0, 0.5, 0.5, 4.8)):
        (share,) = allotted([last], 0.0, 5.0)
        assert share.end_s <= 5.0
        assert share.end_s - share.start_s > 0.5


def test_a_phrase_that_is_wholly_beyond_the_take_still_lasts():
    first, last = allotted([Wish(3.0, 5.01, 1.0), Wish(5.01, 5.04, 0.8)], 0.0, 5.0)
    assert first.end_s <= last.start_s < last.end_s <= 5.0


def test_who_is_pressed_from_both_sides_still_lasts():
    """What lacks a moment presses harder than what lacks ten seconds."""
    needed_s = (0.05, 10.0, 0.05)
    wishes = [Wish(5e-4 * k, 5e-4 * (k + 1), needed) for k, needed in enumerate(needed_s)]
    shares = allotted(wishes, 0.0, 1.5e-3)
    assert all(share.end_s > share.start_s for share in shares)
    assert shares[0].end_s <= shares[1].start_s and shares[1].end_s <= shares[2].start_s


def test_a_strike_at_once_that_needs_no_time_before_it_is_given_a_moment():
    (share,) = allotted([Wish(2.0, 3.0, 0.0, 0.5, 0.0, 2.0)], 0.0, 5.0)
    assert 0.0 < share.strike_s - share.start_s < 0.06
    assert moments_of(share) == pytest.approx([2.0, 2.0, 3.0], abs=0.06)


def test_nothing_wished_is_nothing_shared():
    assert allotted([], 0.0, 5.0) == []


@given(st.integers(2, 40), st.floats(0.5, 5.0))
def test_who_needs_more_gets_more(count, more):
    """Two phrases side by side, the same but for what they need."""
    wishes = [Wish(k, k + 1.0, 1.5) for k in map(float, range(count))]
    wishes[0] = replace(wishes[0], before_s=1.5 * (1.0 + more))
    shares = allotted(wishes, 0.0, float(count))
    lasting_s = [share.end_s - share.start_s for share in shares]
    assert lasting_s[0] > lasting_s[1] - 1e-6
    assert all(one.end_s <= other.start_s for one, other in pairwise(shares))
