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


_SIDES, _TIERS, _DEPTHS = ("", "_X", "_N_X"), ("", "_Y", "_N_Y"), ("", "_Z", "_N_Z")

_AHEAD = tuple(f"T{side}_Z" for side in _SIDES)
_AHEAD_UP = tuple(f"T{side}_Y_Z" for side in _SIDES)
_AHEAD_DOWN = tuple(f"T{side}_N_Y_Z" for side in _SIDES)
_BACK = tuple(f"T{side}{tier}_N_Z" for side in _SIDES for tier in _TIERS)
_UP = tuple(f"T{side}_Y" for side in _SIDES)
_DOWN = tuple(f"T{side}_N_Y{depth}" for side in _SIDES for depth in ("", "_N_Z"))
_LEVEL = _maybe(*_AHEAD)

# Level, or uphill until it is set down, or lifted off and then downhill; never to and fro.
_CURVING = ("T_Z/R_Y", "T_Z/R_N_Y")
_WALK = "|".join(
    (
        f"{_either(*_AHEAD_UP, *_AHEAD, *_CURVING)} {_maybe(*_AHEAD_DOWN)}",
        f"{_maybe(*_AHEAD_UP)} {_either(*_AHEAD_DOWN, *_AHEAD, *_CURVING)}",
    )
)

_VALLEY = "|".join(  # between two hops; straight down and straight up again would be two jumps
    (
        f"{_either(*_AHEAD_DOWN)} {_LEVEL} {_either(*_UP, *_AHEAD_UP)}",
        f"{_either(*_DOWN, *_AHEAD_DOWN)} {_LEVEL} {_either(*_AHEAD_UP)}",
        f"{_either(*_AHEAD)} {_either(*_UP, *_AHEAD_UP)}",  # hopping uphill, with a tilted prop
        f"{_either(*_DOWN, *_AHEAD_DOWN)} {_either(*_AHEAD)}",  # or downhill
    )
)
_RUN = (
    f"{_either(*_UP, *_AHEAD_UP)} {_LEVEL} (({_VALLEY}) {_LEVEL})+ {_either(*_DOWN, *_AHEAD_DOWN)}"
)

_JUMP = "|".join(  # one end at least is vertical, or it would be a hop of a run
    (
        f"{_either(*_UP)} {_maybe(*_UP, *_AHEAD_UP)} {_LEVEL} {_either(*_DOWN, *_AHEAD_DOWN)}",
        f"{_either(*_AHEAD_UP)} {_LEVEL} {_maybe(*_AHEAD_DOWN)} {_either(*_DOWN)}",
    )
)

_PUNCH = f"({_either(*_AHEAD, *_AHEAD_UP)}|{_either(*_AHEAD, *_AHEAD_DOWN)}) {_either(*_BACK)}"

_ARC = (
    f"({_either(*_AHEAD_UP)} {_either(*_AHEAD, *_AHEAD_DOWN)}"
    f"|{_either(*_AHEAD)} {_either(*_AHEAD_DOWN)})"
)
_THROW = f"{_either(*_BACK)} {_maybe(*_UP)} {_ARC}"


def _rolling(sign: str) -> tuple[str, ...]:
    """Return the tokens of a roll about the front axis, gliding ahead; ``_N`` is to the right."""
    moves = ("T_Z", "T_X_Z", "T_N_X_Z", "T_Y_Z", "T_N_Y_Z")
    turns = tuple(f"R{side}{sign}_Z" for side in (*_SIDES, "_Y", "_N_Y"))
    return tuple(f"{move}/{turn}" for move in moves for turn in turns)


_ROLL_LEFT, _ROLL_RIGHT = _rolling(""), _rolling("_N")
_LEFT, _RIGHT = _either(*_ROLL_LEFT), _either(*_ROLL_RIGHT)
_FLY = (
    f"({_LEFT} {_LEVEL} {_RIGHT} {_LEVEL} {_LEFT}|{_RIGHT} {_LEVEL} {_LEFT} {_LEVEL} {_RIGHT}) "
    f"{_maybe(*_AHEAD, *_ROLL_LEFT, *_ROLL_RIGHT, 'R_Z', 'R_N_Z')}"
)


def _side_step(sign: str) -> str:
    """Return the pattern of a glide to a side, which may slant; ``_N`` is to the right."""
    straight = tuple(f"T{sign}_X{tier}" for tier in _TIERS)
    slanting = tuple(f"T{sign}_X{tier}{depth}" for tier in _TIERS for depth in ("_Z", "_N_Z"))
    return f"{_maybe(*slanting)} {_either(*straight)} {_maybe(*straight, *slanting)}"


def _turn(sign: str) -> str:
    """Return the pattern of a turn about the up axis; ``_N`` is to the right."""
    return _either(*(f"R{side}{sign}_Y{depth}" for side in _SIDES for depth in _DEPTHS))


def _tilt(sign: str, *carried: str) -> str:
    """Return the pattern of a tilt about the left axis, ``_N`` back, perhaps carried along."""
    turns = (f"R{sign}_X{tier}{depth}" for tier in _TIERS for depth in _DEPTHS)
    return _either(*turns, *(f"{move}/R{sign}_X" for move in carried))


_BOW = f"{_tilt('', 'T_Z', 'T_N_Y_Z')} {_tilt('_N', 'T_N_Z', 'T_Y_N_Z')}"

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
        Pattern.parse(_side_step("")),
        travels=True,
        cyclic=True,
        description="Glide the prop to its left while it goes on facing ahead.",
    ),
    Action(
        "side_step_right",
        Pattern.parse(_side_step("_N")),
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
        Pattern.parse(_turn("")),
        description="Turn the prop to its left on the spot.",
    ),
    Action(
        "turn_right",
        Pattern.parse(_turn("_N")),
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
        Pattern.parse(_BOW),
        description="Tip the prop forward and bring it back up.",
    ),
    Action(IDLE, None, cyclic=True),
)
"""What the shipped humanoid can do, and `IDLE`, which nobody draws."""
