"""Options that belong together are one frozen dataclass: a command takes it, typer its fields.

A field stands for a parameter of the command: its name, annotation and default give the option, and
its place among the fields the option's place in ``--help``.
"""

from __future__ import annotations

import dataclasses
import functools
import inspect
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from typer.models import ArgumentInfo, OptionInfo


def unfolded(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command whose groups of options are unfolded, an option a field, for typer to read.

    A group is a parameter annotated with a frozen dataclass. Its options stand where it stood; when
    the command runs it is made of what they were given. Groups have no default of their own, so a
    command takes them by keyword. A field's ``default_factory`` is typer's own: called once a run.

    Raises
    ------
    TypeError
        If a group is not frozen or has a default, or if two options share a name or a spelling:
        typer would keep only one of them. Commands are unfolded where they are defined, so this is
        found at import.

    Examples
    --------
    >>> @dataclasses.dataclass(frozen=True)
    ... class Size:
    ...     width_m: float = 1.0
    ...     height_m: float = 2.0
    >>> def draw(picture: str, *, size: Size) -> None: ...
    >>> print(inspect.signature(unfolded(draw), eval_str=True))
    (*, picture: str, width_m: float = 1.0, height_m: float = 2.0)
    """
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, tuple[type[Any], list[str]]] = {}
    parameters: list[inspect.Parameter] = []
    for name, parameter in inspect.signature(command).parameters.items():
        annotation = hints.get(name, parameter.annotation)
        if isinstance(annotation, type) and dataclasses.is_dataclass(annotation):
            _require_group(command, parameter, annotation)
            options = _options(annotation)
            groups[name] = annotation, [option.name for option in options]
            parameters += options
        else:
            parameters.append(_option(name, annotation, parameter.default))
    _require_once(command, parameters)

    @functools.wraps(command)
    def call(**values: Any) -> None:
        made = {
            name: group(**{option: values.pop(option) for option in options})
            for name, (group, options) in groups.items()
        }
        command(**values, **made)

    call.__annotations__ = {one.name: one.annotation for one in parameters}
    call.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return call


@functools.cache  # seven commands read recordings, and --help waits for all of them
def _options(group: type[Any]) -> tuple[inspect.Parameter, ...]:
    """Return a group's fields as parameters of a command."""
    hints = get_type_hints(group, include_extras=True)
    defaults = {
        field.name: [
            one for one in (field.default, field.default_factory) if one is not dataclasses.MISSING
        ]
        for field in dataclasses.fields(group)
        if field.init
    }
    return tuple(_option(name, hints[name], *given) for name, given in defaults.items())


def _option(
    name: str, annotation: Any, default: Any = inspect.Parameter.empty
) -> inspect.Parameter:
    """Return a parameter; by keyword, since one without a default may follow one that has one."""
    keyword = inspect.Parameter.KEYWORD_ONLY
    return inspect.Parameter(name, keyword, annotation=annotation, default=default)


def _spellings(parameter: inspect.Parameter) -> Iterator[str]:
    """Yield how a user may type an option, as typer reads it; nothing for an argument."""
    kind, said = parameter.annotation, []
    if get_origin(kind) is Annotated:
        kind, *said = get_args(kind)
    options = [one for one in said if isinstance(one, OptionInfo)]
    bare = not options and parameter.default is inspect.Parameter.empty  # typer: an argument
    if bare or any(isinstance(one, ArgumentInfo) for one in said):
        return
    # In an annotation, typer keeps the first spelling as the default of its `Option`.
    declared = [one for option in options for one in (option.default, *(option.param_decls or ()))]
    own = [one for one in declared if isinstance(one, str) and one.startswith("-")]
    name = parameter.name.replace("_", "-")
    flag = f"--{name}/--no-{name}" if kind in (bool, bool | None) else f"--{name}"
    for one in own or [flag]:
        yield from (spelling.strip() for spelling in one.split("/"))


def _require_group(
    command: Callable[..., None], parameter: inspect.Parameter, group: type[Any]
) -> None:
    """Raise TypeError if a parameter cannot stand for a group of options."""
    place = f"{command.__name__}({parameter.name})"
    if not group.__dataclass_params__.frozen:
        raise TypeError(f"{place}: expected a frozen dataclass, got {group.__name__}")
    if parameter.default is not inspect.Parameter.empty:
        raise TypeError(f"{place}: expected defaults in {group.__name__} alone, got one here")


def _require_once(command: Callable[..., None], parameters: list[inspect.Parameter]) -> None:
    """Raise TypeError if two options share a name or a spelling."""
    names = Counter(parameter.name for parameter in parameters)
    spellings = Counter(one for parameter in parameters for one in _spellings(parameter))
    twice = [one for one, count in (names + spellings).items() if count > 1]
    if twice:
        raise TypeError(f"{command.__name__}: expected each option once, got {', '.join(twice)}")
