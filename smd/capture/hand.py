"""Trigger and grip of a hand, over frames that may hold only some of the devices."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from itertools import groupby
from typing import TypeAlias

from smd.capture.source import Frame

Stretch: TypeAlias = tuple[bool, Iterator[Frame]]
"""Whether a trigger is held all along, and the frames."""


def stretches(frames: Iterable[Frame]) -> Iterator[Stretch]:
    """Yield frames in stretches: a trigger is held, or none is.

    As with `itertools.groupby`, the frames of a stretch are valid until the next one is requested.
    """
    held: dict[str, bool] = {}

    def is_held(frame: Frame) -> bool:
        for sample in frame.samples:
            if sample.trigger is not None:
                held[sample.serial] = sample.trigger
        return any(held.values())

    return groupby(frames, is_held)


def grips(frames: Iterable[Frame]) -> Iterator[Frame]:
    """Yield the frames in which a grip is pressed that was not before."""
    before: Collection[str] = ()
    for frame in frames:
        pressed = {sample.serial for sample in frame.samples if sample.grip}
        if pressed.difference(before):
            yield frame
        before = pressed
