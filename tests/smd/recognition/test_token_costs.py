from __future__ import annotations

import numpy as np
import pytest

from smd.errors import PatternError
from smd.recognition.alphabet import BINS, DIRECTIONS
from smd.recognition.token_costs import TokenCosts, graded_costs, unit_costs
from smd.recognition.tokens import Token, bins_of, bins_of_codes, code_of_bins, codes_of

ALL = [Token(t, r) for t in DIRECTIONS for r in DIRECTIONS]


def price(a, b, costs=None):
    return float((costs or graded_costs()).between([Token.parse(a)], [Token.parse(b)])[0, 0])


def test_every_token_has_a_code_of_its_own():
    assert codes_of(ALL).tolist() == list(range(BINS**2))
    assert np.array_equal(bins_of_codes(codes_of(ALL)), bins_of(ALL))
    assert np.array_equal(code_of_bins(*bins_of(ALL)), codes_of(ALL))


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


def test_two_tables_say_what_one_of_all_pairs_would():
    rng = np.random.default_rng(4)
    parts = np.tril(rng.uniform(0.01, 1.0, (2, BINS, BINS)), -1)
    translation, rotation = parts + parts.transpose(0, 2, 1)
    found = TokenCosts("random", translation, rotation).between(ALL, ALL)
    every = translation[:, None, :, None] + rotation[None, :, None, :]
    exact = np.minimum(every.reshape(BINS**2, BINS**2), 1.0)
    assert np.array_equal(found * 64.0, np.round(found * 64.0))
    assert ((found >= exact - 1e-9) & (found < exact + 1.0 / 64.0)).all()
    assert np.array_equal(found, found.T)


@pytest.mark.parametrize("part", ["translation", "rotation"])
@pytest.mark.parametrize("wrong", [np.zeros((BINS, BINS)), 2.0 - 2.0 * np.eye(BINS), np.eye(BINS)])
def test_costs_that_are_none_are_refused(part, wrong):
    right = {"translation": unit_costs().translation, "rotation": unit_costs().rotation}
    with pytest.raises(PatternError, match=f"{part}: expected a symmetric matrix"):
        TokenCosts("wrong", **{**right, part: wrong})
