"""``smd devices``: what is tracked."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import capturing

if TYPE_CHECKING:
    from smd.capture.source import Device


def devices(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
    source: capturing.Source = capturing.SOURCE,
) -> None:
    """Show headset, controllers and trackers."""
    with capturing.CapturingOptions(source=source).opened() as opened:
        found = opened.devices()
    if as_json:
        typer.echo(json.dumps([dataclasses.asdict(device) for device in found], indent=2))
    else:
        typer.echo("\n".join(map(_line, found)) or "no devices: switch on a controller or tracker")


def _line(device: Device) -> str:
    """Return a device as a line of a table."""
    battery = "" if device.battery is None else f"battery {100 * device.battery:.0f} %"
    return (
        f"{device.serial:<18} {device.kind:<10} {device.role:<5} {device.tracking:<7} "
        f"{battery:<13} {device.model}".rstrip()
    )
