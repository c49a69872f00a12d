"""A command that takes groups of options is the command that names each of them by hand."""

from __future__ import annotations

import doctest
import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import pytest
import typer
from typer.main import get_command
from typer.testing import CliRunner

from smd.cli import app, option_groups
from smd.cli.option_groups import unfolded


class Colour(StrEnum):
    RED = "red"
    BLUE = "blue"


Ink = Annotated[Colour, typer.Option("--ink", help="Colour of the line.")]
Layer = Annotated[list[str] | None, typer.Option("--layer", "-l", help="May be repeated.")]
Corner = Annotated[tuple[int, int], typer.Option(help="Where to begin.")]
Width = Annotated[float, typer.Option(help="Width of the line.", min=0.5, max=9.0)]
Round = Annotated[bool | None, typer.Option("--round/--square", help="Ends of the line.")]
Dashed = Annotated[bool, typer.Option("--dashed", help="With gaps.")]
Filled = Annotated[bool, typer.Option(help="Not the outline alone.")]
Sizes = Annotated[list[int], typer.Option(help="Of copies.")]
Paper = Annotated[Path, typer.Option("--paper", help="What to draw on.")]
Names = Annotated[list[Path], typer.Argument(metavar="NAME…", help="Pictures.")]
Copies = Annotated[int, typer.Option("-n", "--copies", help="How many.")]


def two_sizes() -> list[int]:
    return [1, 2]


@dataclass(frozen=True, slots=True)
class Line:
    paper: Paper
    ink: Ink = Colour.RED
    width: Width = 1.5
    round: Round = None
    dashed: Dashed = False


@dataclass(frozen=True)
class Shape:
    layer: Layer = None
    corner: Corner = (0, 0)
    filled: Filled = True
    line_of_text: str = "none"
    sizes: Sizes = field(default_factory=two_sizes)
    drawn: int = field(default=0, init=False)


def by_hand(seen: list[dict[str, Any]]) -> Callable[..., None]:
    def draw(
        *,
        names: Names,
        paper: Paper,
        ink: Ink = Colour.RED,
        width: Width = 1.5,
        round: Round = None,
        dashed: Dashed = False,
        copies: Copies = 1,
        layer: Layer = None,
        corner: Corner = (0, 0),
        filled: Filled = True,
        line_of_text: str = "none",
        sizes: Annotated[list[int], typer.Option(help="Of copies.", default_factory=two_sizes)],
    ) -> None:
        """Draw pictures."""
        seen.append(dict(locals()))
        seen[-1].pop("seen", None)

    return draw


def in_groups(seen: list[dict[str, Any]]) -> Callable[..., None]:
    @unfolded
    def draw(names: Names, *, line: Line, copies: Copies = 1, shape: Shape) -> None:
        """Draw pictures."""
        of_line = {name: getattr(line, name) for name in Line.__slots__}
        of_shape = {k: v for k, v in vars(shape).items() if k != "drawn"}
        seen.append({"names": names, **of_line, "copies": copies, **of_shape})

    return draw


def program(command: Callable[..., None]) -> typer.Typer:
    made = typer.Typer(add_completion=False, rich_markup_mode=None)
    made.command()(command)
    return made


@pytest.fixture
def both() -> Callable[..., tuple[list[Any], list[Any]]]:
    """Run both commands; return what each printed and exited with, and what it was called with."""

    def run(*arguments: str) -> tuple[list[Any], list[Any]]:
        results = []
        for make in (by_hand, in_groups):
            seen: list[dict[str, Any]] = []
            result = CliRunner().invoke(program(make(seen)), arguments, env={"COLUMNS": "100"})
            results.append([result.exit_code, result.output, seen])
        return results[0], results[1]

    return run


def test_help_is_the_same(both):
    hand, groups = both("--help")
    assert groups == hand
    assert hand[0] == 0


GOOD = {
    "defaults": [],
    "an enum": ["--ink", "blue"],
    "repeated": ["-l", "a", "--layer", "b", "--layer", "a"],
    "several values": ["--corner", "3", "-4"],
    "a float": ["--width", "2"],
    "flags": ["--dashed", "--no-filled", "--square"],
    "a last flag that wins": ["--round", "--square", "--round"],
    "numbers repeated": ["--sizes", "7", "--sizes", "8"],
    "between the groups": ["-n", "3"],
    "without help of its own": ["--line-of-text", "two words"],
}


@pytest.mark.parametrize("name", GOOD)
def test_values_are_the_same(both, name):
    hand, groups = both("--paper", "sheet", "one", "two", *GOOD[name])
    assert groups == hand
    assert hand[0] == 0, hand[1]
    (values,) = hand[2]
    assert values["names"] == [Path("one"), Path("two")]
    assert {key: type(value) for key, value in groups[2][0].items()} == {
        key: type(value) for key, value in values.items()
    }


BAD = {
    "a required option missing": ["one"],
    "no argument": ["--paper", "sheet"],
    "out of range": ["--paper", "sheet", "one", "--width", "10"],
    "no such colour": ["--paper", "sheet", "one", "--ink", "green"],
    "one of two values": ["--paper", "sheet", "one", "--corner", "3"],
    "no number": ["--paper", "sheet", "one", "--sizes", "many"],
    "no such option": ["--paper", "sheet", "one", "--line", "x"],
}


@pytest.mark.parametrize("name", BAD)
def test_wrong_usage_is_told_the_same(both, name):
    hand, groups = both(*BAD[name])
    assert groups == hand
    assert (hand[0], hand[2]) == (2, [])


def test_a_default_that_is_made_is_made_anew_for_each_run():
    seen: list[dict[str, Any]] = []
    draw = program(in_groups(seen))
    for _ in range(2):
        CliRunner().invoke(draw, ["--paper", "sheet", "one"])
    assert seen[0]["sizes"] == seen[1]["sizes"] == [1, 2]
    assert seen[0]["sizes"] is not seen[1]["sizes"]


@dataclass(frozen=True, slots=True)
class Pen(Line):
    """A group that tells one option otherwise."""

    width: Annotated[float, typer.Option(help="Of the pen.", min=0.5, max=2.0)] = 1.0


def test_a_group_may_tell_an_option_of_another_otherwise_in_its_place():
    def draw(*, line: Line) -> None: ...

    said = []
    for group in (Line, Pen):
        draw.__annotations__ = {"line": group, "return": None}
        said.append(CliRunner().invoke(program(unfolded(draw)), ["--help"]).output.splitlines())
    told = [(a.split(), b.split()) for a, b in zip(*said, strict=True) if a != b]
    assert [(a[0], b[0]) for a, b in told][:1] == [("--width", "--width")]
    assert "pen." in [word for _, b in told for word in b]
    assert len(told) <= 2  # what the option says, on one line or two


def test_what_a_group_refuses_is_wrong_usage():
    @dataclass(frozen=True)
    class Even:
        number: int = 0

        def __post_init__(self) -> None:
            if self.number % 2:
                raise typer.BadParameter(f"expected an even number, got {self.number}")

    def command(*, even: Even) -> None:
        typer.echo(even.number)

    command.__annotations__["even"] = Even
    one = program(unfolded(command))
    assert CliRunner().invoke(one, ["--number", "4"]).output == "4\n"
    refused = CliRunner().invoke(one, ["--number", "3"])
    assert refused.exit_code == 2
    assert "expected an even number, got 3" in refused.output


def refused(said: str, **annotations: Any) -> None:
    """Expect that no command is made of parameters of such types, or types and defaults."""
    defaults = {name: v[1] for name, v in annotations.items() if isinstance(v, tuple)}
    hints = {name: v[0] if isinstance(v, tuple) else v for name, v in annotations.items()}
    lines = ", ".join(
        f"{name}=defaults[{name!r}]" if name in defaults else name for name in annotations
    )
    scope: dict[str, Any] = {"defaults": defaults}
    exec(f"def command(*, {lines}): pass", scope)
    scope["command"].__annotations__ = hints
    with pytest.raises(TypeError, match=said):
        unfolded(scope["command"])


@dataclass(frozen=True)
class Thin:
    width: float = 0.1


@dataclass(frozen=True)
class Painted:
    shade: Ink = Colour.BLUE


@dataclass(frozen=True)
class Unpainted:
    no_filled: bool = False


@dataclass
class Thawed:
    height: float = 1.0


def test_an_option_named_twice_is_an_error():
    refused("command: expected each option once, got width, --width", line=Line, thin=Thin)
    refused("expected each option once, got width, --width", line=Line, width=(float, 2.0))
    refused("expected each option once, got paper, ", one=Line, two=Line)


def test_an_option_spelled_twice_is_an_error_whatever_its_name():
    refused("expected each option once, got --ink$", line=Line, painted=Painted)
    refused("expected each option once, got --no-filled$", shape=Shape, other=Unpainted)
    square = Annotated[bool, typer.Option("--square")]
    refused("expected each option once, got --square$", line=Line, corners=(square, False))


def test_an_argument_is_not_spelled_and_may_share_a_word_with_an_option():
    def draw(dashed_: str, *, line: Line, ink_: str = "") -> None: ...

    argument = Annotated[str, typer.Argument(metavar="INK")]
    draw.__annotations__ = {"dashed_": str, "line": Line, "ink_": argument}
    seen = program(unfolded(draw))
    said = CliRunner().invoke(seen, ["--help"]).output
    assert "DASHED_" in said.upper() and "[INK]" in said


def test_a_group_is_frozen_and_has_no_default_of_its_own():
    refused(r"command\(size\): expected a frozen dataclass, got Thawed", size=Thawed)
    refused(r"command\(thin\): expected defaults in Thin alone", thin=(Thin, Thin()))


def commands(group: Any = None, place: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return every command of the program by what is typed."""
    group = get_command(app.app) if group is None else group
    found = {}
    for name, command in group.commands.items():
        inside = hasattr(command, "commands")
        found |= (
            commands(command, (*place, name)) if inside else {" ".join((*place, name)): command}
        )
    return found


def test_spellings_are_those_that_typer_reads():
    draw = in_groups([])
    typed = [{*one.opts, *one.secondary_opts} for one in get_command(program(draw)).params[1:]]
    parameters = list(inspect.signature(draw).parameters.values())[1:]
    assert [set(option_groups._spellings(one)) for one in parameters] == typed


@pytest.mark.parametrize("name", commands())
def test_no_command_of_the_program_has_an_option_twice(name):
    options = [one for one in commands()[name].params if one.param_type_name == "option"]
    spelled = [text for one in options for text in (*one.opts, *one.secondary_opts)]
    assert len(set(spelled)) == len(spelled)


@pytest.mark.parametrize("name", commands())
def test_no_command_of_the_program_takes_ten_parameters(name):
    # typer wraps what it was given once, and `unfolded` the command itself
    parameters = inspect.signature(inspect.unwrap(commands()[name].callback)).parameters
    assert len(parameters) < 10


def test_the_example_of_the_docstring_runs():
    result = doctest.testmod(option_groups)
    assert (result.failed, result.attempted > 0) == (0, True)
