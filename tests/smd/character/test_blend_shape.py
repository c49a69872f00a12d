from __future__ import annotations

import numpy as np
import pytest

from smd.character.blend_shape import BlendShape
from smd.errors import CharacterError


def test_a_sparse_shape_keeps_what_moves():
    offsets = np.zeros((5, 3))
    offsets[[1, 4], [0, 2]] = [0.5, -2.0]
    shape = BlendShape.sparse("smile", offsets)
    assert shape.indices.tolist() == [1, 4]
    assert shape.offsets_m.tolist() == [[0.5, 0.0, 0.0], [0.0, 0.0, -2.0]]


def test_a_shape_may_move_nothing():
    assert len(BlendShape.sparse("none", np.zeros((5, 3))).indices) == 0


@pytest.mark.parametrize(
    ("indices", "offsets", "message"),
    [
        ([0, 1], np.zeros((3, 3)), r"'smile': offsets_m: expected shape \(2, 3\), got \(3, 3\)"),
        ([0, 1], [[0, 0, 0], [0, np.nan, 0]], "'smile': offsets_m: expected finite numbers"),
        ([1, 0], np.zeros((2, 3)), "'smile': indices: expected increasing ones"),
        ([1, 1], np.zeros((2, 3)), "'smile': indices: expected increasing ones"),
        ([-1, 1], np.zeros((2, 3)), "'smile': indices: expected increasing ones from 0"),
    ],
)
def test_what_is_no_shape_is_refused(indices, offsets, message):
    with pytest.raises(CharacterError, match=message):
        BlendShape("smile", np.array(indices), np.array(offsets))
