"""Score: who does what, when and how; its types.

Their JSON form is in `smd.score_file`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from laban import Effort
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.errors import ScoreError


@dataclass(frozen=True, slots=True)
class Alternative:
    """An action that was not chosen, and its distance to the tokens of the span."""

    action: str
    distance: float


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
    """

    action: str
    start_s: float
    end_s: float
    effort: Effort = Effort()
    confidence: float = 1.0
    alternatives: tuple[Alternative, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.start_s) and math.isfinite(self.end_s)):
            raise ScoreError(f"phrase {self.action!r}: expected finite times")
        if self.end_s <= self.start_s:
            raise ScoreError(
                f"phrase {self.action!r} at {self.start_s:g} s: expected its end after its start, "
                f"got {self.end_s:g} s"
            )
        if not 0.0 <= self.confidence <= 1.0:
            raise ScoreError(
                f"phrase {self.action!r} at {self.start_s:g} s: expected a confidence in [0, 1], "
                f"got {self.confidence!r}"
            )


@dataclass(frozen=True, slots=True)
class Part:
    """What one device performs.

    Attributes
    ----------
    device : whose doodles they are.
    phrases : in time order, not overlapping.
    library : where its performer's own library is; empty for the Score's.
    """

    device: str
    phrases: tuple[Phrase, ...] = ()
    library: str = ""

    def __post_init__(self) -> None:
        for before, after in zip(self.phrases, self.phrases[1:], strict=False):
            if after.start_s < before.end_s - 1e-9:
                raise ScoreError(
                    f"device {self.device!r}: phrase {after.action!r} at {after.start_s:g} s "
                    f"starts before {before.action!r} ends at {before.end_s:g} s"
                )


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
