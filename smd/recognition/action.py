"""Action: something a character can do, and the gesture that asks for it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from smd.recognition.pattern import Pattern

if TYPE_CHECKING:
    from smd.recognition.exemplar import Exemplar


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
    learned_from : the recordings or other examples that somebody gave, by name; none of a shipped
        action.
    rest : name of the action whose clip is idled in after it: who has sat down sits. The
        library's idling where empty.
    exemplar : what verification remembers of examples; None where there were none. Arrays have no
        single truth value, so equality leaves it out.
    """

    name: str
    pattern: Pattern | None
    travels: bool = False
    cyclic: bool = False
    description: str = ""
    learned_from: tuple[str, ...] = ()
    rest: str = ""
    exemplar: Exemplar | None = field(default=None, compare=False, repr=False)
