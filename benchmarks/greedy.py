"""Greedy: the paper's way to cut a token string, longest match first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.bank import Bank
from smd.recognition.costs import Costs
from smd.recognition.segmentation import Segment
from smd.recognition.tokens import TokenRun

MOST_WRONG = 1.0 / 3.0
"""Edits in a match, as a share of its tokens: one slip in three tokens."""

MOST_EDITS = 3
"""Edits in a match, in all: Levenshtein automata are made for a bounded number of them."""


def longest_match_segments(bank: Bank, runs: Sequence[TokenRun], _: Costs) -> tuple[Segment, ...]:
    """Cut runs from left to right, each time taking the match that reads most (a `Segmenter`).

    The paper [1]_ searches for the action at the smallest Levenshtein distance to the current
    tokens (section 4.2) and gives priority to the largest token sequences (section 7.5). Our
    reading: of all matches that begin at a token, with at most `MOST_WRONG` edits a token and
    `MOST_EDITS` [2]_ in all, the one with the most tokens besides its edits is taken, then the
    nearest, then that of the earliest action; where there is none, the token is passed over. How
    long runs last and how much movement is in them is not looked at. It is here to be compared
    with; to be as the paper has it, the bank is compiled with unit costs.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    .. [2] K. U. Schulz, S. Mihov, "Fast String Correction with Levenshtein Automata",
       International Journal on Document Analysis and Recognition 5, 2002.
    """
    segments: list[Segment] = []
    if not len(bank):
        return ()
    read = bank.reading(run.token for run in runs)
    at = 0
    while at < len(runs):
        match = _longest_match(bank, read[at:])
        if match is None:
            at += 1
            continue
        index, length = match
        segments.append(Segment(index, at, at + length))
        at += length
    return tuple(segments)


def _longest_match(bank: Bank, read: FloatArray) -> tuple[int, int] | None:
    """Return the action and the number of tokens of the best match from the first token on."""
    front = bank.nowhere()
    best, found = (0.0, 0.0), None
    for j, reading in enumerate(read):
        entering = float(j)  # tokens before the first one that is read are edits of the match
        front = bank.after(front, entering=entering, at=0, read=reading, skip=1.0)
        distance = bank.leaving(front).cost
        length = j + 1
        index = int(distance.argmin())
        nearest = float(distance[index])
        rank = (length - nearest, -nearest)
        if nearest <= min(MOST_WRONG * length, MOST_EDITS) and rank > best:
            best, found = rank, (index, length)
        if np.min(front.cost) > MOST_EDITS:  # edits only grow along a way
            break
    return found
