"""Draw the caterpillar and its four crawls: ``python docs/gallery/caterpillar.py``.

The first row is the body in three views. Each crawl has twelve frames of a cycle and a half from
its left, a diagram of footfalls below: a row a pair of feet, the head's on top, dark while it is
down.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw, ImageFont

from actions_library.folder import load_library
from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.arrays import FloatArray

HERE = Path(__file__).parent
LIBRARY = HERE.parents[1] / "actions_library" / "caterpillar"

CRAWLS = ("crawl", "walk", "hump", "loop")
FRAMES, CYCLES = 12, 1.5
VIEW_PX, TILE_PX = (600, 300), (150, 96)
DIAGRAM_PX = 72
INK, PAPER, DOWN_RGB = (35, 38, 42), (255, 255, 255), (70, 92, 60)

VIEWS = ((0.0, 8.0, 0.55), (-90.0, 8.0, 0.75), (-40.0, 35.0, 0.75))
"""Turn of the camera about the body, its height (°), and half of what it sees (m)."""


class Stage:
    """A character, a ground that stands still, a camera without perspective."""

    def __init__(self, character: Character, size_px: tuple[int, int]) -> None:
        self.character = character
        self.plotter = pv.Plotter(off_screen=True, window_size=list(size_px))
        self.skins = []
        for mesh in character.meshes:
            faces = np.insert(mesh.triangles, 0, 3, axis=1).ravel()
            skin = pv.PolyData(mesh.points_m.copy(), faces)
            rgb = np.asarray(mesh.color_rgb) ** (1.0 / 2.2)
            self.plotter.add_mesh(skin, color=rgb, smooth_shading=True)
            self.skins.append(skin)
        ground = pv.Plane(
            center=(0.0, 0.0, 0.0),
            direction=(0.0, 1.0, 0.0),
            i_size=4.0,
            j_size=4.0,
            i_resolution=16,
            j_resolution=16,
        )
        self.plotter.add_mesh(ground, style="wireframe", color="#c6cbd0")
        self.plotter.enable_parallel_projection()

    def shot(
        self, clip: Clip, frame: float, turn_deg: float, up_deg: float, half_m: float
    ) -> Image:
        """Return a picture of a frame of a clip that repeats."""
        last = len(clip) - 1
        cycle, own = divmod(round(frame), last) if clip.cyclic else (0, min(round(frame), last))
        world_q, world_m = forward_kinematics(
            clip.skeleton, clip.rotation_xyzw[own], clip.translation_m[own]
        )
        way_m = cycle * (clip.translation_m[-1, 0] - clip.translation_m[0, 0])
        for skin, mesh in zip(self.skins, self.character.meshes, strict=True):
            skin.points = skin_points(mesh, clip.skeleton, world_q, world_m) + way_m
            skin.compute_normals(cell_normals=False, inplace=True)
        at = world_m[0] + way_m + np.array([0.0, 0.17, 0.03])
        turn, up = np.radians([turn_deg, up_deg])
        away = np.array([np.sin(turn) * np.cos(up), np.sin(up), np.cos(turn) * np.cos(up)])
        self.plotter.camera.position = at + 5.0 * away
        self.plotter.camera.focal_point = at
        self.plotter.camera.up = (0.0, 1.0, 0.0)
        width, height = self.plotter.window_size
        self.plotter.camera.parallel_scale = half_m * height / width
        self.plotter.camera.clipping_range = (0.1, 20.0)
        self.plotter.render()
        return Image.fromarray(self.plotter.screenshot(return_img=True))


def footfalls(clip: Clip, size_px: tuple[int, int], cycles: float) -> Image.Image:
    """Return when each pair of feet is down: a row a pair, the one nearest to the head on top."""
    last = len(clip) - 1
    pairs = clip.contacts[:, ::2] & clip.contacts[:, 1::2]
    column = np.arange(size_px[0]) / size_px[0] * cycles * last
    on = pairs[column.astype(int) % last].T[::-1]
    sheet = np.full((size_px[1], size_px[0], 3), 236, dtype=np.uint8)
    high = size_px[1] / len(on)
    for i, row in enumerate(on):
        top, bottom = round(i * high) + 1, round((i + 1) * high) - 1
        sheet[top:bottom, row] = DOWN_RGB
    return Image.fromarray(sheet)


def strip(stage: Stage, clip: Clip, frames: FloatArray, *, turn_deg: float, half_m: float) -> Image:
    """Return frames of a clip side by side."""
    tiles = [stage.shot(clip, frame, turn_deg, 6.0, half_m) for frame in frames]
    row = Image.new("RGB", (len(tiles) * tiles[0].width, tiles[0].height), PAPER)
    for i, tile in enumerate(tiles):
        row.paste(tile, (i * tile.width, 0))
    return row


def main() -> None:
    """Draw the picture."""
    library = load_library(LIBRARY)
    idle = library.clip("idle")
    large, small = (Stage(library.character, size) for size in (VIEW_PX, TILE_PX))
    rows = [Image.new("RGB", (3 * VIEW_PX[0], VIEW_PX[1]), PAPER)]
    for i, (turn, up, half) in enumerate(VIEWS):
        rows[0].paste(large.shot(idle, 0, turn, up, half), (i * VIEW_PX[0], 0))
    width = rows[0].width
    for name in CRAWLS:
        clip = library.clip(name)
        frames = np.linspace(0.0, CYCLES * (len(clip) - 1), FRAMES, endpoint=False)
        title = Image.new("RGB", (width, 20), PAPER)
        text = f"{name}: {100.0 * clip.travel_m:.0f} cm in {clip.duration_s:.2f} s"
        ImageDraw.Draw(title).text((6, 3), text, INK, ImageFont.load_default(13))
        rows += [title, strip(small, clip, frames, turn_deg=-90.0, half_m=0.66)]
        rows.append(footfalls(clip, (width, DIAGRAM_PX), CYCLES))
    sheet = Image.new("RGB", (width, sum(row.height for row in rows)), PAPER)
    top = 0
    for row in rows:
        sheet.paste(row, (0, top))
        top += row.height
    path = HERE / "caterpillar.png"
    sheet.quantize(96, Image.Quantize.MAXCOVERAGE).save(path, optimize=True)
    print(f"{path.name}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
