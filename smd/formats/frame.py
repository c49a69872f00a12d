"""SourceFrame and Mount: from a file's axes, unit and quaternion order to ours.

Ours: metres, right-handed, +Y up; a prop faces +Z, +X is its left. ``docs/conventions.md`` says
the same in words and pictures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np

from smd.errors import RecordingError
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    quaternion_between,
    rotate,
)

METRES_PER_UNIT = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
AXES = ("x", "-x", "y", "-y", "z", "-z")
HANDEDNESS = ("right", "left")
QUATERNION_ORDERS = ("xyzw", "wxyz")


@dataclass(frozen=True, slots=True)
class Mount:
    """How a prop sits on its tracker: turn the tracker, then step from it to the prop's centre.

    In the tracker's frame as we see it (+Z its front, +X its left, +Y its up). The turn is yaw
    about +Y (positive to the left), then pitch about the new +X (positive nose down), then roll
    about the new +Z (positive left side up); the step is along the tracker's own axes.

    Attributes
    ----------
    yaw_deg, pitch_deg, roll_deg : from the tracker's orientation to the prop's.
    x_m, y_m, z_m : from the tracker to the prop's centre.
    """

    yaw_deg: float = 0.0
    pitch_deg: float = 0.0
    roll_deg: float = 0.0
    x_m: float = 0.0
    y_m: float = 0.0
    z_m: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value):
                raise RecordingError(f"mount: expected finite numbers, found {field.name}={value}")

    @classmethod
    def parse(cls, text: str) -> Mount:
        """Return the mount that a user typed, as in ``yaw=180,z=-0.05`` (degrees and metres).

        Raises
        ------
        RecordingError
            If a name is unknown or given twice, or a value is not a finite number.
        """
        names = {field.name.rsplit("_", 1)[0]: field.name for field in fields(cls)}
        values: dict[str, float] = {}
        for part in text.split(","):
            name, equals, number = (piece.strip() for piece in part.partition("="))
            try:
                value = float(number)
            except ValueError:
                value = math.nan
            if not equals or name not in names or names[name] in values or not math.isfinite(value):
                raise RecordingError(
                    f"mount: expected {', '.join(names)} each at most once, as in "
                    f"yaw=180,z=-0.05 (degrees, metres), found {part.strip()!r}"
                )
            values[names[name]] = value
        return cls(**values)

    def __str__(self) -> str:
        parts = (
            f"{field.name.rsplit('_', 1)[0]}={getattr(self, field.name)!r}"
            for field in fields(self)
            if getattr(self, field.name) != 0.0
        )
        return ",".join(parts) or "yaw=0"

    @property
    def tracker_from_prop_xyzw(self) -> FloatArray:
        """The turn, as a quaternion."""
        yaw, pitch, roll = np.radians([self.yaw_deg, self.pitch_deg, self.roll_deg])
        turned = multiply(quaternion_about([0, 1, 0], yaw), quaternion_about([1, 0, 0], pitch))
        return multiply(turned, quaternion_about([0, 0, 1], roll))

    @property
    def lever_m(self) -> FloatArray:
        """The step, in the tracker's frame."""
        return np.array([self.x_m, self.y_m, self.z_m])

    def stepped(self, step_m: FloatArray) -> Mount:
        """Return this mount with a further step ``(3,)``, in the prop's frame, to 0.1 mm."""
        step = self.lever_m + rotate(self.tracker_from_prop_xyzw, step_m)
        x_m, y_m, z_m = (round(value, 4) for value in step.tolist())
        return replace(self, x_m=x_m, y_m=y_m, z_m=z_m)


@dataclass(frozen=True, slots=True)
class SourceFrame:
    """What a recording's numbers mean; None leaves a question to the file's format.

    Attributes
    ----------
    up : the world's axis that points up, one of x -x y -y z -z.
    front : the axis of the device's own frame that points where it faces; its up axis is the
        world's, and its orientation is identity when its axes lie along the world's.
    handedness : of the axes: "right" or "left".
    unit : of positions: m, cm, mm, in or ft.
    quaternion : order of its components: "xyzw" or "wxyz".
    mount : how the prop sits on the tracker.

    Raises
    ------
    RecordingError
        If a value is none of these; the message names the option.
    """

    up: str | None = None
    front: str | None = None
    handedness: str | None = None
    unit: str | None = None
    quaternion: str | None = None
    mount: Mount | None = None

    def __post_init__(self) -> None:
        choices: dict[str, tuple[str, ...]] = {
            "up": AXES,
            "front": AXES,
            "handedness": HANDEDNESS,
            "unit": tuple(METRES_PER_UNIT),
            "quaternion": QUATERNION_ORDERS,
        }
        for option, known in choices.items():
            value = getattr(self, option)
            if value is not None and value not in known:
                raise RecordingError(
                    f"{option}: expected one of {' '.join(known)}, found {str(value)!r}"
                )

    @classmethod
    def ours(cls) -> SourceFrame:
        """Return the frame that needs no conversion."""
        return cls("y", "z", "right", "m", "xyzw", Mount())

    @classmethod
    def from_options(
        cls,
        *,
        up: str | None = None,
        front: str | None = None,
        handedness: str | None = None,
        unit: str | None = None,
        quaternion: str | None = None,
        mount: str | None = None,
    ) -> SourceFrame:
        """Return the frame of options as a user types them; case and ``+`` do not matter.

        Raises
        ------
        RecordingError
            If an option cannot be understood.
        """

        def plain(text: str | None) -> str | None:
            return None if text is None else text.strip().lower().removeprefix("+")

        return cls(
            plain(up),
            plain(front),
            plain(handedness),
            plain(unit),
            plain(quaternion),
            None if mount is None else Mount.parse(mount),
        )

    def options(self) -> dict[str, str]:
        """Return what is said, as text that `from_options` reads back."""
        return {
            field.name: str(getattr(self, field.name))
            for field in fields(self)
            if getattr(self, field.name) is not None
        }

    def completed(self, default: SourceFrame) -> SourceFrame:
        """Return this frame with the default's answer to every question left open.

        The default's front belongs to its up axis: under another one, a device whose front is
        not said faces the axis that becomes our +Z.
        """
        answers = {
            field.name: getattr(default, field.name)
            for field in fields(self)
            if getattr(self, field.name) is None
        }
        if self.front is None and self.up is not None and self.up != default.up:
            answers["front"] = _facing(self.up)
        return replace(self, **answers)

    def conversion(self) -> Conversion:
        """Return the conversion to our convention; every question must be answered.

        Raises
        ------
        RecordingError
            If the device's front lies along the up axis.
        """
        assert self.up and self.front and self.handedness and self.unit and self.quaternion
        if self.front[-1] == self.up[-1]:
            raise RecordingError(
                f"front: expected an axis across up ({self.up}), found {self.front!r}"
            )
        up, front = _axis(self.up), _axis(self.front)
        across = 1.0 - np.abs(up) - np.abs(front)
        mirror = 1.0 - 2.0 * across * (self.handedness == "left")
        # Seen in this mirror all is right-handed, and up and front are as they were.
        return Conversion(
            metres_per_unit=METRES_PER_UNIT[self.unit],
            order=self.quaternion,
            mirror=mirror,
            world_from_mirrored_xyzw=_upright(self.up),
            mirrored_device_from_tracker_xyzw=_device_from_prop(up, front),
            mount=self.mount or Mount(),
        )


def _axis(name: str) -> FloatArray:
    """Return the unit vector of an axis's name."""
    return np.eye(3)["xyz".index(name[-1])] * (-1.0 if name[0] == "-" else 1.0)


def _upright(up: str) -> FloatArray:
    """Return the shortest turn that sets the up axis upright; about X where it hangs down."""
    if up == "-y":
        return np.array([1.0, 0.0, 0.0, 0.0])
    return quaternion_between(_axis(up), [0.0, 1.0, 0.0])


def _facing(up: str) -> str:
    """Return the axis that this turn brings to +Z: z for y up, -y for z up (as in CAD)."""
    front = rotate(inverse(_upright(up)), [0.0, 0.0, 1.0])
    return next(name for name in AXES if np.allclose(_axis(name), front))


def _device_from_prop(up: FloatArray, front: FloatArray) -> FloatArray:
    """Return the turn that takes +Y to ``up`` and +Z to ``front``, which lies across it."""
    standing = quaternion_between([0.0, 1.0, 0.0], up)
    facing = rotate(standing, [0.0, 0.0, 1.0])
    angle_rad = np.arctan2(up @ np.cross(facing, front), facing @ front)
    return multiply(quaternion_about(up, angle_rad), standing)


@dataclass(frozen=True, slots=True, eq=False)
class Conversion:
    """A source's numbers to ours: mirror, set upright, turn the device to face +Z, mount.

    With ``M`` the mirror (identity for right-handed sources), ``S`` the turn that sets up
    upright and ``D`` the device's axes seen in the mirror, a position becomes ``S M p`` and a
    rotation ``S (M R M) D``: conjugating by a mirror keeps a rotation a rotation, about the
    mirrored axis and the other way round.
    """

    metres_per_unit: float
    order: str
    mirror: FloatArray
    world_from_mirrored_xyzw: FloatArray
    mirrored_device_from_tracker_xyzw: FloatArray
    mount: Mount

    def poses(self, position: FloatArray, quaternion: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``position_m (n, 3)`` and ``orientation_xyzw (n, 4)`` of the prop's centre."""
        q = np.roll(quaternion, -1, axis=1) if self.order == "wxyz" else quaternion
        # A rotation's axis is a pseudovector: a mirror turns it round as well (det M = -1).
        q = q * np.append(np.prod(self.mirror) * self.mirror, 1.0)
        world_from_tracker = multiply(
            multiply(self.world_from_mirrored_xyzw, q), self.mirrored_device_from_tracker_xyzw
        )
        tracker_m = rotate(
            self.world_from_mirrored_xyzw, position * self.mirror * self.metres_per_unit
        )
        return (
            tracker_m + rotate(world_from_tracker, self.mount.lever_m),
            multiply(world_from_tracker, self.mount.tracker_from_prop_xyzw),
        )

    def numbers(
        self, position_m: FloatArray, orientation_xyzw: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the source's numbers of poses: what `poses` makes these of."""
        world_from_tracker = multiply(orientation_xyzw, inverse(self.mount.tracker_from_prop_xyzw))
        tracker_m = position_m - rotate(world_from_tracker, self.mount.lever_m)
        mirrored_from_world = inverse(self.world_from_mirrored_xyzw)
        position = rotate(mirrored_from_world, tracker_m) * self.mirror / self.metres_per_unit
        q = multiply(
            multiply(mirrored_from_world, world_from_tracker),
            inverse(self.mirrored_device_from_tracker_xyzw),
        )
        q = q * np.append(np.prod(self.mirror) * self.mirror, 1.0)
        return position, np.roll(q, 1, axis=1) if self.order == "wxyz" else q
