"""Teaching: an action from examples of its gesture."""

from __future__ import annotations

from collections.abc import Sequence

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.recognition.action import Action
from smd.recognition.background import weighed
from smd.recognition.exemplar import exemplar_of
from smd.recognition.learning import learn_pattern
from smd.recognition.traits import traits_of
from smd.smoothing import smooth


def learn_action(
    name: str,
    doodles: Sequence[Doodle],
    *,
    names: Sequence[str] | None = None,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
    own: bool = True,
) -> Action:
    """Learn an action from examples of its gesture; three are usually enough.

    Parameters
    ----------
    name
        Of the action.
    doodles
        At least one, each with the gesture once, with or without rest around it.
    names
        What to call the examples; ``example 1`` and so on if absent.
    figure_height_m
        Height of the figurine that the prop stands for.
    own
        Whether the examples are of the person whose gestures are to be recognised; it matters
        once there are also some of others.

    Raises
    ------
    LearningError
        If there is no example, if one never moves, or if one has nothing in common with the
        others.
    """
    learned = learn_pattern(doodles, names=names or (), figure_height_m=figure_height_m)
    examples = [
        traits_of(smooth(doodle).between(*span), figure_height_m=figure_height_m)
        for doodle, span in zip(doodles, learned.spans_s, strict=True)
    ]
    exemplar = weighed(exemplar_of(examples, own=own))
    return Action(name, learned.pattern, learned_from=learned.names, exemplar=exemplar)
