"""Waves that travel along a chain of joints: tails, caterpillars, fins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from actions_library.authoring.curves import eased
from smd.geometry.arrays import FloatArray

Axis = Literal["yaw", "lean", "tilt"]

_AXES: tuple[Axis, ...] = ("yaw", "lean", "tilt")

FADE_S = 0.25
"""Time in which a wave rises and dies away in a clip that does not repeat."""


@dataclass(frozen=True, slots=True)
class Wave:
    """Each joint of a chain turns to and fro by a sine, later the farther it is from the root.

    Attributes
    ----------
    chain : its name.
    axis : as in `Turn`: yaw to the left, lean forward, tilt to the right.
    amplitude : of the root's joint (°).
    tip : of the last joint's; as the root's by default.
    wavelength : in lengths of the chain, by count of joints; below 0 the wave runs from tip to
        root, and infinite makes all joints turn together.
    phase : ahead by this fraction of a period.
    per_cycle : periods in the whole clip; a whole number where it is cyclic.
    """

    chain: str
    axis: Axis
    amplitude: float
    tip: float | None = None
    wavelength: float = 1.0
    phase: float = 0.0
    per_cycle: float = 1.0

    def turns_deg(self, joints: int, frames: int, rate_hz: float, *, cyclic: bool) -> FloatArray:
        """Return each joint's turn over time, ``(frames, joints, 3)``: yaw, lean, tilt.

        Raises
        ------
        ValueError
            If the clip repeats and the wave does not.
        """
        if cyclic and self.per_cycle != round(self.per_cycle):
            raise ValueError(
                f"wave of {self.chain!r}: per_cycle: expected a whole number in a cyclic clip, "
                f"got {self.per_cycle}"
            )
        along = np.linspace(0.0, 1.0, joints) if joints > 1 else np.zeros(1)
        time = np.linspace(0.0, 1.0, frames)
        amplitude = self.amplitude + along * (
            (self.amplitude if self.tip is None else self.tip) - self.amplitude
        )
        periods = self.per_cycle * time[:, None] + self.phase - along / self.wavelength
        angle = amplitude * np.sin(2.0 * np.pi * periods)
        if not cyclic:
            time_s = np.arange(frames) / rate_hz
            edge_s = np.minimum(time_s, time_s[-1] - time_s)
            angle = angle * eased(edge_s / FADE_S)[:, None]
        turns = np.zeros((frames, joints, 3))
        turns[:, :, _AXES.index(self.axis)] = angle
        return turns
