"""An example of the performer's own counts for more than others', and only beside others'."""

from itertools import pairwise

import numpy as np
import pytest

from smd.errors import DoodleError
from smd.recognition.exemplar import (
    FARTHER,
    PRIOR_DISTANCES,
    PRIOR_SPREADS,
    STRANGERS,
    USUAL_DISTANCE,
    USUAL_SPREAD,
    Exemplar,
    exemplar_of,
)
from smd.recognition.traits import SAMPLES, Traits


def examples_at_random(count, seed=3):
    rng = np.random.default_rng(seed)
    return [
        Traits(
            tuple(
                np.cumsum(rng.normal(scale=0.1, size=(SAMPLES, d)), axis=0) for d in (12, 12, 6, 6)
            ),
            rng.normal(size=4),
        )
        for _ in range(count)
    ]


def same(a, b):
    names = ("scale", "centre", "spread", "central", "factor", "measures", "apart")
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names)


@pytest.mark.parametrize("count", [1, 5])
def test_whose_examples_are_does_not_matter_where_all_are_of_one_kind(count):
    examples = examples_at_random(count)
    others, own = exemplar_of(examples), exemplar_of(examples, own=True)
    assert same(others, own)
    assert (others.factor == 1.0).all()
    np.testing.assert_allclose(own.centre, np.mean([one.measures for one in examples], axis=0))


@pytest.mark.parametrize(("others", "own"), [(1, 1), (5, 1), (18, 1), (5, 3)])
def test_all_others_together_count_for_as_much_as_one_own_example(others, own):
    assert STRANGERS == 1.0
    examples = examples_at_random(others + own)
    measures = np.array([one.measures for one in examples])
    exemplar = exemplar_of(examples, own=range(others, others + own))
    stranger = measures[:others].mean(axis=0)
    centre = (stranger + measures[others:].sum(axis=0)) / (1.0 + own)
    np.testing.assert_allclose(exemplar.centre, centre)
    squares = np.square(measures - centre)
    squares = squares[:others].mean(axis=0) + squares[others:].sum(axis=0)
    usual = PRIOR_SPREADS * np.square(USUAL_SPREAD)
    variance = (usual + squares) / (PRIOR_SPREADS + own) * (1.0 + 1.0 / (1.0 + own))
    np.testing.assert_allclose(np.square(exemplar.spread), variance)
    logs = np.log(exemplar.apart + 1e-3)
    logs = logs[:others].mean(axis=0) + logs[others:].sum(axis=0)
    prior = PRIOR_DISTANCES * np.log(USUAL_DISTANCE)
    np.testing.assert_allclose(np.log(exemplar.scale), (prior + logs) / (PRIOR_DISTANCES + 1 + own))
    assert exemplar.factor.tolist() == [FARTHER] * others + [1.0] * own


def test_each_own_example_moves_what_is_usual_towards_the_performer():
    examples = examples_at_random(5)
    performer = np.array([2.0, 2.0, 2.0, 2.0])
    own = [one._replace(measures=performer) for one in examples_at_random(3, seed=4)]
    far = [
        np.abs(exemplar_of([*examples, *own[:k]], own=range(5, 5 + k)).centre - performer)
        for k in range(4)
    ]
    assert all((after < before).all() for before, after in pairwise(far))
    assert (far[1] <= 0.5 * far[0] + 1e-12).all()


def test_the_order_of_the_examples_does_not_matter():
    examples = examples_at_random(5)
    one = exemplar_of(examples, own=[1, 4])
    other = exemplar_of(examples[::-1], own=[3, 0])
    for name in ("scale", "centre", "spread", "central"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), err_msg=name)


@pytest.mark.parametrize("own", [False, True, (0, 2)])
def test_an_exemplar_is_taken_apart_and_made_again(own):
    exemplar = exemplar_of(examples_at_random(3), own=own)
    assert exemplar.ownership == own
    again = Exemplar.from_arrays(exemplar.to_arrays(), exemplar.ownership)
    assert same(exemplar, again)
    assert np.array_equal(again.own, exemplar.own)
    assert same(exemplar_of(exemplar.examples(), own=own), exemplar)


@pytest.mark.parametrize("own", [[3], [-1]])
def test_an_example_that_is_not_there_is_nobody_s_own(own):
    with pytest.raises(DoodleError, match=r"own: expected numbers of examples, 0 to 2"):
        exemplar_of(examples_at_random(3), own=own)
