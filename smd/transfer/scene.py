"""SceneScale: the places that were played on, as large as the character needs them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from laban.frozen import Frozen
from smd.doodle import Doodle, Recording
from smd.errors import TransferError
from smd.geometry.arrays import FloatArray, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class SceneScale(Frozen):
    """Where a recording's places are in the scene.

    Attributes
    ----------
    scale : metres in the scene per metre of the recording.
    origin_m : (3,) the place of the recording that is the scene's origin.
    """

    scale: float
    origin_m: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "origin_m", frozen_array("origin_m", self.origin_m, (3,), TransferError)
        )

    def placed(self, position_m: FloatArray) -> FloatArray:
        """Return where places ``(…, 3)`` of the recording are in the scene."""
        return (position_m - self.origin_m) * self.scale

    def placed_doodle(self, doodle: Doodle) -> Doodle:
        """Return a doodle as large as in the scene; its times and turns stay."""
        return replace(doodle, position_m=self.placed(doodle.position_m))


def scene_scale(
    recording: Recording, character_height_m: float, figure_height_m: float
) -> SceneScale:
    """Return the scale at which a figurine of the prop's size is the character.

    Places scale, times do not. Over the ground, the origin is the middle of the devices' first
    places, so that performers keep their places beside each other; the ground is the lowest
    point that any device reached.

    Raises
    ------
    TransferError
        If the character is not above the ground: its height sets the scale.
    """
    if not character_height_m > 0.0:
        raise TransferError(
            f"character: expected a height above zero, found {character_height_m:.2f} m"
        )
    first = [recording.of(device)[0].position_m[0] for device in recording.devices]
    lowest = min(float(doodle.position_m[:, 1].min()) for doodle in recording.doodles)
    middle = np.mean(first, axis=0)
    return SceneScale(
        character_height_m / figure_height_m, np.array([middle[0], lowest, middle[2]])
    )
