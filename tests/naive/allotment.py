"""The sum that an allotment makes least, term by term as its constants' docstrings say it."""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares

from smd.transfer.allotment import (
    DRAWN_WEIGHT,
    RETURN_WEIGHT,
    SHORTEST_S,
    STRIKE_S,
    STRIKE_WEIGHT,
    WISHED,
)

FIRM = 1e6
"""Weight of what must hold."""


def least_moments(wishes, start_s, end_s):
    """Return the moments of every phrase, as lists (begin, strike, end) or (begin, end)."""
    drawn = [
        [w.start_s, w.end_s] if w.strike_s is None else [w.start_s, w.strike_s, w.end_s]
        for w in wishes
    ]
    sizes = [len(moments) for moments in drawn]

    def cut(flat):
        return [list(part) for part in np.split(flat, np.cumsum(sizes)[:-1])]

    found = np.concatenate(drawn)
    for firm in (1e2, 1e3, 1e4, 1e5, FIRM):  # at once, it would creep along the firm terms
        found = least_squares(
            lambda flat, firm=firm: terms(cut(flat), drawn, wishes, start_s, end_s, firm),
            found,
            xtol=1e-12,
            ftol=1e-14,
            gtol=1e-12,
            max_nfev=100,
        ).x
    return cut(found)


def terms(moments, drawn, wishes, start_s, end_s, firm):
    """Return the terms whose squares are summed."""
    found = []

    def below(value, least, weight):
        found.append(np.sqrt(weight) * min(value - least, 0.0))

    def wish(lasting_s, needed_s, weight=1.0):
        for share, cost in WISHED:
            below(lasting_s / needed_s, share, weight * cost)

    def near(value, wanted, weight):
        found.append(np.sqrt(weight) * (value - wanted))

    following = [*(m[0] for m in moments[1:]), end_s]
    for i, (now, was, w) in enumerate(zip(moments, drawn, wishes, strict=True)):
        near(now[0], was[0], DRAWN_WEIGHT)
        near(now[-1], was[-1], DRAWN_WEIGHT)
        wish(now[1] - now[0], max(w.before_s, SHORTEST_S))
        for k in range(len(now) - 1):
            below(now[k + 1] - now[k], min(SHORTEST_S, was[k + 1] - was[k]), firm)
        if w.strike_s is not None:
            wish(now[2] - now[1], max(w.after_s, SHORTEST_S))
            near(now[1], was[1], STRIKE_WEIGHT)
            for beyond_s, weight in STRIKE_S:
                below(-abs(now[1] - was[1]), -beyond_s, weight)
        below(following[i] - now[-1], 0.0, firm)
        if w.return_s > 0.0:
            wish(following[i] - now[-1], w.return_s, RETURN_WEIGHT)
    below(moments[0][0], start_s, firm)
    return np.array(found)
