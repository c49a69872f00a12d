"""Detection: an action that was found, and when."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Detection:
    """An action that was found in a doodle: a stretch of runs, and how sure it is.

    Attributes
    ----------
    action : its name.
    first_run, last_run : runs ``first_run`` (included) to ``last_run`` (excluded).
    start_s, end_s : where the first of them begins and the last one ends.
    distance : from the runs to the action's pattern, in edits.
    confidence : in [0, 1], see `smd.recognition.token_spotter.recognize`.
    alternatives : the other actions and their distances, nearest first.
    """

    action: str
    first_run: int
    last_run: int
    start_s: float
    end_s: float
    distance: float
    confidence: float
    alternatives: tuple[tuple[str, float], ...]
