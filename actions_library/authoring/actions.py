"""The humanoid's actions, and the gestures of a prop that ask for them.

The patterns are written by hand. Gestures are told apart by their shape, never by their speed:
walking glides and running hops. A stroke of the hand is rarely straight, so a pattern names the
direction that is meant together with its neighbours; ``docs/recognition.md`` has the grammar.
"""

from __future__ import annotations

from actions_library.library import IDLE
from smd.recognition.action import Action
from smd.recognition.pattern import Pattern


def _either(*tokens: str) -> str:
    """Return a group in which any of the tokens may stand, in any order, at least one."""
    return f"({'|'.join(tokens)})+"


def _maybe(*tokens: str) -> str:
    """Return a group in which any of the tokens may stand, or none."""
    return f"({'|'.join(tokens)})*"


_AHEAD = ("T_Z", "T_X_Z", "T_N_X_Z")
_AHEAD_UP = ("T_Y_Z", "T_X_Y_Z", "T_N_X_Y_Z")
_AHEAD_DOWN = ("T_N_Y_Z", "T_X_N_Y_Z", "T_N_X_N_Y_Z")
_BACK = ("T_N_Z", "T_X_N_Z", "T_N_X_N_Z", "T_Y_N_Z", "T_N_Y_N_Z")
_UP = ("T_Y", "T_X_Y", "T_N_X_Y", "T_Y_N_Z")
_DOWN = ("T_N_Y", "T_X_N_Y", "T_N_X_N_Y", "T_N_Y_N_Z")
_TURNING_WALK = ("T_Z/R_Y", "T_Z/R_N_Y")


def _rolling(sign: str) -> tuple[str, ...]:
    """Return the tokens of a roll about the front axis, gliding ahead; ``_N`` is to the right."""
    moves = ("T_Z", "T_X_Z", "T_N_X_Z", "T_Y_Z", "T_N_Y_Z")
    turns = tuple(f"R{side}{sign}_Z" for side in ("", "_X", "_N_X", "_Y", "_N_Y"))
    return tuple(f"{move}/{turn}" for move in moves for turn in turns)


def _turning(sign: str) -> str:
    """Return the pattern of a turn about the up axis; ``_N`` is to the right."""
    return _either(
        *(
            f"R{tokens}"
            for tokens in (
                f"{sign}_Y",
                f"_X{sign}_Y",
                f"_N_X{sign}_Y",
                f"{sign}_Y_Z",
                f"{sign}_Y_N_Z",
            )
        )
    )


def _pitching(sign: str, carried: str) -> str:
    """Return the pattern of a tilt about the left axis; ``_N`` is back. The prop may be carried."""
    sides = ("", "_Y", "_N_Y", "_Z", "_N_Z")
    return _either(*(f"R{sign}_X{side}" for side in sides), f"{carried}/R{sign}_X")


# Level, or uphill until it is set down, or lifted off and then downhill; never to and fro.
_WALK = "|".join(
    (
        f"{_either('T_Y_Z', *_AHEAD, *_TURNING_WALK)} T_N_Y_Z*",
        f"T_Y_Z* {_either('T_N_Y_Z', *_AHEAD, *_TURNING_WALK)}",
    )
)
_LEVEL = _maybe(*_AHEAD)
_VALLEY = "|".join(  # between two hops; straight down and straight up again would be two jumps
    (
        f"{_either(*_AHEAD_DOWN)} {_LEVEL} {_either('T_Y', *_AHEAD_UP)}",
        f"{_either('T_N_Y', *_AHEAD_DOWN)} {_LEVEL} {_either(*_AHEAD_UP)}",
        f"{_either(*_AHEAD)} {_either(*_AHEAD_UP)}",  # hopping uphill, with a tilted prop
        f"{_either(*_AHEAD_DOWN)} {_either(*_AHEAD)}",  # or downhill
    )
)
_RUN = (
    f"{_either('T_Y', *_AHEAD_UP)} {_LEVEL} (({_VALLEY}) {_LEVEL})+ "
    f"{_either('T_N_Y', *_AHEAD_DOWN)}"
)
_JUMP = "|".join(  # one end at least is vertical, or it would be a hop of a run
    (
        f"{_either(*_UP)} {_maybe(*_UP, *_AHEAD_UP)} {_maybe(*_AHEAD)} "
        f"{_either(*_DOWN, *_AHEAD_DOWN)}",
        f"{_either(*_AHEAD_UP)} {_maybe(*_AHEAD)} {_maybe(*_AHEAD_DOWN)} {_either(*_DOWN)}",
    )
)
_PUNCH = f"({_either(*_AHEAD, *_AHEAD_UP)}|{_either(*_AHEAD, *_AHEAD_DOWN)}) {_either(*_BACK)}"
_ARC = (
    f"({_either(*_AHEAD_UP)} {_either(*_AHEAD, *_AHEAD_DOWN)}"
    f"|{_either(*_AHEAD)} {_either(*_AHEAD_DOWN)})"
)
_THROW = f"{_either(*_BACK)} T_Y* {_ARC}"
_LEFT, _RIGHT = _either(*_rolling("")), _either(*_rolling("_N"))
_FLY = (
    f"({_LEFT} {_LEVEL} {_RIGHT} {_LEVEL} {_LEFT}|{_RIGHT} {_LEVEL} {_LEFT} {_LEVEL} {_RIGHT}) "
    f"{_maybe(*_AHEAD, *_rolling(''), *_rolling('_N'), 'R_Z', 'R_N_Z')}"
)

HUMANOID_ACTIONS: tuple[Action, ...] = (
    Action(
        "walk",
        Pattern.parse(_WALK),
        travels=True,
        cyclic=True,
        description="Glide the prop ahead.",
    ),
    Action(
        "run",
        Pattern.parse(_RUN),
        travels=True,
        cyclic=True,
        description="Hop the prop ahead in at least two low bounds, without stopping.",
    ),
    Action(
        "side_step_left",
        Pattern.parse(f"{_maybe('T_X_Z', 'T_X_N_Z')} T_X+ {_maybe('T_X', 'T_X_Z', 'T_X_N_Z')}"),
        travels=True,
        cyclic=True,
        description="Glide the prop to its left while it goes on facing ahead.",
    ),
    Action(
        "side_step_right",
        Pattern.parse(
            f"{_maybe('T_N_X_Z', 'T_N_X_N_Z')} T_N_X+ {_maybe('T_N_X', 'T_N_X_Z', 'T_N_X_N_Z')}"
        ),
        travels=True,
        cyclic=True,
        description="Glide the prop to its right while it goes on facing ahead.",
    ),
    Action(
        "jump",
        Pattern.parse(_JUMP),
        travels=True,
        description="Lift the prop straight up, carry it over, and set it straight down.",
    ),
    Action(
        "turn_left",
        Pattern.parse(_turning("")),
        description="Turn the prop to its left on the spot.",
    ),
    Action(
        "turn_right",
        Pattern.parse(_turning("_N")),
        description="Turn the prop to its right on the spot.",
    ),
    Action(
        "punch",
        Pattern.parse(_PUNCH),
        description="Thrust the prop ahead and take it straight back.",
    ),
    Action(
        "throw",
        Pattern.parse(_THROW),
        description="Draw the prop back, then fling it ahead in an arc over the top.",
    ),
    Action(
        "fly",
        Pattern.parse(_FLY),
        travels=True,
        cyclic=True,
        description="Glide the prop ahead while rocking it from wing to wing.",
    ),
    Action(
        "bow",
        Pattern.parse(f"{_pitching('', 'T_Z')} {_pitching('_N', 'T_N_Z')}"),
        description="Tip the prop forward and bring it back up.",
    ),
    Action(IDLE, None, cyclic=True),
)
"""What the shipped humanoid can do, and `IDLE`, which nobody draws."""
