"""The one place where the stages meet: from a recording to a Score to a performance."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, HEADSETS
from smd.errors import DoodleError, ScoreError

if TYPE_CHECKING:
    from laban import EffortModel, RigidMotion
    from smd.acting.performance import Performance
    from smd.acting.terrain import Terrain
    from smd.cast import ActionLibrary, Cast
    from smd.doodle import Doodle, Recording
    from smd.recognition.detection import Detection
    from smd.recognition.recognizer import Recognizer
    from smd.recognition.suggestions import Understood
    from smd.score import Phrase, Score, Suggestion

UNEXPLAINED = ("leave", "follow")
"""What is made of travel in which nothing is recognised."""


def parse(
    recording: Recording,
    library: ActionLibrary | Cast,
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
    devices: Collection[str] | None = None,
    tolerance: float = 1.0,
    intent: str | None = None,
    unexplained: str = "leave",
) -> Score:
    """Recognise the actions in a recording and read the Effort of each.

    Parameters
    ----------
    recording
        What was drawn.
    library
        The actions to recognise; their clips are not read. In a `Cast`, each device's own.
    figure_height_m
        Height of the figurine that the prop stands for, positive.
    devices
        Those that perform; by default all but headsets (or the headset, where it is alone).
    tolerance
        How unlike an action's examples a gesture may be, positive: below 1 more is rejected,
        above it less (docs/sessions.md has figures).
    intent
        Whether movement was meant: "drawn", where a trigger was held, or "free", where nothing
        says so. By default a doodle that says when the user drew was drawn, and any other is free.
    unexplained
        What to make of travel in which nothing is recognised: "leave" it, or "follow" it, with
        phrases in the gait that suits, marked as implied; clips of gaits are then read.

    Returns
    -------
    Score
        A part for each device, in the recording's order; a part may be empty. What no phrase
        explains, and is like an action, is among its suggestions.

    Raises
    ------
    ScoreError
        If the figure height is not positive, ``intent`` or ``unexplained`` is neither, or a device
        is not in the recording.
    LibraryError
        If a cast has a library for a device that is not in the recording.
    """
    from laban import load_effort_model
    from smd.cast import cast_of
    from smd.following import going_along
    from smd.recognition.acceptance import Intent
    from smd.recognition.recognizers import recognizer_of
    from smd.score import INTENTS, Part, Score

    if unexplained not in UNEXPLAINED:
        raise ScoreError(f"unexplained: expected {' or '.join(UNEXPLAINED)}, got {unexplained!r}")
    if intent not in (None, *INTENTS):
        raise ScoreError(f"intent: expected {' or '.join(INTENTS)}, got {intent!r}")
    empty = Score((), recording.source, figure_height_m=figure_height_m)
    cast = cast_of(library)
    cast.check(recording.devices)
    model = load_effort_model()
    parts, warnings = [], list(_without_examples(cast))
    for device in _performing(recording, devices):
        own = cast.of(device)
        recognizer = recognizer_of(
            own,
            figure_height_m=figure_height_m,
            tolerance=tolerance,
            intent=None if intent is None else Intent(intent),
        )
        understood: list[Understood] = []
        for doodle in recording.of(device):
            try:
                understood.append(_understood(doodle, recognizer))
            except DoodleError as error:
                warnings.append(f"left out: {error}")
        played = [
            (span, one.motion.between(span.start_s, span.end_s))
            for one in understood
            for span in one.spans
        ]
        phrases = tuple(_phrases(played, model))
        if unexplained == "follow":
            phrases = going_along(
                phrases,
                [one.motion for one in understood],
                own,
                figure_height_m=figure_height_m,
            )
        suggested = tuple(_suggestions(understood, recognizer, own, figure_height_m))
        meant = Intent.DRAWN in [one.intent for one in understood]
        said = str(Intent.DRAWN if meant else Intent.FREE)
        parts.append(Part(device, phrases, intent=said, suggestions=suggested))
        warnings.extend(_lost_tracking(recording, device))
    if not devices:
        warnings.extend(_never_tracked(recording))
    return replace(empty, performers=tuple(parts), warnings=tuple(warnings))


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
    from smd.recognition.suggestions import Understood
    from smd.smoothing import smooth

    motion = smooth(doodle)
    runs = recognizer.runs_of(doodle, motion)
    intent = recognizer.intent_of(doodle)
    return Understood(motion, runs, recognizer.spot_runs(motion, runs, intent), intent)


def _suggestions(
    understood: Sequence[Understood],
    recognizer: Recognizer,
    library: ActionLibrary,
    figure_height_m: float,
) -> Iterator[Suggestion]:
    """Yield what a performer did that nothing explains; times to the millisecond, as phrases'."""
    from smd.recognition.suggestions import suggestions
    from smd.score import Alternative, Suggestion

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
    from laban import read_effort
    from smd.score import Alternative, Phrase

    for span, motion in played:
        yield Phrase(
            action=span.action,
            start_s=round(span.start_s, 3),
            end_s=round(span.end_s, 3),
            effort=read_effort(motion, model),
            confidence=span.confidence,
            alternatives=tuple(Alternative(*other) for other in span.alternatives),
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


def animate(
    score: Score,
    recording: Recording,
    library: ActionLibrary | Cast,
    *,
    rate_hz: float = 24.0,
    expressiveness: float = 1.0,
    heading: str = "prop",
    ground: Terrain | Path | str | None = None,
) -> Performance:
    """Act out a Score: each device a character, each phrase an action on the doodle's path.

    Parameters
    ----------
    score
        Who does what, when and how.
    recording
        The doodles that the Score was read from.
    library
        The character and its clips; in a `Cast`, each device's own.
    rate_hz
        Frames per second. At 24, what Blender's importer leaves its scene at, a file plays at its
        true speed there.
    expressiveness
        How much of the Score's Effort is played, from 0 (neutral clips) to 2.
    heading
        What characters face by: "prop", where the prop faces, or "path", where it goes.
    ground
        What they go on: a USD file of meshes, or a terrain; by default the level ground.

    Raises
    ------
    ScoreError
        If the Score names an action, a device or a time that is not there.
    LibraryError
        If a cast has a library for a device that is not in the recording.
    ImportedFileError
        If ``ground`` is no USD file, or holds no mesh.
    TransferError
        If it cannot be acted out, or there is no ground, or more than one, below a way.
    """
    from actions_library.importers.usd_ground import read_terrain
    from smd.transfer.perform import perform

    return perform(
        score,
        recording,
        library,
        rate_hz=rate_hz,
        expressiveness=expressiveness,
        heading=heading,
        terrain=read_terrain(ground) if isinstance(ground, str | Path) else ground,
    )
