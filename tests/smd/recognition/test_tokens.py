from __future__ import annotations

from itertools import product

import pytest

from smd.errors import PatternError
from smd.recognition.tokens import STILL, Token

DIRECTIONS = list(product((-1, 0, 1), repeat=3))


def test_every_token_is_read_back_from_its_name():
    names = set()
    for translation, rotation in product(DIRECTIONS, DIRECTIONS):
        token = Token(translation, rotation)
        assert Token.parse(str(token)) == token
        names.add(str(token))
    assert len(names) == 27 * 27


@pytest.mark.parametrize(
    ("name", "translation", "rotation"),
    [
        ("STILL", (0, 0, 0), (0, 0, 0)),
        ("T_Z", (0, 0, 1), (0, 0, 0)),
        ("T_N_X", (-1, 0, 0), (0, 0, 0)),
        ("T_Y_Z", (0, 1, 1), (0, 0, 0)),
        ("R_N_Y", (0, 0, 0), (0, -1, 0)),
        ("T_X_N_Y_Z/R_N_X_Z", (1, -1, 1), (-1, 0, 1)),
    ],
)
def test_names_are_those_of_the_paper(name, translation, rotation):
    assert Token.parse(name) == Token(translation, rotation)


def test_still_is_the_token_without_direction():
    assert str(STILL) == "STILL"


@pytest.mark.parametrize(
    "name", ["", "T", "T_", "T_Z_Y", "T_Z_Z", "R_Y/T_Z", "t_z", "T_Z/", " T_Z"]
)
def test_what_is_no_name_is_refused(name):
    with pytest.raises(PatternError, match="expected a token"):
        Token.parse(name)
