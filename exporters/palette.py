"""Colours of phrases and performers: the same in the animation and in every picture of it."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from laban import AXES
from smd.character.character import Character
from smd.geometry.arrays import FloatArray

RGB = tuple[float, float, float]

IDLE_RGB: RGB = (0.62, 0.64, 0.67)
"""sRGB of movement that is no phrase's."""

_GOLDEN = 0.618034

# Medium tones of one lightness, told apart on white paper and beside each other.
_PHRASES = [
    *("#1f77b4", "#e8710a", "#2a9d55", "#c8385a", "#8456b8", "#00939b"),
    *("#b8860b", "#d1589b", "#5b7f2e", "#a0522d", "#4b5fc8", "#6d7681"),
]

# Muted beside the phrases, each lighter or darker than its neighbour.
_EFFORT = ["#475063", "#a5afbd", "#7d6748", "#cdb88f", "#4f6b5c", "#a9c2b1"]


def effort_color(axis: str) -> str:
    """Return the sRGB code of an axis of Effort; axes are told apart by their order."""
    return _EFFORT[AXES.index(axis) % len(_EFFORT)]


def action_colors(actions: Iterable[str]) -> dict[str, RGB]:
    """Return each action's sRGB colour; which one depends on the set of actions alone."""
    names = sorted(set(actions))
    return {name: _rgb(_PHRASES[i % len(_PHRASES)]) for i, name in enumerate(names)}


def performer_colors(character: Character, index: int) -> list[RGB]:
    """Return the colour of each mesh for a character's ``index``-th performer; the first keeps all.

    Performers are told apart by their largest garment, which is the largest mesh after the first
    one (the body), or the only one. Its hue goes round by the golden ratio, so that any number of
    them differ.
    """
    colors = [mesh.color_rgb for mesh in character.meshes]
    sizes = [len(mesh.triangles) for mesh in character.meshes]
    garment = 1 + sizes[1:].index(max(sizes[1:])) if len(sizes) > 1 else 0
    hue, saturation, value = colorsys.rgb_to_hsv(*colors[garment])
    colors[garment] = colorsys.hsv_to_rgb((hue + _GOLDEN * index) % 1.0, saturation, value)
    return colors


def linear_from_srgb(rgb: ArrayLike) -> FloatArray:
    """Return linear colours, as USD wants them, of sRGB ones (IEC 61966-2-1)."""
    c = np.asarray(rgb, dtype=np.float64)
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(rgb: ArrayLike) -> FloatArray:
    """Return sRGB colours, as pictures want them, of linear ones (IEC 61966-2-1)."""
    c = np.clip(np.asarray(rgb, dtype=np.float64), 0.0, 1.0)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def _rgb(code: str) -> RGB:
    red, green, blue = (int(code[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue
