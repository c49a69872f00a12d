"""The `smd` program: its commands, and what an error costs."""

from __future__ import annotations

import sys
from typing import Annotated, NoReturn

import typer

from smd.cli import (
    animate,
    calibrate,
    convert,
    demo,
    devices,
    laban,
    learn,
    library,
    parse,
    play,
    record,
    rehearse,
    render,
    teach,
)

app = typer.Typer(
    name="smd",
    help="Turn playing with a tracked prop into character animation.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


@app.callback()
def _smd(
    debug: Annotated[
        bool, typer.Option("--debug", help="Show the traceback of an internal error.")
    ] = False,
) -> None:
    pass


app.command()(demo.demo)
app.command()(convert.convert)
app.command()(parse.parse)
app.command()(animate.animate)
app.command()(render.render)
app.command()(devices.devices)
app.command()(record.record)
app.command()(play.play)
app.command()(teach.teach)
app.command()(rehearse.rehearse)
app.command()(learn.learn)
app.command()(calibrate.calibrate)
app.add_typer(library.app, name="library", help="What can be performed.")
app.add_typer(laban.app, name="laban", help="Read and train Laban Effort.")


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run the command line and exit: 0 done, 2 wrong usage, 3 bad input, 1 our own fault."""
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        app(arguments)
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:  # the reader of our output has left; so do we
        sys.stderr.close()
        sys.exit(1)
    except Exception as error:
        from laban import LabanError
        from smd.errors import SmdError

        if isinstance(error, SmdError | LabanError):
            print(f"smd: {' '.join(str(error).split())}", file=sys.stderr)
            sys.exit(3)
        if "--debug" in arguments:
            raise
        print(
            f"smd: internal error: {type(error).__name__}: {error}\n"
            "Run again as `smd --debug …` and report what it prints.",
            file=sys.stderr,
        )
        sys.exit(1)
    sys.exit(0)
