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
    distance : what it costs to see the gesture so; for None, what no action may cost.
    confidence : in [0, 1], adding up to 1 over all matches of a gesture.
    most : what the action may cost to be accepted; infinite for None.
    terms : what the distance is made of, by name, weights included; empty for None.
    """

    action: str | None
    distance: float
    confidence: float
    most: float = np.inf
    terms: tuple[tuple[str, float], ...] = ()
