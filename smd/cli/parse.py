"""``smd parse``: what was recognised, as a table, as a Score, as JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import reading
from smd.cli.batch import for_each, targets
from smd.cli.next_steps import next_steps

if TYPE_CHECKING:
    from laban import Effort
    from smd.score import Score, Suggestion


def parse(
    recordings: reading.Recordings,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write the Score here; a folder for several."),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the Score as JSON and nothing else.")
    ] = False,
    explain: Annotated[
        bool, typer.Option("--explain", help="Print what each phrase was weighed by.")
    ] = False,
    library: reading.Libraries = None,
    figure_height: reading.FigureHeight = reading.FIGURE_HEIGHT_M,
    tolerance: reading.Tolerance = 1.0,
    intent: reading.Intent = None,
    unexplained: reading.Unexplained = reading.UnexplainedName.LEAVE,
    device: reading.Device = None,
    up: reading.Up = None,
    front: reading.Front = None,
    handedness: reading.Handedness = None,
    unit: reading.Unit = None,
    quaternion: reading.Quaternion = None,
    mount: reading.Mount = None,
) -> None:
    """Recognise actions and their Effort.

    They are printed, or written as a Score that can be corrected by hand.
    """
    from smd.score_file import score_to_json, write_score

    files = list(reading.recording_files(recordings))
    outputs = targets(recordings, files, output, reading.SCORE_SUFFIX) if output else []
    options = reading.ReadingOptions(up, front, handedness, unit, quaternion, mount)
    folders = reading.LibraryFolders.from_options(library)
    cast = folders.load()
    understood = reading.understanding(
        options,
        cast,
        folders,
        figure_height_m=figure_height,
        devices=device,
        tolerance=tolerance,
        intent=intent,
        unexplained=unexplained,
    )
    scores: list[Score] = []

    def one(index: int, file: Path) -> None:
        recording, score = understood(file)
        scores.append(score)
        if outputs:
            write_score(reading.beside(score, outputs[index]), outputs[index])
        if not as_json:
            typer.echo(f"{file}: {reading.summary(recording, score)}")
            typer.echo("\n".join(table(score)))
            if explain:
                from smd.cli.explain import explanation

                typer.echo("\n".join(explanation(score, recording, cast)))
            for line in next_steps(
                file, recording, score, cast, options=options, tolerance=tolerance
            ):
                typer.echo(f"  {line}")
            if outputs:
                typer.echo(f"written: {outputs[index]}")

    try:
        for_each(files, one)
    finally:
        if as_json and len(files) == 1 and scores:
            typer.echo(score_to_json(scores[0]), nl=False)
        elif as_json and len(files) > 1:
            typer.echo(json.dumps([json.loads(score_to_json(score)) for score in scores]))


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
