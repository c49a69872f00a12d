"""A picture of one action: the prop's gesture beside eight moments of the clip."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from smd.errors import ExportError
from smd.files import replacing
from smd.geometry.arrays import FloatArray

if TYPE_CHECKING:
    from actions_library.library import Library

SHOWN = 7
"""Moments of the gesture at which the prop is drawn."""

_FIGURINE = 0.22
"""Height of the drawn prop, as a share of the gesture's size."""

_SIZE_PX = 270
_PATH, _BODY, _NOSE = "#2b6cb0", "#4a5568", "#d9480f"


def write_action_picture(library: Library, action: str, png_path: Path | str) -> None:
    """Draw an action's gesture and clip, side by side.

    The gesture is the most central one of its examples: the prop's way, and the prop at a few
    moments, a stroke for its height and one for its front.

    Parameters
    ----------
    library
        Whose action; its folder is read.
    action
        Name of the action.
    png_path
        The picture.

    Raises
    ------
    LibraryError
        If there is no such action.
    ExportError
        If the picture cannot be written, or this machine cannot render.
    """
    from PIL import Image

    from exporters.filmstrip import write_filmstrip

    png_path, known = Path(png_path), library.action(action)
    if png_path.suffix.lower() != ".png":
        raise ExportError(
            f"{png_path}: expected a suffix of .png, found {png_path.suffix or 'none'}"
        )
    with tempfile.TemporaryDirectory() as folder:
        strip_path = Path(folder, f"{action}.png")
        write_filmstrip(library.folder / library.clip_files[action], strip_path, rows=1)
        strip = Image.open(strip_path).convert("RGB")
        parts = [strip]
        if known.exemplar is not None:
            gesture = Path(folder, "gesture.png")
            _draw_gesture(known.exemplar.central, known.description, gesture)
            parts.insert(0, Image.open(gesture).convert("RGB"))
        sheet = Image.new(
            "RGB", (sum(p.width for p in parts), max(p.height for p in parts)), "white"
        )
        left = 0
        for part in parts:
            sheet.paste(part, (left, sheet.height - part.height))
            left += part.width
        with replacing(png_path) as temporary:
            sheet.save(temporary, format="PNG")


def _draw_gesture(points: FloatArray, description: str, path: Path) -> None:
    """Draw a gesture given as ``(n, 12)`` points: a place and the prop's three axes each."""
    import textwrap

    from matplotlib.figure import Figure

    place, axes = points[:, :3], points[:, 3:].reshape(-1, 3, 3)
    size = max(float(np.ptp(place, axis=0).max()), 0.8)
    figure = Figure(figsize=(_SIZE_PX / 100, (_SIZE_PX + 48) / 100), dpi=100)
    view: Any = figure.add_axes((0.0, 0.0, 1.0, 0.86), projection="3d")
    # Matplotlib's z is up, ours y; its x and y become our left and front.
    shown = place[:, [2, 0, 1]]
    view.plot(*shown.T, color=_PATH, linewidth=1.6)
    for i in np.linspace(0, len(place) - 1, SHOWN).round().astype(int):
        unit = axes[i] / np.linalg.norm(axes[i], axis=-1, keepdims=True)
        foot = place[i] - 0.5 * _FIGURINE * size * unit[1]
        head = place[i] + 0.5 * _FIGURINE * size * unit[1]
        nose = head + 0.4 * _FIGURINE * size * unit[2]
        fade = 0.25 + 0.75 * i / max(len(place) - 1, 1)
        for ends, color in (((foot, head), _BODY), ((head, nose), _NOSE)):
            view.plot(*np.array(ends)[:, [2, 0, 1]].T, color=color, alpha=fade, linewidth=2.0)
    middle = 0.5 * (shown.min(axis=0) + shown.max(axis=0))
    half = 0.5 * size * (1.0 + _FIGURINE)
    view.set(
        xlim=(middle[0] - half, middle[0] + half),
        ylim=(middle[1] - half, middle[1] + half),
        zlim=(middle[2] - half, middle[2] + half),
    )
    view.set_box_aspect((1, 1, 1), zoom=1.5)
    view.view_init(elev=22.0, azim=-38.0)
    view.set_axis_off()
    text = "\n".join(textwrap.wrap(description, 40)[:3])
    figure.text(0.03, 0.985, text, fontsize=7.5, va="top", color="#222")
    figure.savefig(path)
