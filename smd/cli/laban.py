"""``smd laban``: read Laban Effort, and learn to read it."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from smd.cli import places
from smd.cli.batch import for_each
from smd.cli.option_groups import unfolded
from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from smd.effort import ManifestRow

app = typer.Typer(no_args_is_help=True)

Model = Annotated[
    Path | None, typer.Option("--model", help="A trained model. Default: the shipped one.")
]


@app.callback()
def _laban() -> None:
    pass


@app.command()
@unfolded
def classify(
    recordings: places.Recordings,
    *,
    model: Model = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list and nothing else.")
    ] = False,
    performer: Annotated[
        list[Path] | None,
        typer.Option(
            help="A take of the same performer, or a folder of them; what was meant by them need "
            "not be known. Efforts are then read against how this person moves. Repeatable.",
        ),
    ] = None,
    reading: ReadingOptions,
) -> None:
    """Read the Effort of recordings, movement by movement: a rest of 0.4 s parts two."""
    from laban import AXES, load_effort_model
    from laban.model import confidence
    from smd.effort import performers_measure, recording_efforts

    reader = load_effort_model(model)
    files = list(places.recording_files(recordings))
    rows: list[dict[str, Any]] = []
    own = None
    if performer:
        takes = places.recording_files(performer)
        own = performers_measure(reading.read(take) for take in takes)

    def one(_: int, file: Path) -> None:
        for read in recording_efforts(reading.read(file), reader, own):
            device, state = read.device, read.state
            values = {axis: getattr(read.effort, axis) for axis in AXES}
            known = {axis: round(v, 3) for axis, v in values.items() if v is not None}
            start_s, end_s = round(read.start_s, 3), round(read.end_s, 3)
            rows.append(
                {
                    "file": str(file),
                    "device": device,
                    "start_s": start_s,
                    "end_s": end_s,
                    "effort": known,
                    "confidence": {axis: round(confidence(v), 3) for axis, v in known.items()},
                }
            )
            if state is not None:
                time, weight, chance = state
                rows[-1]["state"] = {"time": time, "weight": weight, "confidence": round(chance, 3)}
            if not as_json:
                shown = "  ".join(f"{axis} {value:+.2f}" for axis, value in known.items())
                if state is not None:
                    shown += f"  {state[0]} and {state[1]} ({state[2]:.2f})"
                where = f"{file}  {device} {start_s:.2f} – {end_s:.2f} s"
                typer.echo(f"{where}  {shown or 'too short or too still to read'}")

    try:
        for_each(files, one)
    finally:
        if as_json:
            typer.echo(json.dumps(rows))


@app.command()
@unfolded
def train(
    output: Annotated[Path, typer.Option("-o", "--output", help="Write the model here.")],
    *,
    manifest: Annotated[
        Path | None,
        typer.Argument(
            help="CSV of takes: file,time,weight,space,flow,performer; Effort words, neutral, or "
            "nothing where not labelled.",
        ),
    ] = None,
    simulated: Annotated[
        bool, typer.Option("--simulated", help="Learn from simulated people: the shipped model.")
    ] = False,
    reading: ReadingOptions,
) -> None:
    """Learn to read Effort from labelled takes, or from simulated people.

    Prints how often each axis is told right on performers that were left out.
    """
    from laban.model_file import save_effort_model
    from smd.effort import report_lines, train_manifest, train_simulated
    from smd.files import replacing

    if simulated == (manifest is not None):
        raise typer.BadParameter("expected either a MANIFEST or --simulated")
    with replacing(output) as temporary:
        if manifest is None:
            training = train_simulated()
        else:
            training = train_manifest(manifest, reading.read, progress=_progress)
        save_effort_model(training.model, temporary)
    typer.echo("\n".join(report_lines(training)))
    typer.echo(f"written: {output}")


def _progress(rows: list[ManifestRow]) -> Iterator[ManifestRow]:
    """Yield the takes, showing on a terminal how many have been read."""
    hidden = not sys.stderr.isatty()
    with typer.progressbar(rows, hidden=hidden, file=sys.stderr) as bar:
        yield from bar
