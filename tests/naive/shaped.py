"""A puppet with a face: shapes on its meshes, and tracks that move them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from smd.acting.performance import Performance
from smd.character.blend_shape import BlendShape
from smd.character.character import Character, Mesh
from smd.character.clip import Clip
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray
from tests.naive.puppet import performance, puppet, waving_clip

NAMES = ("smile", "jaw open", "müde")


def shaped(mesh: Mesh, names: tuple[str, ...] = NAMES, seed: int = 0) -> Mesh:
    """Return a mesh with shapes of a few centimetres, each of about half of its points.

    Their numbers are those of single precision, as USD keeps them.
    """
    rng = np.random.default_rng(seed)
    shapes = []
    for name in names:
        moved = np.flatnonzero(rng.uniform(size=len(mesh.points_m)) < 0.5)
        offsets = 0.03 * rng.normal(size=(len(moved), 3)).astype(np.float32)
        shapes.append(BlendShape(name, moved, offsets))
    return replace(mesh, shapes=tuple(shapes))


def shaped_puppet() -> Character:
    """Return the puppet of two meshes; both have a smile, the second one nothing else."""
    plain = puppet()
    (body,) = plain.meshes
    mask = shaped(replace(body, name="Mask"), NAMES[:1], seed=1)
    return replace(plain, meshes=(shaped(body), mask))


def weights(frames: int, names: tuple[str, ...] = (*NAMES, "gear")) -> Tracks:
    """Return tracks that swing from 0 to 1, the last of them no shape's."""
    phase = np.arange(frames)[:, None] * [0.1, 0.23, 0.31, 0.07][: len(names)]
    return Tracks(names, (0.5 - 0.5 * np.cos(phase)).astype(np.float32))


def shaped_clip(name: str = "wave", frames: int = 30) -> Clip:
    """Return the puppet's wave with tracks."""
    return replace(waving_clip(name, frames), tracks=weights(frames))


def shaped_performance(seconds: float = 1.0, rate_hz: float = 24.0) -> Performance:
    """Return two puppets with faces that wave; the second one's face rests."""
    plain = performance(seconds, rate_hz)
    first, second = (replace(actor, character=shaped_puppet()) for actor in plain.actors)
    return replace(plain, actors=(replace(first, tracks=weights(len(plain))), second))


def weights_of(mesh: Mesh, tracks: Tracks) -> FloatArray:
    """Return the weights ``(n, s)`` of a mesh's shapes."""
    return tracks.of(shape.name for shape in mesh.shapes)
