"""How a committee is best heard where takes are few: ``python -m benchmarks.effort_committee``.

Small groups of simulated people, ten with one take for each label, teach, and all others are told:
which members, and which power of the likelihood in their shares (`laban.committee.POWER`; 0 hears
all alike). Beside it stands what the same choice comes to on real people, who were not asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmarks.laban import SEED, real_people, simulated, spread_at
from laban.committee import MEMBERS, folds, held_out_odds, temperature
from laban.linear import Linear
from laban.motion import FloatArray
from laban.training import entries_of, seen_in
from smd.effort import TrainingSet

IntArray = NDArray[np.int64]

PEOPLE, GROUP, GROUPS = 72, 10, 10
DIFFICULTIES = (0.5, 1.0)
LABELLED = 0.9
"""Share of the labels that are there; real people lack some."""

POWERS = (0.0, 0.25, 0.5, 1.0)
REGRESSIONS = tuple(n for n in MEMBERS if "naive" not in n and n != "products")
CHOICES: Mapping[str, tuple[str, ...]] = {
    "logistic regressions": REGRESSIONS,
    "these and naive Bayes": tuple(name for name in MEMBERS if name != "products"),
}

Choice: TypeAlias = tuple[str, float]
"""Members and power."""

Readings: TypeAlias = dict[Choice, FloatArray]
"""Log odds."""

Shares: TypeAlias = dict[Choice, float]
"""Of takes that are told right."""


def read(seen: FloatArray, goal: FloatArray, whose: IntArray, asked: FloatArray) -> Readings:
    """Return the log odds of takes ``asked``, for every choice, by those who learned the others."""
    out = folds(whose)
    factors: dict[str, float] = {}
    losses: dict[str, float] = {}
    fitted: dict[str, Linear] = {}
    for name in CHOICES["these and naive Bayes"]:
        member = MEMBERS[name]
        odds = held_out_odds(member, seen, goal, out)
        factors[name], losses[name] = temperature(odds, goal)
        fitted[name] = member.learned(seen, goal)
    found: Readings = {}
    for choice, names in CHOICES.items():
        best = min(losses[name] for name in names)
        for power in POWERS:
            shares = np.array([np.exp(power * (best - losses[name])) for name in names])
            said = [factors[name] * fitted[name].log_odds(asked) for name in names]
            found[choice, power] = shares / shares.sum() @ np.array(said)
    return found


def by_simulated(examples: TrainingSet, against: bool, rng: np.random.Generator) -> Shares:
    """Return the share that groups tell of all others, by choice and power."""
    described = examples.descriptions
    whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
    right: dict[Choice, list[float]] = {}
    for _ in range(GROUPS):
        group = rng.choice(PEOPLE, GROUP, replace=False)
        labels = np.full(examples.meant.shape, np.nan)
        for person in group:
            mine = np.flatnonzero(whose == person)
            for axis in range(labels.shape[1]):
                for pole in (-1.0, 1.0):
                    if rng.random() < LABELLED:
                        take = rng.choice(mine[examples.meant[mine, axis] == pole])
                        labels[take, axis] = pole
        taken = np.flatnonzero(np.isfinite(labels).any(axis=1))
        others = np.flatnonzero(~np.isin(whose, group))
        entries = entries_of(described[taken], whose[taken], against)
        seen = seen_in(entries, described[taken], whose[taken])
        asked = seen_in(entries, described[others], whose[others])
        for axis in range(labels.shape[1]):
            known = np.isfinite(labels[taken, axis])
            meant = examples.meant[others, axis]
            poles = np.abs(meant) == 1.0
            goal = labels[taken, axis][known]
            readings = read(seen[known], goal, whose[taken][known], asked[poles])
            for choice, odds in readings.items():
                right.setdefault(choice, []).append(float(np.mean(odds * meant[poles] > 0.0)))
    return {choice: float(np.mean(shares)) for choice, shares in right.items()}


def by_real(examples: TrainingSet, against: bool) -> Shares:
    """Return the mean over the axes of what is told of real people, each left out."""
    described = examples.descriptions
    whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
    means: dict[Choice, list[float]] = {}
    for goal in examples.meant.T:
        right: dict[Choice, list[bool]] = {}
        for out in folds(whose):
            entries = entries_of(described[~out], whose[~out], against)
            seen = seen_in(entries, described[~out], whose[~out])
            known, asked = np.isfinite(goal[~out]), np.isfinite(goal[out])
            told = seen_in(entries, described[out], whose[out])[asked]
            readings = read(seen[known], goal[~out][known], whose[~out][known], told)
            for choice, odds in readings.items():
                right.setdefault(choice, []).extend((odds * goal[out][asked] > 0.0).tolist())
        for choice, each in right.items():
            means.setdefault(choice, []).append(float(np.mean(each)))
    return {choice: float(np.mean(each)) for choice, each in means.items()}


def main() -> None:
    """Print, for each choice, what is told of simulated people and of real ones."""
    crowds = [
        simulated(people=PEOPLE, repeats=4, seed=SEED, spread=spread_at(difficulty))
        for difficulty in DIFFICULTIES
    ]
    _, _, real = real_people()
    for against in (False, True):
        rng = np.random.default_rng(SEED)
        told = [by_simulated(crowd, against, rng) for crowd in crowds]
        of_real = by_real(real, against)
        print("with the performer's other takes" if against else "performer unknown")
        for choice, share in of_real.items():
            members, power = choice
            of_simulated = np.mean([one[choice] for one in told])
            print(f"  {members}, power {power:g}: simulated {of_simulated:.3f}, real {share:.3f}")


if __name__ == "__main__":
    main()
