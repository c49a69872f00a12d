"""Verification: how well a gesture fits the examples of an action, term by term."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.exemplar import Exemplar, nearest_distances
from smd.recognition.traits import COURSES, MEASURES, Traits

TERMS = (*COURSES, *MEASURES)

WEIGHTS: Mapping[str, float] = MappingProxyType(
    dict(zip(TERMS, (5.6, 0.3, 2.2, 1.1, 0.9, 0.6, 0.4, 0.2), strict=True))
)
_FREEDOM = 4.0
"""Of Student's distribution, which measures are taken to follow: twice the usual size is unusual,
four times the usual size is little more so."""


def terms_of(gesture: Traits, exemplar: Exemplar) -> FloatArray:
    """Return ``(8,)``, how unlike a gesture is an action's examples, in the order of `TERMS`.

    A course's term is its distance to the nearest example, as a multiple of what is usual; a
    measure's is the negative logarithm of Student's density about the examples' mean, against a
    measure of usual spread.
    """
    far = nearest_distances(gesture, exemplar.courses) / exemplar.scale
    squares = np.square((gesture.measures - exemplar.centre) / exemplar.spread)
    return np.concatenate([far, _oddness(squares)])


def left_out_terms(exemplar: Exemplar) -> FloatArray:
    """Return ``(n, 8)``: the terms of each example against the others; none where n is 1.

    The scales and spreads are those of all examples, whose prior outweighs a single one.
    """
    n = len(exemplar.apart)
    if n == 0:
        return np.zeros((0, len(TERMS)))
    others = (exemplar.measures.sum(axis=0) - exemplar.measures) / (n - 1)
    squares = np.square((exemplar.measures - others) / exemplar.spread)
    return np.hstack([exemplar.apart / exemplar.scale, _oddness(squares)])


def _oddness(squares: FloatArray) -> FloatArray:
    """Return the negative logarithm of Student's density, 0 at its peak."""
    return 0.5 * (_FREEDOM + 1.0) * np.log1p(squares / _FREEDOM)
