"""What a plan changed, for people: as JSON, in a line, and where a limit is broken all the same."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence

from smd.transfer.plan import Plan, Planned

HURRIED = 1.1
"""Time that a phrase asks for over the time it has, from which it is hurried."""

WARNED = 1.5
"""The same from which there is a warning: it pushes a body twice as hard as it should."""

_DECIMALS = 3


def hurried(plans: Sequence[Plan]) -> float:
    """Return the share of phrases that have less time than they need."""
    phrases = [one for plan in plans for one in plan.phrases]
    return sum(one.hurry > HURRIED for one in phrases) / max(len(phrases), 1)


def unmet(device: str, plan: Plan) -> Iterator[str]:
    """Yield a line for each action that has too little time even as planned, in order."""
    short: dict[str, list[Planned]] = {}
    for one in plan.phrases:
        if one.hurry > WARNED:
            short.setdefault(one.drawn.action, []).append(one)
    for action, found in short.items():
        first, worst = found[0], max(found, key=lambda one: one.hurry)
        lasting_s = worst.end_s - worst.start_s
        more = f" (the most of {len(found)} phrases)" if len(found) > 1 else ""
        yield (
            f"device {device!r}: {action} at {first.start_s:.2f} s: a body needs "
            f"{worst.hurry * lasting_s:.1f} s for it, and has {lasting_s:.1f} s with the pauses "
            f"beside it{more}; --stretch auto makes the whole take slower"
        )


def plan_to_json(plans: Mapping[str, Plan], *, timing: str, stretch: float) -> str:
    """Return what was planned for each performer, as JSON text, a phrase a line."""
    head = [f'  "timing": {json.dumps(timing)},', f'  "stretch": {stretch:g},']
    parts = [
        f'    {{"device": {json.dumps(device)}, "phrases": ['
        + "".join(f"\n      {json.dumps(_changes(one))}," for one in plan.phrases).rstrip(",")
        + ("\n    ]}" if plan.phrases else "]}")
        for device, plan in plans.items()
    ]
    return "\n".join(["{", *head, '  "performers": [', ",\n".join(parts), "  ]", "}", ""])


def _changes(one: Planned) -> dict[str, object]:
    found: dict[str, object] = {
        "action": one.drawn.action,
        "drawn_s": [round(one.drawn.start_s, _DECIMALS), round(one.drawn.end_s, _DECIMALS)],
        "played_s": [round(one.start_s, _DECIMALS), round(one.end_s, _DECIMALS)],
    }
    if one.strike_moved_s is not None:
        found["strike_later_s"] = round(one.strike_moved_s, _DECIMALS)
    if one.action != one.drawn.action:
        found["played_with"] = one.action
    if one.hurry > 1.0:
        found["asks_for"] = round(one.hurry, _DECIMALS)
    return found


def plan_summary(text: str) -> str | None:
    """Return a line about a plan, given as JSON; None where everything is played as drawn.

    Parameters
    ----------
    text
        From `plan_to_json`.
    """
    plan = json.loads(text)
    phrases = [one for part in plan["performers"] for one in part["phrases"]]
    parts = []
    if plan["stretch"] != 1.0:
        parts.append(f"{plan['stretch']:g} times as long as the recording")
    moved = [one for one in phrases if _moved_s(one) > 0.5 * 10.0**-_DECIMALS]
    if moved and plan["timing"] != "drawn":
        most = max(max(_moved_s(one) for one in moved), 0.0)
        parts.append(f"{len(moved)} of {len(phrases)} phrases moved, by up to {most:.2f} s")
    struck = [abs(one["strike_later_s"]) for one in phrases if "strike_later_s" in one]
    if moved and struck and plan["timing"] != "drawn":
        parts.append(f"strikes by up to {max(struck):.2f} s")
    gaits = [one for one in phrases if "played_with" in one]
    if gaits:
        names = dict.fromkeys(f"{one['action']} as {one['played_with']}" for one in gaits)
        parts.append(", ".join(names))
    return f"plan: {'; '.join(parts)}" if parts else None


def _moved_s(one: Mapping[str, Sequence[float]]) -> float:
    pairs = zip(one["drawn_s"], one["played_s"], strict=True)
    return max(abs(played - drawn) for drawn, played in pairs)
