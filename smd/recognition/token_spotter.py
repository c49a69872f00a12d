"""TokenSpotter: from runs of tokens to actions, by the tokens alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from laban import RigidMotion
from smd.geometry.arrays import FloatArray
from smd.recognition.bank import Bank, compile_library, least_costs_of_parts
from smd.recognition.costs import DEFAULT_COSTS, Costs, run_costs
from smd.recognition.detection import Detection
from smd.recognition.loose_ends import with_loose_ends
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import Segment, Segmenter, least_cost_segments
from smd.recognition.tokens import TokenRun


def recognize(
    runs: Sequence[TokenRun],
    library: Bank | Mapping[str, Pattern],
    *,
    costs: Costs = DEFAULT_COSTS,
    segments: Segmenter = least_cost_segments,
) -> tuple[Detection, ...]:
    """Find the actions in a tokenized doodle.

    The runs are cut into actions and unexplained rest, by default at the least total cost: every
    action costs ``costs.action`` and its runs' edit distance to its pattern, every unexplained run
    in proportion to the movement in it, unexplained stillness nothing. Little or aimless movement
    is therefore cheaper to leave unexplained than to explain. An action is then extended over the
    small runs that lead into it or out of it.

    The distance is Levenshtein's (section 4.2 of the paper [1]_) with two costs that depend on
    the run: deleting a run costs less than one edit if there is little movement in it, and
    reading it as its own token costs something if it is faint.

    The confidence compares the chosen action with the other ones and with no action, over the
    same runs: with the cost d of each it is ``exp(-s d_chosen) / sum(exp(-s d))``, where s is
    ``costs.sharpness``, and no action costs its unexplained runs less ``costs.action``. It is a
    ranking score, not a measured probability.

    Parameters
    ----------
    runs
        Of one doodle, from `tokenize`.
    library
        Patterns by action, or the bank they were compiled to; where two explain a span equally
        well, the earlier one is taken.
    costs
        What is weighed against what.
    segments
        How the runs are cut: `least_cost_segments`, or another way (`benchmarks.greedy`).

    Returns
    -------
    tuple of Detection
        In time order, without overlap; each begins and ends with a moving run.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    """
    bank = library if isinstance(library, Bank) else compile_library(library)
    whole = with_loose_ends(segments(bank, runs, costs), runs)
    return tuple(detections_of(bank, runs, whole, costs))


@dataclass(frozen=True, slots=True)
class TokenSpotter:
    """Finds a bank's actions as `recognize` does, for `smd.recognition.streaming`.

    Attributes
    ----------
    bank : the patterns, compiled.
    costs : what is weighed against what.
    """

    bank: Bank
    costs: Costs = DEFAULT_COSTS

    def chosen(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Segment]:
        """Return the stretches of runs that are actions; the motion is not looked at."""
        return with_loose_ends(least_cost_segments(self.bank, runs, self.costs), runs)

    def named(
        self, motion: RigidMotion, runs: Sequence[TokenRun], segments: Sequence[Segment]
    ) -> list[Detection]:
        """Return the detections of stretches of runs; the motion is not looked at."""
        return detections_of(self.bank, runs, segments, self.costs)


def detections_of(
    bank: Bank, runs: Sequence[TokenRun], segments: Sequence[Segment], costs: Costs
) -> list[Detection]:
    """Return the detections of segments that have their loose ends, weighed by tokens alone."""
    prices = run_costs(runs, costs)
    read = prices.of_reading(bank, runs)
    parts = [(one.first, one.last) for one in segments]
    distances = least_costs_of_parts(bank, parts, read=read, skip=prices.skip)
    found = []
    for one, distance in zip(segments, distances, strict=True):
        nothing = float(prices.unexplained[one.first : one.last].sum()) - costs.action
        nearest = np.argsort(distance, kind="stable").tolist()
        found.append(
            Detection(
                action=bank.names[one.index],
                first_run=one.first,
                last_run=one.last,
                start_s=runs[one.first].start_s,
                end_s=runs[one.last - 1].end_s,
                distance=float(distance[one.index]),
                confidence=_share(one.index, np.append(distance, nothing), costs.sharpness),
                alternatives=tuple(
                    (bank.names[i], float(distance[i])) for i in nearest if i != one.index
                ),
            )
        )
    return found


def _share(chosen: int, cost: FloatArray, sharpness: float) -> float:
    """Return the weight of one explanation among all."""
    return float(1.0 / np.exp(-sharpness * (cost - cost[chosen])).sum())
