"""A stand-in character and clips with known answers, and the shipped library."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from actions_library.folder import load_library
from actions_library.library import Library
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.geometry.rotations import quaternion_about
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Piece, piece_of

HIPS_M, KNEE_M, ANKLE_M = 0.9, 0.45, 0.05


@pytest.fixture(scope="session")
def library() -> Library:
    return load_library()


@pytest.fixture(scope="session")
def skeleton() -> Skeleton:
    """A root, hips, and two legs with toes; 0.9 m to the hips."""
    rows = [("root", -1, (0.0, 0.0, 0.0)), ("hips", 0, (0.0, HIPS_M, 0.0))]
    for side, x in (("left", 0.1), ("right", -0.1)):
        thigh = len(rows)
        rows += [
            (f"{side}_thigh", 1, (x, 0.0, 0.0)),
            (f"{side}_shin", thigh, (0.0, KNEE_M - HIPS_M, 0.01)),
            (f"{side}_foot", thigh + 1, (0.0, ANKLE_M - KNEE_M, -0.01)),
            (f"{side}_toes", thigh + 2, (0.0, -0.04, 0.12)),
        ]
    n = len(rows)
    return Skeleton(
        joints=tuple(row[0] for row in rows),
        parents=np.array([row[1] for row in rows]),
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)),
        rest_translation_m=np.array([row[2] for row in rows]),
        world_from_bind=np.tile(np.eye(4), (n, 1, 1)),
        roles=("root",) * n,
    )


MakePiece = Callable[..., Piece]


@pytest.fixture(scope="session")
def make_piece(skeleton: Skeleton) -> MakePiece:
    """Make a piece whose ground root goes ahead and turns evenly during its execution."""

    def make(
        name: str = "wave",
        *,
        frames: int = 61,
        ahead_m: float = 0.0,
        turn_rad: float = 0.0,
        cyclic: bool = False,
        travels: bool = False,
        stages: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0),
        left_stands: tuple[float, float] = (0.0, 1.0),
        right_stands: tuple[float, float] = (0.0, 1.0),
    ) -> Piece:
        phase = np.linspace(0.0, 1.0, frames)
        done = np.clip((phase - stages[1]) / max(stages[2] - stages[1], 1e-9), 0.0, 1.0)
        rotation = np.tile([0.0, 0.0, 0.0, 1.0], (frames, len(skeleton), 1))
        rotation[:, 0] = quaternion_about([0.0, 1.0, 0.0], turn_rad * done)
        translation = np.tile(skeleton.rest_translation_m, (frames, 1, 1))
        translation[:, 0, 2] = ahead_m * done
        contacts = [(phase >= a) & (phase <= b) for a, b in (left_stands, right_stands)]
        ends = [*(round(stage * (frames - 1)) for stage in stages), frames - 1]
        clip = Clip(
            name=name,
            skeleton=skeleton,
            rate_hz=60.0,
            rotation_xyzw=rotation,
            translation_m=translation,
            stage_end_frames=np.array(ends),
            contact_joints=("left_foot", "right_foot"),
            contacts=np.stack(contacts, axis=-1),
            cyclic=cyclic,
        )
        return piece_of(clip, travels=travels, legs=())

    return make


@pytest.fixture(scope="session")
def straight_path() -> GroundPath:
    """Ahead at 1 m/s for 20 s, while the prop turns left by 0.1 rad/s."""
    time_s = np.linspace(0.0, 20.0, 1201)
    return GroundPath(time_s, np.stack([0.0 * time_s, time_s], axis=-1), 0.1 * time_s)
