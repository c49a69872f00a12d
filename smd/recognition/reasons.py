"""Reasons: what kept an action from being recognised, in words that help to draw it again."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.action import Action
from smd.recognition.traits import COURSES, MEASURES
from smd.recognition.verification import TERMS, WEIGHTS, oddness

if TYPE_CHECKING:
    from smd.recognition.matching import Match

FITS, OUTDONE = "would pass by itself", "another action fits better"
WITHIN = "like its examples, but for the tolerance"
ANOTHER_WAY, TURNED = "another way", "held or turned otherwise"
OTHER_STROKES, OTHER_RHYTHM = "other strokes", "another rhythm"

MEASURED = {
    "duration": ("too quick", "too slow"),
    "extent": ("too small", "too large"),
    "path": ("too short a way", "too long a way"),
    "turning": ("turned too little", "turned too much"),
}
"""What is said of a measure below the examples', and above."""

FAR_OUT = 2.5
"""A measure so many standard deviations from the examples' mean is named beside the most expensive
term: it has a small weight, but a person can correct it."""

USUAL_WRONG = 0.15
"""Usual share of wrong tokens in a gesture that is recognised."""


def reason_of(match: Match, action: Action, measures: FloatArray) -> str:
    """Return what kept an action from being recognised.

    It names the term with the largest excess over its usual cost, and the measure that is farthest
    from the examples', if it is far.

    Parameters
    ----------
    match
        How well the gesture fits the action.
    action
        Its examples, if it has any, say what is usual.
    measures
        ``(4,)``, of the gesture (`smd.recognition.traits.Traits`).
    """
    if match.distance <= match.most:
        return FITS
    if action.exemplar is None:
        return OTHER_STROKES
    deviation = (measures - action.exemplar.centre) / action.exemplar.spread
    said = {
        name: MEASURED[name][int(far > 0)] for name, far in zip(MEASURES, deviation, strict=True)
    }
    excess = {
        name: value - usual for (name, value), usual in zip(match.terms, _usual(), strict=True)
    }
    most = max(excess, key=lambda name: excess[name])
    if excess[most] <= 0.0:
        return WITHIN
    reasons = [said[most] if most in said else _of_course(most, excess)]
    farthest = int(np.argmax(np.abs(deviation)))
    if abs(deviation[farthest]) >= FAR_OUT:
        reasons.append(said[MEASURES[farthest]])
    return ", ".join(dict.fromkeys(reasons))


def _of_course(name: str, excess: dict[str, float]) -> str:
    """Return what is said where the tokens or a course cost most."""
    if name == "tokens":
        return OTHER_STROKES
    if name.startswith("flow"):
        return OTHER_RHYTHM
    # Seen from the prop itself the same shape fits: it went that way, but the prop did not face so.
    share = {one: excess[f"shape_{one}"] / WEIGHTS[TERMS.index(f"shape_{one}")] for one in _FRAMES}
    return TURNED if share["prop"] < 0.5 * share["heading"] else ANOTHER_WAY


_FRAMES = ("heading", "prop")


def _usual() -> FloatArray:
    """Return what an example's terms usually are, in the order of `TERMS`."""
    courses, measures = np.ones(len(COURSES)), np.full(len(MEASURES), float(oddness(np.ones(()))))
    return np.asarray(WEIGHTS * np.concatenate([[USUAL_WRONG], courses, measures]))
