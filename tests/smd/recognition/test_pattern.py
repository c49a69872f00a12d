from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smd.errors import PatternError
from smd.recognition.pattern import MAX_NESTING, Choice, Pattern, Repeat, Sequence, merged
from smd.recognition.tokens import Token
from tests.naive.pattern_language import language
from tests.naive.patterns_at_random import ABC, patterns

Z, YZ, RY = ABC


def words_of(text, repeats=1):
    return [" ".join(map(str, word)) for word in Pattern.parse(text).words(repeats)]


@settings(deadline=None)
@given(patterns())
def test_what_is_printed_reads_back_as_the_same_pattern(pattern):
    assert Pattern.parse(str(pattern)) == pattern


@settings(deadline=None)
@given(patterns())
def test_printing_again_changes_nothing(pattern):
    assert str(Pattern.parse(str(pattern))) == str(pattern)


@settings(deadline=None)
@given(patterns(most=5))
def test_expansion_is_the_language_but_for_repeated_groups(pattern):
    expanded = set(pattern.words(repeats=4))
    longest = 4
    assert expanded <= language(pattern, max(map(len, expanded)))
    # a word of four tokens needs no fifth round of anything, as each round adds or is merged
    assert language(pattern, longest) == {w for w in expanded if len(w) <= longest}


@settings(deadline=None)
@given(patterns(), patterns())
def test_equal_patterns_hash_alike(a, b):
    assert (a == b) == (str(a) == str(b))
    assert a != b or hash(a) == hash(b)


@settings(deadline=None)
@given(st.text(alphabet="TRXYZN_/ ()|*+S", max_size=30))
def test_any_text_is_read_or_refused_in_one_line(text):
    try:
        pattern = Pattern.parse(text)
    except PatternError as error:
        assert "\n" not in str(error)
        assert error.position is None or 0 <= error.position <= len(text)
    else:
        assert Pattern.parse(str(pattern)) == pattern


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("T_Z", ["T_Z"]),
        ("T_Z+ T_Z+", ["T_Z"]),
        ("T_Z* R_Y", ["R_Y", "T_Z R_Y"]),
        ("T_Z|R_Y", ["R_Y", "T_Z"]),
        ("T_Z (T_Y|T_Y_Z)* T_N_Y", ["T_Z T_N_Y", "T_Z T_Y T_N_Y", "T_Z T_Y_Z T_N_Y"]),
        ("(T_Z R_Y)+", ["T_Z R_Y"]),
    ],
)
def test_expansion_drops_plus_and_follows_star_and_bar(text, words):
    assert words_of(text) == words


def test_a_repeated_group_is_expanded_as_often_as_asked():
    assert words_of("(T_Z R_Y)+", repeats=2) == ["T_Z R_Y", "T_Z R_Y T_Z R_Y"]
    assert words_of("(T_Z R_Y T_Z)+", repeats=2) == ["T_Z R_Y T_Z", "T_Z R_Y T_Z R_Y T_Z"]


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("  T_Z+\n(T_Y|T_Y_Z)*\tT_N_Y+ ", "T_Z+ (T_Y|T_Y_Z)* T_N_Y+"),
        ("((T_Z))", "T_Z"),
        ("(T_Z T_Y) R_Y", "T_Z T_Y R_Y"),
        ("(T_Z|T_Y)|R_Y", "T_Z|T_Y|R_Y"),
        ("T_Z|T_Z", "T_Z"),
        ("(T_Z+)+", "T_Z+"),
        ("T_Y (T_Z+)*", "T_Y T_Z*"),
        ("T_Y T_Z+*", "T_Y T_Z*"),
        ("(T_Z R_Y)+ R_X|STILL", "(T_Z R_Y)+ R_X|STILL"),
        ("T_Z(R_Y)T_Z", "T_Z R_Y T_Z"),
    ],
)
def test_one_form_is_printed_for_what_means_the_same(text, printed):
    assert str(Pattern.parse(text)) == printed


@pytest.mark.parametrize(
    ("text", "position", "message"),
    [
        ("", 0, "expected a token or '(' at character 1, found the end"),
        ("T_Z |", 5, "expected a token or '(' at character 6, found the end"),
        ("T_Z (R_Y", 8, "expected ')' for the '(' at character 5 at character 9, found the end"),
        ("T_Z) R_Y", 3, "expected a token, '(', '|', '+' or '*' at character 4, found ')'"),
        ("+ T_Z", 0, "expected a token or '(' at character 1, found '+'"),
        ("T_Z ()", 5, "expected a token or '(' at character 6, found ')'"),
        ("T_Z T_W", 4, "expected a token such as T_Z, R_N_Y, T_Y_Z/R_X or STILL at character 5"),
        ("T_Z ? R_Y", 4, "expected a token such as"),
        ("T_Z_Y", 0, "expected a token such as"),
        ("(" * (MAX_NESTING + 1) + "T_Z" + ")" * (MAX_NESTING + 1), MAX_NESTING, "nested groups"),
    ],
)
def test_what_does_not_parse_is_refused_with_its_place(text, position, message):
    with pytest.raises(PatternError) as caught:
        Pattern.parse(text)
    assert message in str(caught.value)
    assert caught.value.position == position


@pytest.mark.parametrize("text", ["T_Z*", "T_Z* R_Y*", "T_Z|R_Y*", "(T_Z*)+", "(T_Z|R_Y)*"])
def test_what_nothing_at_all_would_match_is_refused(text):
    with pytest.raises(PatternError, match="nothing at all would match"):
        Pattern.parse(text)


def test_deep_nesting_is_read_up_to_the_limit():
    text = "(" * MAX_NESTING + "T_Z" + ")" * MAX_NESTING
    assert Pattern.parse(text) == Pattern(Z)
    assert str(Pattern.parse("T_Z" + "+" * 10_000)) == "T_Z+"


def test_groups_without_parts_are_refused():
    for node in (Sequence(()), Choice(())):
        with pytest.raises(PatternError):
            Pattern(node)


def test_tokens_are_listed_once():
    assert Pattern(Sequence((Z, RY, Repeat(Z, True)))).tokens() == tuple(sorted((Z, RY)))


def test_merging_leaves_no_equal_neighbours():
    assert merged((Z, Z, RY, RY, Z)) == (Z, RY, Z)
    assert merged(()) == ()
    assert merged((Token.parse("T_Y"),)) == (Token.parse("T_Y"),)
