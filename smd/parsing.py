"""Parsing: recordings in, Scores out."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

from laban import EffortModel, RigidMotion, load_effort_model, read_effort
from smd.cast import ActionLibrary, Cast, cast_of
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, HEADSETS, Doodle, Recording
from smd.errors import DoodleError, ScoreError
from smd.following import Pace, going_along, paces
from smd.recognition.acceptance import Intent
from smd.recognition.detection import Detection
from smd.recognition.recognizer import Recognizer
from smd.recognition.recognizers import recognizer_of
from smd.recognition.suggestions import Understood, suggestions
from smd.score import INTENTS, Alternative, Part, Phrase, Score, Suggestion
from smd.smoothing import smooth

UNEXPLAINED = ("leave", "follow")
"""What is made of travel in which nothing is recognised."""


@dataclass(frozen=True, eq=False)
class Parser:
    """Recognises the actions in recordings, and reads the Effort of each.

    It is made once, which compiles the libraries, and parses any number of recordings. It pickles
    as what it was made of: a few hundred bytes with the shipped library, the examples of its
    actions with another one. Another process compiles the shipped library once; another library,
    each time that a parser arrives. So give a pool's processes the parser once, as they start.

    Attributes
    ----------
    library : the actions to recognise. In a `Cast`, each device's own; where these explain nothing,
        those of the shared library that its own lacks, since who draws may know them all.
    figure_height_m : height of the figurine that the prop stands for, positive.
    devices : those that perform; by default all but headsets (or the headset, where it is alone).
    tolerance : how unlike an action's examples a gesture may be, positive: below 1 more is
        rejected, above it less (docs/sessions.md has figures).
    intent : whether movement was meant: "drawn", where a trigger was held, or "free", where nothing
        says so. By default a doodle that says when the user drew was drawn, and any other is free.
    unexplained : what to make of travel in which nothing is recognised: "leave" it, or "follow"
        it, with phrases in the gait that suits, marked as implied; clips of gaits are then read.

    Raises
    ------
    ScoreError
        If the figure height or ``tolerance`` is not positive, or ``intent`` or ``unexplained`` is
        neither.
    """

    library: ActionLibrary | Cast
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M
    devices: Collection[str] | None = None
    tolerance: float = 1.0
    intent: str | None = None
    unexplained: str = "leave"
    _cast: Cast = field(init=False, repr=False)
    _recognizers: dict[ActionLibrary, Recognizer] = field(init=False, repr=False)
    _paces: dict[ActionLibrary, tuple[Pace, ...]] = field(init=False, repr=False)
    _model: EffortModel = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.unexplained not in UNEXPLAINED:
            raise ScoreError(
                f"unexplained: expected {' or '.join(UNEXPLAINED)}, got {self.unexplained!r}"
            )
        if self.intent not in (None, *INTENTS):
            raise ScoreError(f"intent: expected {' or '.join(INTENTS)}, got {self.intent!r}")
        if not (math.isfinite(self.tolerance) and self.tolerance > 0.0):
            raise ScoreError(f"tolerance: expected a positive number, got {self.tolerance!r}")
        Score((), figure_height_m=self.figure_height_m)  # raises unless it is positive
        cast = cast_of(self.library)
        libraries = dict.fromkeys((cast.shared, *cast.own.values()))
        follows = self.unexplained == "follow"
        if isinstance(self.devices, str):
            raise ScoreError(f"devices: expected a list of names, got {self.devices!r} alone")
        if self.devices is not None:
            object.__setattr__(self, "devices", tuple(self.devices))
        object.__setattr__(self, "_cast", cast)
        object.__setattr__(self, "_recognizers", {one: self._compiled(one) for one in libraries})
        object.__setattr__(self, "_paces", {one: paces(one) for one in libraries if follows})
        object.__setattr__(self, "_model", load_effort_model())

    def __reduce__(self) -> tuple[Any, ...]:
        made_of = (getattr(self, one.name) for one in fields(self) if one.init)
        return Parser, tuple(made_of)

    def _compiled(self, library: ActionLibrary) -> Recognizer:
        return recognizer_of(
            library,
            figure_height_m=self.figure_height_m,
            tolerance=self.tolerance,
            intent=None if self.intent is None else Intent(self.intent),
        )

    def parse(self, recording: Recording) -> Score:
        """Return what is performed in a recording.

        Returns
        -------
        Score
            A part for each device, in the recording's order; a part may be empty. What no phrase
            explains, and is like an action, is among its suggestions.

        Raises
        ------
        ScoreError
            If a device is not in the recording.
        LibraryError
            If a cast has a library for a device that is not in the recording.
        """
        self._cast.check(recording.devices)
        parts, warnings = [], list(_without_examples(self._cast))
        for device in _performing(recording, self.devices):
            part, left_out = self._part(recording, device)
            parts.append(part)
            warnings += [*left_out, *_lost_tracking(recording, device)]
        if not self.devices:
            warnings.extend(_never_tracked(recording))
        return Score(
            tuple(parts),
            recording.source,
            figure_height_m=self.figure_height_m,
            warnings=tuple(warnings),
        )

    def _part(self, recording: Recording, device: str) -> tuple[Part, list[str]]:
        """Return what one device performs, and what was left out of it."""
        library = self._cast.of(device)
        recognizer = self._recognizers[library]
        understood: list[Understood] = []
        left_out = []
        for doodle in recording.of(device):
            try:
                one = _understood(doodle, recognizer)
                if library is not self._cast.shared:
                    shared = self._recognizers[self._cast.shared]
                    one = _with_lacking(one, _understood(doodle, shared), library)
                understood.append(one)
            except DoodleError as error:
                left_out.append(f"left out: {error}")
        played = [
            (detection, one.motion.between(detection.start_s, detection.end_s))
            for one in understood
            for detection in one.detections
        ]
        phrases = going_along(
            tuple(_phrases(played, self._model)),
            [one.motion for one in understood],
            self._paces.get(library, ()),
            figure_height_m=self.figure_height_m,
        )
        suggested = tuple(_suggestions(understood, recognizer, library, self.figure_height_m))
        meant = Intent.DRAWN in [one.intent for one in understood]
        said = str(Intent.DRAWN if meant else Intent.FREE)
        return Part(device, phrases, intent=said, suggestions=suggested), left_out


def _performing(recording: Recording, devices: Collection[str] | None) -> tuple[str, ...]:
    """Return the devices that perform, in the recording's order."""
    known = recording.devices
    for device in devices or ():
        if device not in known:
            raise ScoreError(
                f"{recording.source or 'recording'}: expected a device of {', '.join(known)}, "
                f"got {device!r}"
            )
    if devices:
        return tuple(device for device in known if device in devices)
    played = tuple(device for device in known if device.lower() not in HEADSETS)
    return played or known


def _understood(doodle: Doodle, recognizer: Recognizer) -> Understood:
    """Return one doodle's motion, tokens and actions."""
    motion = smooth(doodle)
    runs = recognizer.runs_of(doodle, motion)
    intent = recognizer.intent_of(doodle)
    return Understood(motion, runs, recognizer.spot_runs(motion, runs, intent), intent)


def _with_lacking(own: Understood, shared: Understood, library: ActionLibrary) -> Understood:
    """Return what a library explains of a doodle, and in between what another one does.

    Of the other one's actions, only those that the library lacks.
    """
    has = {action.name for action in library.actions}
    more = [
        one
        for one in shared.detections
        if one.action not in has
        and not any(
            one.start_s < other.end_s and other.start_s < one.end_s for other in own.detections
        )
    ]
    found = sorted([*own.detections, *more], key=lambda one: one.start_s)
    return replace(own, detections=tuple(found))


def _suggestions(
    understood: Sequence[Understood],
    recognizer: Recognizer,
    library: ActionLibrary,
    figure_height_m: float,
) -> Iterator[Suggestion]:
    """Yield what a performer did that nothing explains; times to the millisecond, as phrases'."""
    for one in suggestions(
        recognizer, library.actions, understood, figure_height_m=figure_height_m
    ):
        yield Suggestion(
            round(one.start_s, 3),
            round(one.end_s, 3),
            tuple(Alternative(c.action, c.cost, c.most, c.reason) for c in one.likeliest),
        )


def _without_examples(cast: Cast) -> Iterator[str]:
    """Yield a line where a library can only be recognised the old way, by tokens alone."""
    libraries = (cast.shared, *cast.own.values())
    if any(not any(action.exemplar for action in library.actions) for library in libraries):
        yield (
            "library: no action has examples, so gestures are told by their tokens alone; "
            "smd teach and smd learn add some"
        )


def _phrases(
    played: Sequence[tuple[Detection, RigidMotion]], model: EffortModel
) -> Iterator[Phrase]:
    """Yield what one performer says; times to the millisecond, as a Score's file keeps them.

    Each phrase's Effort is read of the phrase alone, as it is while somebody plays: what else they
    play is what they mean as well as how they move anyway.
    """
    for detection, motion in played:
        yield Phrase(
            action=detection.action,
            start_s=round(detection.start_s, 3),
            end_s=round(detection.end_s, 3),
            effort=read_effort(motion, model),
            confidence=detection.confidence,
            alternatives=tuple(Alternative(*other) for other in detection.alternatives),
        )


def _lost_tracking(recording: Recording, device: str) -> Iterator[str]:
    """Yield a line on where a device was lost, if it was."""
    lost = [dropout for dropout in recording.dropouts if dropout.device == device]
    if lost:
        longest = max(lost, key=lambda dropout: dropout.end_s - dropout.start_s)
        times = "once" if len(lost) == 1 else f"{len(lost)} times"
        splits = sum(not dropout.bridged for dropout in lost)
        yield (
            f"device {device!r}: tracking was lost {times} ({splits} split the doodle); longest "
            f"{longest.end_s - longest.start_s:.2f} s at {longest.start_s:.2f} s"
        )


def _never_tracked(recording: Recording) -> Iterator[str]:
    """Yield a line on each device of which nothing is left."""
    for device in dict.fromkeys(dropout.device for dropout in recording.dropouts):
        if device not in recording.devices:
            yield f"device {device!r}: left out: it was never tracked for 0.1 s"
