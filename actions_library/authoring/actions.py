"""The humanoid's actions, and the gestures of a prop that ask for them.

The patterns are written by hand. Gestures are told apart by their shape, never by their speed:
walking glides and running hops. A stroke of the hand is rarely straight, so a pattern names the
direction that is meant together with its neighbours; ``docs/recognition.md`` has the grammar.
"""

from __future__ import annotations

from smd.cast import IDLE
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
_BACK_LOW = tuple(f"T{side}{tier}_N_Z" for side in _SIDES for tier in ("", "_N_Y"))
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

# Where the prop is tipped, its own directions tip with it: laid on its face, "up" is head first.
_TIP, _TIP_BACK = _tilt("", "T_Z", "T_Y", "T_N_Y_Z"), _tilt("_N", "T_N_Z", "T_Y", "T_Y_N_Z")
_RISE = tuple(f"T{side}_Y{depth}" for side in _SIDES for depth in _DEPTHS)
_SINK = tuple(f"T{side}_N_Y{depth}" for side in _SIDES for depth in _DEPTHS)
_HEAD_FIRST = (*_RISE, "T_Y/R_X", "T_Y/R_N_X", "T_Y_Z/R_X", "T_Y_Z/R_N_X")


def _turning(sign: str, *moves: str) -> tuple[str, ...]:
    """Return the tokens of turning about the up axis, ``_N`` to the right, alone or carried."""
    turns = tuple(f"R{side}{sign}_Y{depth}" for side in _SIDES for depth in _DEPTHS)
    return (*turns, *(f"{move}/{turn}" for move in moves for turn in turns))


def _rocking(sign: str, *moves: str) -> tuple[str, ...]:
    """Return the tokens of tilting about the front axis, ``_N`` to the right, alone or carried."""
    turns = tuple(f"R{side}{tier}{sign}_Z" for side in _SIDES for tier in _TIERS)
    return (*turns, *(f"{move}/R{sign}_Z" for move in moves))


def _to_and_fro(one: tuple[str, ...], other: tuple[str, ...], times: int, *between: str) -> str:
    """Return at least so many strokes, turn by turn, either one first."""
    gap = f" {_maybe(*between)} " if between else " "
    strokes = (_either(*one), _either(*other))
    ways = (gap.join(strokes[(i + first) % 2] for i in range(times)) for first in (0, 1))
    return f"({'|'.join(ways)}) {_maybe(*one, *other, *between)}"


_SNEAK_AHEAD = (
    *_AHEAD,
    *_AHEAD_UP,
    *(f"T{tier}_Z/R{s}_X" for tier in ("", "_Y") for s in ("", "_N")),
)
_LEAP_ARC = tuple(f"T{side}{tier}_Z/R_X" for side in _SIDES for tier in _TIERS)
_EVERYWHERE = tuple(f"T{s}{t}{d}" for s in _SIDES for t in _TIERS for d in _DEPTHS if s + t + d)
_FEET_AHEAD = tuple(f"T{side}{tier}_Z/R_N_X" for side in _SIDES for tier in _TIERS)
_FEET_BACK = tuple(f"{move}/R_X" for move in _BACK)
_TURNING_BACK = (*_BACK, *(f"{move}/R_N_X" for move in _BACK))
_LEFTWARD, _RIGHTWARD = (
    tuple(f"T{sign}_X{tier}{depth}" for tier in _TIERS for depth in _DEPTHS) for sign in ("", "_N")
)
_RAISED, _CUT = (
    tuple(f"T{sign}_X{tier}{depth}" for depth in _DEPTHS)
    for sign, tier in (("_N", "_Y"), ("", "_N_Y"))
)
_HOP = f"{_either(*_RISE)} {_either(*_SINK)}"
_NOD = f"{_tilt('')} {_tilt('_N')}"
_ROCK = {sign: _rocking(sign) for sign in ("", "_N")}
_STEP_UP = {
    sign: f"{_maybe(*_ROCK[sign])} {_either(*(f'{move}/R{sign}_Z' for move in _RISE))} "
    f"{_maybe(*_ROCK[sign], *_RISE)}"
    for sign in ("", "_N")
}
_CLIMB = "|".join(f"{_STEP_UP[one]} {_STEP_UP[other]}" for one, other in (("", "_N"), ("_N", "")))

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
        "sneak",
        Pattern.parse(f"{_TIP} {_either(*_SNEAK_AHEAD)} {_TIP_BACK}"),
        travels=True,
        cyclic=True,
        description="Lean the prop forward, glide it ahead, straighten it.",
    ),
    Action(
        "walk_backward",
        Pattern.parse(_either(*_BACK)),
        travels=True,
        cyclic=True,
        description="Glide the prop straight back.",
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
        "spin",
        Pattern.parse(
            f"{_maybe(*_RISE)} {_either(*(f'{m}/R_Y' for m in _RISE))} {_maybe(*_turning(''))} "
            f"{_either(*(f'{m}/R_Y' for m in _SINK))} {_maybe(*_SINK)}"
        ),
        description="Turn the prop once about itself, to the left, while it rises and sinks.",
    ),
    Action(
        "jump",
        Pattern.parse(_JUMP),
        travels=True,
        description="Lift the prop straight up, carry it over, and set it straight down.",
    ),
    Action(
        "leap",
        Pattern.parse(
            f"{_tilt('_N')} {_maybe(*_AHEAD_UP, *_AHEAD)} {_either(*_LEAP_ARC)} "
            f"{_maybe(*_AHEAD_DOWN, *_AHEAD)} {_tilt('_N')}"
        ),
        travels=True,
        description="Tip the prop back, let it follow its nose over an arc, level it out.",
    ),
    Action(
        "hop",
        Pattern.parse(f"{_HOP} ({_HOP})+"),
        cyclic=True,
        description="Hop the prop on the spot, at least twice.",
    ),
    Action(
        "crawl",
        Pattern.parse(f"{_TIP} {_either(*_HEAD_FIRST)} {_TIP_BACK}"),
        travels=True,
        cyclic=True,
        description="Lay the prop on its face, glide it ahead head first, set it up again.",
    ),
    Action(
        "roll",
        Pattern.parse(
            f"{_either(*_AHEAD, *_AHEAD_UP, *_AHEAD_DOWN)} {_tilt('', *_EVERYWHERE)} "
            f"{_either(*_AHEAD, *_AHEAD_UP, *_AHEAD_DOWN)}"
        ),
        travels=True,
        description="Glide the prop ahead, tumble it over its front once round, glide on.",
    ),
    Action(
        "fall",
        Pattern.parse(f"{_tilt('_N', *_BACK)} {_tilt('', *_AHEAD, *_AHEAD_DOWN, *_AHEAD_UP)}"),
        description="Tip the prop over onto its back, and set it up again.",
    ),
    Action(
        "fly",
        Pattern.parse(_FLY),
        travels=True,
        cyclic=True,
        description="Glide the prop ahead while rocking it from wing to wing.",
    ),
    Action(
        "swim",
        Pattern.parse(
            f"{_TIP} {_maybe(*_HEAD_FIRST)} "
            f"{_to_and_fro(_turning('', *_RISE), _turning('_N', *_RISE), 2, *_HEAD_FIRST)} "
            f"{_TIP_BACK}"
        ),
        travels=True,
        cyclic=True,
        description=(
            "Lay the prop on its face, glide it ahead rolling from side to side, set it up again."
        ),
    ),
    Action(
        "climb",
        Pattern.parse(f"({_CLIMB}) {_maybe(*_rocking('', *_RISE), *_rocking('_N', *_RISE))}"),
        cyclic=True,
        description="Lift the prop while rocking it from side to side.",
    ),
    Action(
        "punch",
        Pattern.parse(_PUNCH),
        description="Thrust the prop ahead and take it straight back.",
    ),
    Action(
        "kick",
        Pattern.parse(
            f"{_maybe('R_N_X')} {_either(*_FEET_AHEAD)} {_maybe(*_TURNING_BACK)} "
            f"{_either(*_FEET_BACK)} "
            f"{_maybe('R_X', *_BACK)}"
        ),
        description="Swing the prop's feet ahead and back.",
    ),
    Action(
        "push",
        Pattern.parse(f"{_TIP} {_either(*_AHEAD, *_AHEAD_UP)} {_either(*_BACK_LOW)} {_TIP_BACK}"),
        description="Lean the prop forward, shove it ahead, take it back, straighten it.",
    ),
    Action(
        "slash",
        Pattern.parse(f"{_either(*_RAISED)} {_either(*_CUT)} {_either(*_RAISED)}"),
        description="Lift the prop to its right, cut down across to its left, bring it back.",
    ),
    Action(
        "throw",
        Pattern.parse(_THROW),
        description="Draw the prop back, then fling it ahead in an arc over the top.",
    ),
    Action(
        "pick_up",
        Pattern.parse(f"{_TIP} {_either(*_SINK)} {_either(*_RISE)} {_TIP_BACK}"),
        description="Tip the prop forward, dip it, lift it, set it straight.",
    ),
    Action(
        "bow",
        Pattern.parse(_BOW),
        description="Tip the prop forward and bring it back up.",
    ),
    Action(
        "nod",
        Pattern.parse(f"{_NOD} ({_NOD})+"),
        description="Tip the prop forward and back a little, at least twice.",
    ),
    Action(
        "wave",
        Pattern.parse(_to_and_fro(_rocking(""), _rocking("_N"), 4)),
        description="Rock the prop from side to side on the spot, at least twice.",
    ),
    Action(
        "clap",
        Pattern.parse(_to_and_fro(_LEFTWARD, _RIGHTWARD, 4)),
        description="Shake the prop to its left and right, at least twice.",
    ),
    Action(
        "cheer",
        Pattern.parse(
            f"{_either(*_RISE)} {_to_and_fro(_turning('', 'T_Y'), _turning('_N', 'T_N_Y'), 2)} "
            f"{_either(*_SINK)}"
        ),
        description="Lift the prop, twist it to and fro up there, lower it.",
    ),
    Action(
        "dance",
        Pattern.parse(_to_and_fro(_turning(""), _turning("_N"), 4)),
        cyclic=True,
        description="Twist the prop to and fro on the spot, at least twice.",
    ),
    Action(
        "crouch",
        Pattern.parse(f"{_either(*_SINK)} {_either(*_RISE)}"),
        description="Lower the prop and lift it again.",
    ),
    Action(
        "sit_down",
        Pattern.parse(f"{_either(*_SINK)} {_tilt('_N', *_SINK)} {_tilt('')}"),
        description="Lower the prop, rock it back and upright.",
        rest="idle_sitting",
    ),
    Action(
        "stand_up",
        Pattern.parse(f"{_tilt('')} {_tilt('_N', *_RISE)} {_either(*_RISE)}"),
        description="Rock the prop forward and upright, lift it.",
    ),
    Action(
        "gallop_left",
        None,
        travels=True,
        cyclic=True,
        description="Not drawn: a side-step to the left that is in a hurry.",
    ),
    Action(
        "gallop_right",
        None,
        travels=True,
        cyclic=True,
        description="Not drawn: a side-step to the right that is in a hurry.",
    ),
    Action(
        "run_backward",
        None,
        travels=True,
        cyclic=True,
        description="Not drawn: a walk backward that is in a hurry.",
    ),
    Action(IDLE, None, cyclic=True),
    Action("idle_sitting", None, cyclic=True, rest="idle_sitting"),
)
"""What the shipped humanoid can do; `IDLE` and a few others nobody draws."""
