"""What libraries pass in movement that means nothing: ``python -m benchmarks.acceptance``.

Made-up movement (`smd.recognition.background`) of another seed than the one that actions are held
against, read without a word of what is meant. Goal: a library passes 0.3 phrases a minute at
most. With ``--fit`` the margin is printed at which each library passes just that, and the one to
ship: the mean over libraries, to a twentieth.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import numpy as np

from actions_library.folder import load_library
from benchmarks.gestures import DATA, learned_action, read_gestures
from benchmarks.guards import spans_in
from benchmarks.recognition import poisson_interval
from smd.doodle import Doodle
from smd.recognition import Recognizer
from smd.recognition.acceptance import OWN_MARGIN, Intent
from smd.recognition.action import Action
from smd.recognition.background import MOVER_S, made_up_movement

MARGINS = (0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5)
MOST_A_MINUTE = 0.3
SEED, MOVERS = 2030, 40
DEVELOPED = (1, 4, 7)
EXAMPLES = 3


def libraries() -> Iterator[tuple[str, Sequence[Action]]]:
    """Yield the shipped library, parts of it, and what some people teach, with their names."""
    rng = np.random.default_rng(SEED)
    shipped = [action for action in load_library().actions if action.pattern]
    for count in (5, 11, 22, len(shipped)):
        yield (
            f"{count} shipped actions",
            [shipped[i] for i in rng.permutation(len(shipped))[:count]],
        )
    if not (DATA / "gestures").is_dir():
        return
    data = read_gestures(DEVELOPED)
    for person in DEVELOPED:
        for most in (6, 14):
            taught = []
            for label in rng.permutation(np.unique(data.label))[:most]:
                own = np.flatnonzero((data.label == label) & (data.person == person))[:EXAMPLES]
                if len(own):
                    taught.append(learned_action(str(label), [data.doodles[i] for i in own]))
            yield f"{len(taught)} gestures of person {person}", taught


def rates(actions: Sequence[Action], movement: Sequence[Doodle]) -> list[float]:
    """Return phrases a minute at each of `MARGINS`."""
    minutes = len(movement) * MOVER_S / 60.0
    shipped = OWN_MARGIN[Intent.FREE]
    found = []
    for margin in MARGINS:
        recognizer = Recognizer(
            actions, tolerance=float(np.exp(shipped - margin)), intent=Intent.FREE
        )
        found.append(sum(spans_in(movement, recognizer).values()) / minutes)
    return found


def margin_of(rate: Sequence[float]) -> float:
    """Return the margin at which a library passes `MOST_A_MINUTE`, among those tried."""
    falling = np.maximum.accumulate(np.asarray(rate)[::-1])
    return float(np.interp(MOST_A_MINUTE, falling, np.asarray(MARGINS)[::-1]))


def main() -> None:
    """Print what each library passes, and with ``--fit`` the margin to ship."""
    rng = np.random.default_rng(SEED)
    movement = [made_up_movement(rng, duration_s=MOVER_S) for _ in range(MOVERS)]
    minutes = MOVERS * MOVER_S / 60.0
    low, high = (bound / minutes for bound in poisson_interval(round(MOST_A_MINUTE * minutes)))
    print(
        f"{minutes:.0f} min of made-up movement; {MOST_A_MINUTE:g} a minute seen in it is "
        f"{low:.2f} to {high:.2f} (95 %)"
    )
    print(f"  phrases a minute at margins of {', '.join(f'{m:g}' for m in MARGINS)}")
    fitted = []
    for name, actions in libraries():
        rate = rates(actions, movement)
        fitted.append(margin_of(rate))
        told = "  ".join(f"{one:5.2f}" for one in rate)
        margin = f"  {MOST_A_MINUTE:g} at {fitted[-1]:.2f}" if "--fit" in sys.argv else ""
        print(f"  {name:26} {told}{margin}", flush=True)
    if "--fit" in sys.argv:
        mean = float(np.mean(fitted))
        print(
            f"margin to ship: {0.05 * round(mean / 0.05):.2f} (mean {mean:.2f}, standard deviation "
            f"over libraries {np.std(fitted):.2f}); shipped: {OWN_MARGIN[Intent.FREE]:g}"
        )


if __name__ == "__main__":
    main()
