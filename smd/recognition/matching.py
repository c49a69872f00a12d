"""Match: how well a gesture fits an action, or none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Match:
    """How well a gesture fits one action, or none.

    Attributes
    ----------
    action : its name; None for no action at all.
    distance : the cost of the gesture as this action; for None, that of seeing no action.
    confidence : in [0, 1], adding up to 1 over all matches of a gesture.
    most : the threshold of the action; infinite for None.
    terms : the terms of the distance, by name, weights included; empty for None.
    """

    action: str | None
    distance: float
    confidence: float
    most: float = np.inf
    terms: tuple[tuple[str, float], ...] = ()
