"""The process that draws a filmstrip: ``python -m exporters.strip USD PNG ROWS``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from exporters.figures import Figure, Scene, read_scene
from exporters.filmstrip import REFUSED
from exporters.palette import RGB, action_colors
from exporters.rendering import Renderer, Trace, on_ground
from exporters.viewpoint import Viewpoint, fitted
from laban import AXES, Effort
from smd.errors import SmdError
from smd.geometry.arrays import FloatArray

COLUMNS = 8
CELL_PX = (250, 270)
LABEL_PX, HEADER_PX, GAP_PX, MARGIN_PX = 215, 44, 4, 8
WIDE_M = 4.0
"""Width of a picture from which on the grid has a line each metre, else each half."""

WINDOW_S = 1.5
"""Length of a row where there are no phrases; longer where there would be too many rows."""

_PATH_SAMPLES = 48
_RAISED_RAD = np.radians(14.0)
_BESIDE_RAD = np.radians([50.0, -50.0, 35.0, -35.0, 22.0, -22.0])
"""Angles of the camera from the body's front, the preferred view first."""

_WORTH = 0.85
"""A less preferred view is used if its pictures are at most this share of the best one's width."""

_WINDOW_RGB: RGB = (0.12, 0.47, 0.71)
_INK, _FAINT, _PAPER, _FRAME = (35, 38, 42), (96, 102, 110), (250, 250, 250), (205, 208, 213)


@dataclass(frozen=True, eq=False)
class Row:
    """A stretch of one figure's performance; ``action`` is None where there are no phrases."""

    action: str | None
    figure: int
    start_s: float
    end_s: float
    effort: Effort
    rgb: RGB


def draw_filmstrip(usd_path: Path, png_path: Path, most_rows: int) -> None:
    """Draw the filmstrip; see `exporters.filmstrip.write_filmstrip`."""
    scene = read_scene(usd_path)
    every = list(_rows(scene, most_rows))
    rows = every[:most_rows]
    renderer = Renderer(CELL_PX, [(figure.triangles, figure.point_rgb) for figure in scene.figures])
    width = LABEL_PX + COLUMNS * (CELL_PX[0] + GAP_PX) + MARGIN_PX
    sheet = Image.new(
        "RGB", (width, HEADER_PX + len(rows) * (CELL_PX[1] + GAP_PX) + GAP_PX), _PAPER
    )
    pen = ImageDraw.Draw(sheet)
    pen.text((MARGIN_PX, 10), _header(usd_path, scene, rows, len(every)), _INK, _font(20))
    for index, row in enumerate(rows):
        top = HEADER_PX + index * (CELL_PX[1] + GAP_PX)
        cells, measures = _draw_row(scene, row, renderer)
        _label(pen, top, scene, row, measures)
        for column, (time_s, cell) in enumerate(cells):
            left = LABEL_PX + column * (CELL_PX[0] + GAP_PX)
            sheet.paste(cell, (left, top))
            pen.rectangle((left, top, left + CELL_PX[0], top + CELL_PX[1]), outline=_FRAME)
            pen.text((left + 7, top + 5), f"{time_s:.2f} s", _FAINT, _font(13))
    renderer.close()
    sheet.save(png_path, format="PNG")


def _rows(scene: Scene, most_rows: int) -> Iterator[Row]:
    """Yield the phrases in time order, or, where there are none, windows of all the time."""
    colors = action_colors(phrase.action for f in scene.figures for phrase in f.phrases)
    phrases = [
        Row(p.action, index, p.start_s, p.end_s, p.effort, colors[p.action])
        for index, figure in enumerate(scene.figures)
        for p in figure.phrases
        if p.end_s > scene.first_s and p.start_s < scene.last_s
    ]
    if phrases:
        yield from sorted(phrases, key=lambda row: (row.start_s, row.figure))
        return
    wanted = int(np.ceil((scene.last_s - scene.first_s) / WINDOW_S))
    count = max(1, min(wanted, most_rows // len(scene.figures)))
    edges = np.linspace(scene.first_s, scene.last_s, count + 1)
    for start_s, end_s in pairwise(edges.tolist()):
        for index in range(len(scene.figures)):
            yield Row(None, index, start_s, end_s, Effort(), _WINDOW_RGB)


def _draw_row(
    scene: Scene, row: Row, renderer: Renderer
) -> tuple[list[tuple[float, Image.Image]], list[str]]:
    """Return a row's times and pictures, and lines that say how large what they show is."""
    figure = scene.figures[row.figure]
    times_s = np.linspace(row.start_s, row.end_s, COLUMNS)
    codes = [scene.time_code(time_s) for time_s in times_s.tolist()]
    bodies = [figure.points_m(code) for code in codes]
    path = _body_path(scene, figure, row)
    drawn = _drawn_path(scene, figure, row)
    drawn = path if drawn is None else drawn
    viewpoint = _viewpoint(figure, codes, np.concatenate([*bodies, on_ground(path)]))
    grid_m = 0.5 if viewpoint.width_m < WIDE_M else 1.0
    renderer.look_from(viewpoint, grid_m)
    pictures = []
    for column, (time_s, body) in enumerate(zip(times_s.tolist(), bodies, strict=True)):
        renderer.draw_traces(_traces(path, drawn, column / (COLUMNS - 1), row.rgb))
        pictures.append((time_s, renderer.picture({row.figure: body})))
    travel_m = float(np.linalg.norm(np.diff(path[:, [0, 2]], axis=0), axis=1).sum())
    lines = [
        f"body goes {travel_m:.2f} m",
        f"cell {viewpoint.width_m:.1f} m wide",
        f"grid {grid_m:g} m",
    ]
    return pictures, lines


def _body_path(scene: Scene, figure: Figure, row: Row) -> FloatArray:
    """Return the path of the mean of the body's joints, ``(n, 3)``."""
    times_s = np.linspace(row.start_s, row.end_s, _PATH_SAMPLES).tolist()
    return np.array([figure.joints_m(scene.time_code(t)).mean(axis=0) for t in times_s])


def _viewpoint(figure: Figure, codes: list[float], points: FloatArray) -> Viewpoint:
    """Return a camera before the body, a little above it, from which it is seen large.

    In place that is beside its front. Where it travels, a view along its way has less to hold.
    """
    front = np.sum([figure.front(code) for code in codes], axis=0)
    heading = np.arctan2(front[0], front[2]) + _BESIDE_RAD
    level, raised = np.cos(_RAISED_RAD), np.sin(_RAISED_RAD)
    views = [
        fitted(
            points,
            [level * np.sin(angle), raised, level * np.cos(angle)],
            aspect=CELL_PX[0] / CELL_PX[1],
        )
        for angle in heading
    ]
    best = views[0]
    for view in views[1:]:
        if view.width_m < _WORTH * best.width_m:
            best = view
    return best


def _drawn_path(scene: Scene, figure: Figure, row: Row) -> FloatArray | None:
    """Return the path of the prop, ``(n, 3)``; None where the file has no prop."""
    times_s = np.linspace(row.start_s, row.end_s, _PATH_SAMPLES).tolist()
    places = [figure.prop_m(scene.time_code(t)) for t in times_s]
    return None if places[0] is None else np.array(places)


def _traces(path: FloatArray, drawn: FloatArray, done: float, rgb: RGB) -> list[Trace]:
    """Return what was drawn, pale, and the body's path so far, in full colour, on the ground."""
    pale = tuple(0.45 * c + 0.55 for c in rgb)
    traces = [Trace(on_ground(drawn), (pale[0], pale[1], pale[2]), 2.0)]
    gone = round(done * (len(path) - 1)) + 1
    if gone > 1:
        raised = on_ground(path)[:gone] + np.array([0.0, 0.004, 0.0])
        traces.append(Trace(raised, rgb, 3.5))
    return traces


def _header(path: Path, scene: Scene, rows: list[Row], count: int) -> str:
    """Say what the sheet shows: how many of what, and when."""
    kind = "time window" if rows[0].action is None else "phrase"
    shown = f"the first {len(rows)} of " if len(rows) < count else ""
    joints = scene.figures[0].joint_count
    return (
        f"{path.name}    {_counted(len(scene.figures), 'character')}, {joints} joints"
        f"    {scene.first_s:.2f} to {scene.last_s:.2f} s    {shown}{_counted(count, kind)}"
    )


def _counted(count: int, thing: str) -> str:
    return f"{count} {thing}{'' if count == 1 else 's'}"


def _label(pen: ImageDraw.ImageDraw, top: int, scene: Scene, row: Row, measures: list[str]) -> None:
    """Write what a row shows to its left."""
    color = tuple(round(255 * c) for c in row.rgb)
    pen.rectangle((MARGIN_PX, top + 8, MARGIN_PX + 5, top + 34), fill=color)
    pen.text((MARGIN_PX + 13, top + 6), row.action or "no phrase", _INK, _font(22))
    lines = [scene.figures[row.figure].name] if len(scene.figures) > 1 else []
    lines.append(f"{row.start_s:.2f} to {row.end_s:.2f} s")
    lines += [
        f"{axis} {value:+.2f}" for axis in AXES if (value := getattr(row.effort, axis)) is not None
    ]
    for index, line in enumerate([*lines, *measures]):
        pen.text((MARGIN_PX + 13, top + 40 + 22 * index), line, _FAINT, _font(16))


def _font(size_px: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size_px)


def main(arguments: list[str]) -> int:
    """Draw, or print in one line on the standard error what went wrong."""
    usd_path, png_path, rows = arguments
    try:
        draw_filmstrip(Path(usd_path), Path(png_path), int(rows))
    except SmdError as error:
        print(error, file=sys.stderr)
        return REFUSED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
