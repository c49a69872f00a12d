"""Characters without feet, without legs of two bones or without a spine still act, in numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

import smd
from actions_library.folder import write_library
from actions_library.library import Library
from laban import Effort
from smd.acting.terrain import Terrain
from smd.character.character import Character, Mesh
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.doodle import Doodle, Recording
from smd.geometry.rotations import quaternion_about
from smd.recognition.action import Action
from smd.score import Part, Phrase, Score

# Of each character its joints: name, parent, place; and those that touch the ground.
BALL = [("root", -1, (0, 0, 0)), ("body", 0, (0, 0.5, 0))], ()
POST = [("root", -1, (0, 0, 0)), ("hips", 0, (0, 0.9, 0)), ("foot", 1, (0, -0.9, 0))], ("foot",)
LEGS = (
    [
        ("root", -1, (0, 0, 0)),
        ("hips", 0, (0, 0.9, 0)),
        ("left_thigh", 1, (0.1, 0, 0)),
        ("left_shin", 2, (0, -0.45, 0.01)),
        ("left_foot", 3, (0, -0.4, -0.01)),
        ("right_thigh", 1, (-0.1, 0, 0)),
        ("right_shin", 5, (0, -0.45, 0.01)),
        ("right_foot", 6, (0, -0.4, -0.01)),
    ],
    ("left_foot", "right_foot"),
)
CHARACTERS = {"ball": BALL, "post": POST, "legs": LEGS}
FRAMES = 61


def library_of(folder, joints, touching) -> Library:
    """A library in which a character idles, walks and jumps as a whole, without a bend."""
    n = len(joints)
    skeleton = Skeleton(
        joints=tuple(row[0] for row in joints),
        parents=np.array([row[1] for row in joints]),
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)),
        rest_translation_m=np.array([row[2] for row in joints], dtype=float),
        world_from_bind=np.tile(np.eye(4), (n, 1, 1)),
        roles=("root",) * n,
    )
    mesh = Mesh(
        name="Body",
        points_m=np.array([[-0.2, 0.0, 0.0], [0.2, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        triangles=np.array([[0, 1, 2]]),
        joint_indices=np.zeros((3, 4), int),
        joint_weights=np.tile([1.0, 0.0, 0.0, 0.0], (3, 1)),
        color_rgb=(0.5, 0.5, 0.5),
    )
    phase = np.linspace(0.0, 1.0, FRAMES)
    air = (phase > 0.3) & (phase < 0.7)

    def clip(name: str, *, ahead_m: float = 0.0, leaps: bool = False, cyclic: bool) -> Clip:
        place = np.tile(skeleton.rest_translation_m, (FRAMES, 1, 1))
        place[:, 0, 2] = ahead_m * phase
        if leaps:
            place[:, 1, 1] += np.where(air, 0.3 - 7.5 * (phase - 0.5) ** 2, 0.0)
        touches = np.tile((~air if leaps else air | True)[:, None], (1, len(touching)))
        return Clip(
            name=name,
            skeleton=skeleton,
            rate_hz=60.0,
            rotation_xyzw=np.tile(skeleton.rest_rotation_xyzw, (FRAMES, 1, 1)),
            translation_m=place,
            stage_end_frames=np.array([0, 0, FRAMES - 1, FRAMES - 1, FRAMES - 1]),
            contact_joints=tuple(touching),
            contacts=touches,
            cyclic=cyclic,
        )

    clips: Mapping[str, Clip] = {
        "idle": clip("idle", cyclic=True),
        "walk": clip("walk", ahead_m=1.0, cyclic=True),
        "jump": clip("jump", ahead_m=0.5, leaps=True, cyclic=False),
    }
    actions = tuple(
        Action(name, None, travels=name != "idle", cyclic=clips[name].cyclic) for name in clips
    )
    return write_library(
        folder,
        name="odd",
        character=Character("odd", skeleton, (mesh,)),
        clips=clips,
        actions=actions,
    )


def take() -> tuple[Recording, Score]:
    """A prop goes ahead, stops under a walk, and hops; another one stays where it is."""
    time_s = np.arange(9 * 90 + 1) / 90.0
    way = np.clip(time_s - 1.0, 0.0, 2.0) * 0.2 + np.clip(time_s - 6.0, 0.0, 1.5) * 0.1
    hop = np.clip((time_s - 6.0) / 1.5, 0.0, 1.0)
    place = np.stack([0.0 * way, 0.8 + 0.2 * hop * (1.0 - hop), way], axis=-1)
    facing = quaternion_about([0.0, 1.0, 0.0], 0.2 * np.sin(time_s))
    moving = Doodle(time_s, place, facing, "fox")
    still = Doodle(time_s, np.tile(place[0], (len(time_s), 1)), facing, "owl")
    quick = Effort(time=1.0, weight=1.0, space=-1.0, flow=1.0)
    part = Part(
        "fox",
        (
            Phrase("walk", 1.0, 3.0, quick),
            Phrase("walk", 4.0, 5.5),
            Phrase("jump", 6.0, 7.5, quick),
        ),
    )
    return Recording((moving, still)), Score((part, Part("owl", (Phrase("jump", 2.0, 4.0),))))


@pytest.mark.parametrize("heading", ["prop", "path"])
@pytest.mark.parametrize("name", CHARACTERS)
def test_whatever_is_missing_of_a_body_it_acts_in_numbers(tmp_path, name, heading):
    library = library_of(tmp_path / "odd", *CHARACTERS[name])
    corners = np.array([[-9.0, 0, -9], [-9, 0, 9], [9, 0, 9], [9, 0, -9]], dtype=float)
    corners[:, 1] = 0.1 * corners[:, 2]
    hill = Terrain(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    recording, score = take()
    for ground in (None, hill):
        performance = smd.animate(score, recording, library, heading=heading, ground=ground)
        for actor in performance.actors:
            assert np.isfinite(actor.poses.translation_m).all()
            length = np.linalg.norm(actor.poses.rotation_xyzw, axis=-1)
            assert length == pytest.approx(np.ones(length.shape))
        fox = performance.actors[0].poses.translation_m[:, 0]
        assert np.ptp(fox[:, 2]) > 2.0
        assert fox[:, 1] == pytest.approx(0.0 if ground is None else 0.1 * fox[:, 2], abs=0.08)
        said = performance.warnings
        assert any("walk at 4.00 s" in line and "on the spot" in line for line in said)
