from __future__ import annotations

from itertools import groupby

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from smd.geometry.runs import runs_of_true


@given(st.lists(st.booleans(), max_size=30))
def test_runs_are_those_that_a_walk_along_the_signal_finds(signal):
    walked, at = [], 0
    for value, group in groupby(signal):
        length = len(list(group))
        walked += [[at, at + length]] if value else []
        at += length
    assert runs_of_true(np.array(signal, dtype=bool)).tolist() == walked


@pytest.mark.parametrize("signal", [[], [False], [False, False]])
def test_a_signal_that_is_never_true_has_no_runs(signal):
    assert runs_of_true(np.array(signal, dtype=bool)).shape == (0, 2)
