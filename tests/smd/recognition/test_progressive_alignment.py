from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smd.recognition.alphabet import DIRECTIONS
from smd.recognition.progressive_alignment import (
    WeightedToken,
    progressively_aligned,
    token_distance,
)
from smd.recognition.tokens import STILL, Token

TOKENS = tuple(map(Token.parse, ("T_Z", "T_Y_Z", "T_Y", "R_Y", "T_Z/R_Y", "STILL")))
strokes = st.builds(WeightedToken, st.sampled_from(TOKENS), st.floats(0.02, 1.0))
sequences = st.lists(st.lists(strokes, min_size=1, max_size=7), min_size=1, max_size=5)


def of(text):
    return [WeightedToken(Token.parse(name), 1.0) for name in text.split()]


def names(column):
    return [str(stroke.token) if stroke else "-" for stroke in column.entries]


@settings(max_examples=200, deadline=None)
@given(sequences)
def test_every_sequence_reads_through_the_places_from_left_to_right(given):
    columns = progressively_aligned(given)
    for i, sequence in enumerate(given):
        assert [column.entries[i] for column in columns if column.entries[i]] == sequence
    assert all(any(column.entries) for column in columns)


@settings(max_examples=100, deadline=None)
@given(st.lists(strokes, min_size=1, max_size=7), st.integers(1, 4))
def test_equal_sequences_share_every_place(sequence, count):
    columns = progressively_aligned([sequence] * count)
    assert [column.entries for column in columns] == [(stroke,) * count for stroke in sequence]


def test_one_token_too_many_shifts_nothing():
    columns = progressively_aligned([of("T_Z T_N_Z T_Y"), of("T_X T_Z T_N_Z T_Y"), of("T_Z T_Y")])
    assert [names(column) for column in columns] == [
        ["-", "T_X", "-"],
        ["T_Z", "T_Z", "T_Z"],
        ["T_N_Z", "T_N_Z", "-"],
        ["T_Y", "T_Y", "T_Y"],
    ]


def test_neighbouring_directions_share_a_place_and_opposite_ones_do_not():
    near = progressively_aligned([of("T_Z T_N_Y"), of("T_Y_Z T_N_Y")])
    assert [names(column) for column in near] == [["T_Z", "T_Y_Z"], ["T_N_Y", "T_N_Y"]]
    far = progressively_aligned([of("T_Z"), of("T_N_Z")])
    assert all(None in column.entries for column in far)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.lists(strokes, min_size=1, max_size=5), min_size=2, max_size=2))
def test_tokens_that_are_unlike_never_share_a_place(pair):
    for column in progressively_aligned(pair):
        for a, b in combinations((stroke.token for stroke in column.entries if stroke), 2):
            assert token_distance(a, b) < 1.0


def test_the_distance_of_tokens_is_a_right_angle_at_most():
    rng = np.random.default_rng(0)
    for _ in range(300):
        a, b = (Token(*(DIRECTIONS[i] for i in rng.integers(0, 27, 2))) for _ in range(2))
        assert 0.0 <= token_distance(a, b) <= 1.0
        assert token_distance(a, b) == token_distance(b, a)
        assert (token_distance(a, b) == 0.0) == (a == b)


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ("T_Z", "T_Y_Z", 0.5),
        ("T_Z", "T_Y", 1.0),
        ("T_Z", "T_N_Z", 1.0),
        ("T_Z", "R_Z", 1.0),
        ("T_Z", "T_Z/R_Y", 0.5),
        ("T_Z/R_Y", "T_Y_Z/R_Y", 0.25),
        ("T_Z", "STILL", 1.0),
    ],
)
def test_known_distances(a, b, expected):
    assert token_distance(Token.parse(a), Token.parse(b)) == pytest.approx(expected)
    assert token_distance(STILL, STILL) == 0.0
