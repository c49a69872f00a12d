"""Candidates: the stretches of a doodle that are weighed as actions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from smd.geometry.arrays import BoolArray, FloatArray
from smd.recognition.acceptance import Intent
from smd.recognition.loose_ends import with_loose_ends
from smd.recognition.proposals import Proposal, rest_to_rest, without_stir
from smd.recognition.segmentation import Segment
from smd.recognition.stretches import dense_stretches
from smd.recognition.tokens import TokenRun

Stretch: TypeAlias = tuple[int, int, bool]
"""A stretch's first run, the one after its last, and whether it is proposed by its length alone."""


def candidate_stretches(
    proposed: Sequence[Proposal],
    runs: Sequence[TokenRun],
    is_still: BoolArray,
    durations_s: FloatArray,
    intent: Intent,
) -> list[Stretch]:
    """Return the stretches of n runs that may be an action, without stir at their ends.

    The automata propose some; others reach from rest to rest. In free movement hands hardly rest,
    so dense stretches are added: everywhere, with the lengths of actions.

    Parameters
    ----------
    proposed
        By the automata.
    runs
        Of one doodle.
    is_still
        ``(n,)``.
    durations_s
        ``(a,)``, usual duration of each action, at least one.
    intent
        Whether the movement is meant.
    """
    found = [*((one.first, one.last) for one in proposed), *rest_to_rest(is_still)]
    spoken_for = dict.fromkeys(_as_meant(found, runs))
    if intent is Intent.DRAWN:
        return [(*one, False) for one in spoken_for]
    anywhere = dense_stretches(runs, is_still, durations_s)
    dense = dict.fromkeys(without_stir(anywhere, runs))  # others of them have the loose ends
    return [
        *((*one, False) for one in spoken_for),
        *((*one, True) for one in dense if one not in spoken_for),
    ]


def _as_meant(
    stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun]
) -> list[tuple[int, int]]:
    """Return stretches without stir at their ends, and then as well with their loose ends."""
    tight = list(dict.fromkeys(without_stir(stretches, runs)))
    grown = [with_loose_ends([Segment(0, *one)], runs)[0] for one in tight]
    return [*tight, *((one.first, one.last) for one in grown)]
