from __future__ import annotations

import numpy as np
import pytest

from smd.errors import PatternError
from smd.recognition.token_costs import TokenCosts, codes_of, graded_costs, unit_costs
from smd.recognition.tokenizer import DIRECTIONS
from smd.recognition.tokens import Token

ALL = [Token(t, r) for t in DIRECTIONS for r in DIRECTIONS]


def price(a, b, costs=None):
    return float((costs or graded_costs()).between([Token.parse(a)], [Token.parse(b)])[0, 0])


def test_every_token_has_a_code_of_its_own():
    assert codes_of(ALL).tolist() == list(range(729))


def test_unit_costs_tell_equal_from_different():
    assert price("T_Z", "T_Z", unit_costs()) == 0.0
    assert price("T_Z", "T_X_Z", unit_costs()) == price("T_Z", "R_Y", unit_costs()) == 1.0


def test_nearer_directions_cost_less():
    near, further, across, against = (
        price("T_Z", other) for other in ("T_X_Z", "T_X_Y_Z", "T_X", "T_N_Z")
    )
    assert (near, across, against) == (0.25, 0.5, 1.0)  # angles as shares of half a turn
    assert near < further < across
    assert price("R_Y", "R_Y_Z") == near
    quarter = graded_costs(far_rad=np.pi / 2.0)
    assert price("T_Z", "T_X", quarter) == price("T_Z", "T_N_Z", quarter) == 1.0


def test_moving_or_not_is_between_near_and_far():
    assert price("T_Z", "T_Z/R_Y") == price("STILL", "T_Z") == price("R_Y", "STILL") == 0.5
    assert price("T_Z", "R_Y") == price("STILL", "T_Z/R_Y") == 1.0


def test_translation_and_rotation_add_up():
    assert price("T_Z/R_Y", "T_X_Z/R_X_Y") == 2.0 * price("T_Z", "T_X_Z")
    assert price("T_Z/R_Y", "T_N_Z/R_N_Y") == 1.0


def test_a_half_turn_of_the_world_changes_no_cost():
    turned = [
        Token((-t[0], t[1], -t[2]), (-r[0], r[1], -r[2])) for t in DIRECTIONS for r in DIRECTIONS
    ]
    costs = graded_costs()
    assert np.array_equal(costs.between(ALL, ALL), costs.between(turned, turned))


@pytest.mark.parametrize("wrong", [np.zeros((729, 729)), 2.0 - 2.0 * np.eye(729), np.eye(729)])
def test_costs_that_are_none_are_refused(wrong):
    with pytest.raises(PatternError, match="expected a symmetric matrix"):
        TokenCosts("wrong", wrong)
