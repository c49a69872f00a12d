"""Score: who does what, when and how; its types.

Their JSON form is in `smd.score_file`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from laban import Effort
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.errors import ScoreError

INTENTS = ("drawn", "free")
"""What a performer's movement was taken for: meant as gestures, stroke by stroke, or perhaps."""


@dataclass(frozen=True, slots=True)
class Alternative:
    """An action that was not chosen.

    Attributes
    ----------
    action : name in the library.
    distance : what it costs to see the movement so; finite.
    most : what it might have cost to be recognised; None where that is not known.
    reason : what kept it out, in a few words; empty where another action was chosen.
    """

    action: str
    distance: float
    most: float | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Phrase:
    """One action, from ``start_s`` to ``end_s`` on the recording's clock.

    Attributes
    ----------
    action : name in the library.
    start_s, end_s : finite, end after start.
    effort : what was read of the movement; axes may be absent.
    confidence : in [0, 1].
    alternatives : other actions, nearest first.
    implied : nothing was recognised there; the character goes along with the prop.
    """

    action: str
    start_s: float
    end_s: float
    effort: Effort = Effort()
    confidence: float = 1.0
    alternatives: tuple[Alternative, ...] = ()
    implied: bool = False

    def __post_init__(self) -> None:
        _check_times(f"phrase {self.action!r}", self.start_s, self.end_s)
        if not 0.0 <= self.confidence <= 1.0:
            raise ScoreError(
                f"phrase {self.action!r} at {self.start_s:g} s: expected a confidence in [0, 1], "
                f"got {self.confidence!r}"
            )


@dataclass(frozen=True, slots=True)
class Suggestion:
    """Movement that no phrase explains, and what it is most like.

    Attributes
    ----------
    start_s, end_s : finite, end after start.
    likeliest : at least one action, the likeliest first, each with what kept it out.
    """

    start_s: float
    end_s: float
    likeliest: tuple[Alternative, ...]

    def __post_init__(self) -> None:
        _check_times("suggestion", self.start_s, self.end_s)
        if not self.likeliest:
            raise ScoreError(f"suggestion at {self.start_s:g} s: expected an action, got none")

    @property
    def action(self) -> str:
        """The likeliest action."""
        return self.likeliest[0].action

    def accepted(self) -> Phrase:
        """Return the phrase that says that it is the likeliest action."""
        return Phrase(self.action, self.start_s, self.end_s, alternatives=self.likeliest)


def _check_times(what: str, start_s: float, end_s: float) -> None:
    if not (math.isfinite(start_s) and math.isfinite(end_s)):
        raise ScoreError(f"{what}: expected finite times")
    if end_s <= start_s:
        raise ScoreError(
            f"{what} at {start_s:g} s: expected its end after its start, got {end_s:g} s"
        )


@dataclass(frozen=True, slots=True)
class Part:
    """What one device performs.

    Attributes
    ----------
    device : whose doodles they are.
    phrases : in time order, not overlapping.
    library : where its performer's own library is; empty for the Score's.
    intent : what its movement was taken for, one of `INTENTS`; empty where that is not known.
    suggestions : movement that no phrase explains, in time order; they overlap neither each other
        nor any phrase but implied ones.
    """

    device: str
    phrases: tuple[Phrase, ...] = ()
    library: str = ""
    intent: str = ""
    suggestions: tuple[Suggestion, ...] = ()

    def __post_init__(self) -> None:
        if self.intent not in ("", *INTENTS):
            raise ScoreError(
                f"device {self.device!r}: intent: expected {' or '.join(INTENTS)}, "
                f"got {self.intent!r}"
            )
        for before, after in zip(self.phrases, self.phrases[1:], strict=False):
            if after.start_s < before.end_s - 1e-9:
                raise ScoreError(
                    f"device {self.device!r}: phrase {after.action!r} at {after.start_s:g} s "
                    f"starts before {before.action!r} ends at {before.end_s:g} s"
                )
        self._check_suggestions()

    def _check_suggestions(self) -> None:
        """Raise ScoreError unless suggestions lie one after the other, outside of phrases."""
        for earlier, later in zip(self.suggestions, self.suggestions[1:], strict=False):
            if later.start_s < earlier.end_s - 1e-9:
                raise ScoreError(
                    f"device {self.device!r}: suggestion at {later.start_s:g} s starts before the "
                    f"one before it ends at {earlier.end_s:g} s"
                )
        for suggestion in self.suggestions:
            held = next((phrase for phrase in self.phrases if _is_about(suggestion, phrase)), None)
            if held:
                raise ScoreError(
                    f"device {self.device!r}: suggestion at {suggestion.start_s:g} s overlaps the "
                    f"phrase {held.action!r} at {held.start_s:g} s"
                )


def _is_about(suggestion: Suggestion, phrase: Phrase) -> bool:
    """Tell whether a suggestion is about movement that a phrase, not implied, explains."""
    together_s = min(suggestion.end_s, phrase.end_s) - max(suggestion.start_s, phrase.start_s)
    return together_s > 1e-9 and not phrase.implied


@dataclass(frozen=True, slots=True)
class Score:
    """What is performed in one recording.

    Attributes
    ----------
    performers : one part per device, device names unique.
    recording : where the recording is, as the user named it.
    library : where the library is; empty for the shipped one.
    figure_height_m : height of the figurine the prop stands for; the stage's scale is the
        character's height over it.
    reading : what was asked of the reader besides the defaults (up, front, mount …), so that
        the recording can be read again the same way.
    warnings : what a person should know before trusting it.
    """

    performers: tuple[Part, ...]
    recording: str = ""
    library: str = ""
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M
    reading: tuple[tuple[str, str], ...] = ()
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        devices = [part.device for part in self.performers]
        for device in devices:
            if devices.count(device) > 1:
                raise ScoreError(f"performers: device {device!r} appears twice")
        if not (math.isfinite(self.figure_height_m) and self.figure_height_m > 0):
            raise ScoreError(
                f"figure_height_m: expected a positive number, got {self.figure_height_m!r}"
            )

    @property
    def suggestions(self) -> tuple[tuple[str, Suggestion], ...]:
        """What no phrase explains, with the device that did it: performer by performer."""
        return tuple((part.device, one) for part in self.performers for one in part.suggestions)
