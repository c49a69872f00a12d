from __future__ import annotations

import numpy as np
import pytest

from smd.errors import DoodleError
from smd.geometry.arrays import frozen_array


def test_a_frozen_array_is_a_read_only_copy():
    source = np.zeros((2, 3))
    frozen = frozen_array("a", source, (None, 3), DoodleError)
    source[:] = 1.0
    assert not frozen.any()
    with pytest.raises(ValueError, match="read-only"):
        frozen[0, 0] = 1.0


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (np.zeros(3), "a: expected shape (any, 3), got (3,)"),
        (np.zeros((2, 4)), "a: expected shape (any, 3), got (2, 4)"),
        ([[0, 0, np.nan]], "a: expected finite numbers, got nan at index (0, 2)"),
    ],
)
def test_what_does_not_fit_is_named(value, message):
    with pytest.raises(DoodleError) as caught:
        frozen_array("a", value, (None, 3), DoodleError)
    assert str(caught.value) == message
