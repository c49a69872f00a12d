"""Action: something a character can do, and the gesture that asks for it."""

from __future__ import annotations

from dataclasses import dataclass

from smd.recognition.pattern import Pattern


@dataclass(frozen=True, slots=True)
class Action:
    """Something a character can do, and the gesture that asks for it.

    Attributes
    ----------
    name : unique in its library, a lower-case word.
    pattern : the tokens that draw it; None for an action nobody draws (idle).
    travels : moves along the doodle's path, or acts in place.
    cyclic : its clip repeats, once per distance travelled where it travels.
    description : what the gesture of the prop looks like, in one sentence.
    """

    name: str
    pattern: Pattern | None
    travels: bool = False
    cyclic: bool = False
    description: str = ""
