"""A Score as lines on a terminal: in one, or a phrase a line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from smd.cli.wording import count

if TYPE_CHECKING:
    from laban import Effort
    from smd.doodle import Recording
    from smd.score import Score, Suggestion


def summary(recording: Recording, score: Score) -> str:
    """Return in one line what was read and understood."""
    start_s = min(doodle.time_s[0] for doodle in recording.doodles)
    end_s = max(doodle.time_s[-1] for doodle in recording.doodles)
    devices = ", ".join(part.device for part in score.performers)
    parts = [f"{end_s - start_s:.1f} s, {devices}"]
    implied = [phrase.implied for part in score.performers for phrase in part.phrases]
    parts.append(count(implied.count(False), "phrase"))
    if any(implied):
        parts.append(f"{implied.count(True)} implied")
    if recording.dropouts:
        split = sum(not dropout.bridged for dropout in recording.dropouts)
        parts.append(f"{count(len(recording.dropouts), 'dropout')} ({split} over 0.25 s)")
    return ", ".join(parts)


def table(score: Score, *, others: int = 0) -> list[str]:
    """Return a Score as lines of a table, one phrase a line, with so many alternatives to each.

    Suggestions follow a performer's phrases, a line each as well.
    """
    lines = []
    for part in score.performers:
        recognised = not all(phrase.implied for phrase in part.phrases)
        lines.append(f"  {part.device}" + ("" if recognised else ": nothing recognised"))
        for phrase in part.phrases:
            if phrase.implied:
                times = f"{phrase.start_s:8.2f} – {phrase.end_s:7.2f} s"
                lines.append(f"    {times}  {phrase.action:<16} implied")
                continue
            line = row(
                phrase.start_s, phrase.end_s, phrase.action, phrase.confidence, phrase.effort
            )
            names = ", ".join(other.action for other in phrase.alternatives[:others])
            lines.append(f"    {line}" + (f"  or {names}" if names else ""))
        lines.extend(f"    {suggested(suggestion)}" for suggestion in part.suggestions)
    lines.extend(f"  {line}" for line in score.warnings)
    return lines


def row(start_s: float, end_s: float, action: str, confidence: float, effort: Effort) -> str:
    """Return one phrase as a line."""
    from laban import AXES

    efforts = " ".join(
        f"{axis} {value:+.2f}" for axis in AXES if (value := getattr(effort, axis)) is not None
    )
    return (
        f"{start_s:8.2f} – {end_s:7.2f} s  {action:<16} confidence {confidence:.2f}  {efforts}"
    ).rstrip()


def suggested(suggestion: Suggestion) -> str:
    """Return what was not recognised as a line: what it is most like, and what kept that out."""
    best, *others = suggestion.likeliest
    line = f"{suggestion.start_s:8.2f} – {suggestion.end_s:7.2f} s  {best.action + '?':<16} "
    line += best.reason or "not recognised"
    names = ", ".join(other.action for other in others)
    return line + (f"; or {names}" if names else "")
