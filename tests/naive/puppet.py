"""A humanoid of one prism per bone that walks and waves: quick to make, easy to check."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.humanoid import humanoid_skeleton
from laban import Effort
from smd.acting.performance import Actor, Performance
from smd.character.character import Character, Mesh
from smd.character.clip import Clip
from smd.character.poses import Poses
from smd.doodle import Doodle
from smd.geometry.rotations import quaternion_about
from smd.score import Part, Phrase, Score
from smd.score_file import score_to_json

SIDES = 6


def puppet() -> Character:
    """Return the humanoid with a six-sided prism along each bone, and a head."""
    skeleton = humanoid_skeleton()
    world = skeleton.world_from_bind[:, :3, 3]
    points, triangles, owners = [], [], []
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if parent < 1:
            continue
        radius = 0.11 if "spine" in skeleton.roles[joint] else 0.04
        start, end = world[parent], world[joint]
        if skeleton.joints[joint] == "head":
            end = world[joint] + np.array([0.0, 0.2, 0.0])
        axis = (end - start) / np.linalg.norm(end - start)
        side = np.cross(axis, [0.3, 0.2, 1.0])
        side /= np.linalg.norm(side)
        up = np.cross(axis, side)
        angle = 2 * np.pi * np.arange(SIDES) / SIDES
        ring = radius * (np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * up)
        base = len(points) * (2 * SIDES + 2)
        points.append(np.vstack([start + ring, end + ring, start, end]))
        owners.append(np.full(2 * SIDES + 2, parent))
        for i in range(SIDES):
            a, b, c, d = i, (i + 1) % SIDES, SIDES + i, SIDES + (i + 1) % SIDES
            rows = [(a, b, d), (a, d, c), (b, a, 2 * SIDES), (c, d, 2 * SIDES + 1)]
            triangles.extend(tuple(base + k for k in row) for row in rows)
    owner = np.concatenate(owners)
    mesh = Mesh(
        name="Body",
        points_m=np.vstack(points),
        triangles=np.array(triangles),
        joint_indices=np.column_stack([owner, np.zeros((len(owner), 3), int)]),
        joint_weights=np.tile([1.0, 0.0, 0.0, 0.0], (len(owner), 1)),
        color_rgb=(0.05, 0.42, 0.4),
    )
    return Character(name="puppet", skeleton=skeleton, meshes=(mesh,))


def wave(frames: int, rate_hz: float = 60.0) -> tuple[np.ndarray, np.ndarray]:
    """Return local poses of the humanoid waving its left arm while it slides to +Z at 1 m/s."""
    skeleton = humanoid_skeleton()
    time_s = np.arange(frames) / rate_hz
    rotation = np.tile(skeleton.rest_rotation_xyzw, (frames, 1, 1))
    translation = np.tile(skeleton.rest_translation_m, (frames, 1, 1))
    translation[:, 0, 2] = time_s
    rotation[:, 0] = quaternion_about([0.0, 1.0, 0.0], 0.5 * time_s)
    arm, knee = skeleton.index("left_upper_arm"), skeleton.index("left_lower_leg")
    rotation[:, arm] = quaternion_about([0.0, 0.0, 1.0], 1.0 + 0.8 * np.sin(6.0 * time_s))
    rotation[:, knee] = quaternion_about([1.0, 0.0, 0.0], 0.5 - 0.5 * np.cos(5.0 * time_s))
    return rotation, translation


def waving_clip(name: str = "wave", frames: int = 30, *, cyclic: bool = False) -> Clip:
    """Return `wave` as a clip with stages, and contacts of the feet."""
    rotation, translation = wave(frames, 30.0)
    return Clip(
        name=name,
        skeleton=humanoid_skeleton(),
        rate_hz=30.0,
        rotation_xyzw=rotation,
        translation_m=translation,
        stage_end_frames=np.array([4, 8, 20, 25, frames - 1]),
        contact_joints=("left_foot", "right_foot"),
        contacts=np.column_stack([np.arange(frames) % 2 == 0, np.ones(frames, bool)]),
        cyclic=cyclic,
    )


def performance(seconds: float, rate_hz: float) -> Performance:
    """Return two puppets that wave side by side from 10 s on, the right one's prop lost midway."""
    frames = round(seconds * rate_hz) + 1
    rotation, translation = wave(frames, rate_hz)
    character, parts, actors = puppet(), [], []
    for index, device in enumerate(("left hand", "right-hand")):
        moved = translation.copy()
        moved[:, 0, 0] += 1.5 * index
        phrases = (
            Phrase("walk", 10.0 + 0.1 * seconds, 10.0 + 0.45 * seconds, Effort(0.5, -0.25)),
            Phrase("punch", 10.0 + 0.6 * seconds, 10.0 + 0.9 * seconds, Effort(1.0, 1.0), 0.75),
        )
        parts.append(Part(device, phrases))
        doodle = loop(seconds, centre=(1.5 * index, 1.0, 0.0), device=device)
        doodles = (doodle,) if index == 0 else split(doodle, 10.0 + 0.5 * seconds, 0.2 * seconds)
        actors.append(Actor(device, character, Poses(rotation, moved), phrases, doodles))
    score = Score(tuple(parts), recording="made up")
    return Performance(rate_hz, 10.0, tuple(actors), source={"score": score_to_json(score)})


def loop(seconds: float, centre: tuple[float, float, float], device: str) -> Doodle:
    """Return a rising circle drawn from 10 s on at 90 Hz, the prop facing along it."""
    time_s = np.arange(0.0, seconds + 1e-9, 1.0 / 90.0)
    angle = 2.0 * np.pi * time_s / seconds
    circle = np.column_stack([np.sin(angle), 0.1 * angle, np.cos(angle)])
    return Doodle(
        time_s=10.0 + time_s,
        position_m=circle + centre,
        orientation_xyzw=quaternion_about([0.0, 1.0, 0.0], angle + 0.5 * np.pi),
        device=device,
    )


def split(doodle: Doodle, middle_s: float, gap_s: float) -> tuple[Doodle, Doodle]:
    """Return a doodle without its samples inside a gap."""
    before = doodle.time_s <= middle_s - 0.5 * gap_s
    after = doodle.time_s >= middle_s + 0.5 * gap_s
    first, second = (
        Doodle(doodle.time_s[k], doodle.position_m[k], doodle.orientation_xyzw[k], doodle.device)
        for k in (before, after)
    )
    return first, second
