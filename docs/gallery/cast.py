"""Draw the dragon and the moon: ``python docs/gallery/cast.py [FOLDER]``.

Two pictures of what they are and do, or, with a folder, all they do: a strip of each clip there,
from the front and from the side, and each shape in a close-up.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw, ImageFont

from actions_library.folder import load_library
from actions_library.library import Library
from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.arrays import FloatArray

HERE = Path(__file__).parent
LIBRARIES = HERE.parents[1] / "actions_library"

GAMMA = 2.2
STRIP_FRAMES = 14
STRIP_PX, CLOSE_PX = (150, 130), (200, 200)

DRAGON_M, DRAGON_FAR_M = (0.0, 0.42, -0.10), 4.6
DRAGON_FACE_M, DRAGON_FACE_FROM_M = (0.0, 0.82, 0.40), (0.70, 0.98, 1.45)
MOON_M, MOON_FAR_M = (0.0, 0.18, 0.0), 1.15
"""Where cameras look, and from how far."""


class Studio:
    """A character before a camera, posed again and again."""

    def __init__(self, character: Character, size_px: tuple[int, int], *, ground: bool) -> None:
        self.character = character
        self.plotter = pv.Plotter(off_screen=True, window_size=list(size_px))
        self.plotter.set_background("white")
        self.surfaces = []
        for mesh in character.meshes:
            faces = np.insert(mesh.triangles, 0, 3, axis=1).ravel()
            surface = pv.PolyData(np.array(mesh.points_m), faces)
            color = np.clip(mesh.color_rgb, 0.0, 1.0) ** (1.0 / GAMMA)
            self.plotter.add_mesh(surface, color=color, smooth_shading=False, lighting=True)
            self.surfaces.append(surface)
        for actor in self.plotter.actors.values():
            actor.prop.interpolation = "Phong"
        self.ground = None
        if ground:
            plane = pv.Plane(
                direction=(0, 1, 0), i_size=3.0, j_size=3.0, i_resolution=6, j_resolution=6
            )
            self.ground = self.plotter.add_mesh(
                plane, style="wireframe", color="#c9ced4", lighting=False
            )
        self.plotter.camera.up = (0.0, 1.0, 0.0)

    def shot(
        self,
        clip: Clip | None,
        frame: int,
        weights: Mapping[str, float],
        looks_at_m: FloatArray,
        from_m: FloatArray,
        angle_deg: float,
    ) -> Image.Image:
        """Return a picture of a clip's frame, or of the bind pose with some shapes."""
        skeleton = self.character.skeleton
        local = (skeleton.rest_rotation_xyzw, skeleton.rest_translation_m)
        if clip is not None:
            local = (clip.rotation_xyzw[frame], clip.translation_m[frame])
            row = clip.tracks.value[frame]
            weights = dict(zip(clip.tracks.names, row.tolist(), strict=True))
        turned, placed = forward_kinematics(skeleton, *local)
        root = placed[0] * [1.0, 0.0, 1.0]
        for mesh, surface in zip(self.character.meshes, self.surfaces, strict=True):
            own = np.array([weights.get(shape.name, 0.0) for shape in mesh.shapes])
            surface.points = skin_points(mesh, skeleton, turned, placed, own)
            surface.compute_normals(inplace=True, split_vertices=False, auto_orient_normals=False)
        if self.ground is not None:
            self.ground.position = tuple(np.round(root / 0.5) * 0.5)
        camera = self.plotter.camera
        camera.focal_point, camera.position = root + looks_at_m, root + from_m
        camera.view_angle = angle_deg
        self.plotter.reset_camera_clipping_range()
        self.plotter.render()
        return Image.fromarray(self.plotter.screenshot(return_img=True))


def tiled(pictures: Iterable[Image.Image], columns: int) -> Image.Image:
    """Return pictures of one size, in rows."""
    pictures = list(pictures)
    width, height = pictures[0].size
    sheet = Image.new("RGB", (width * columns, height * -(-len(pictures) // columns)), "white")
    for k, picture in enumerate(pictures):
        sheet.paste(picture, (k % columns * width, k // columns * height))
    return sheet


def labelled(picture: Image.Image, text: str) -> Image.Image:
    """Return a picture with a line of text at its top."""
    ImageDraw.Draw(picture).text((5, 2), text, (35, 38, 42), ImageFont.load_default(13))
    return picture


def around(middle_m: Iterable[float], far_m: float, angle_deg: float, up_m: float) -> FloatArray:
    """Return a place at an angle from the front, to the left, about a middle."""
    angle = np.radians(angle_deg)
    away = np.array([far_m * np.sin(angle), up_m, far_m * np.cos(angle)])
    return np.array(tuple(middle_m)) + away


def strip(studio: Studio, library: Library, name: str, count: int, face: bool) -> Image.Image:
    """Return so many frames of a clip, from the front and, of a whole body, from its left."""
    clip = library.clip(name)
    frames = np.round(np.linspace(0, len(clip) - 1, count)).astype(int)
    rows = []
    for angle in (18.0,) if face else (25.0, 90.0):
        middle, far = (MOON_M, MOON_FAR_M) if face else (DRAGON_M, DRAGON_FAR_M)
        up = 0.02 if face else 0.7
        if name in ("fly", "jump"):
            middle, far = (0.0, 0.66, -0.10), 5.6
        place = around(middle, far, angle, up)
        rows += [
            studio.shot(clip, int(k), {}, np.array(middle), place, 18.5 if face else 18.0)
            for k in frames
        ]
    labelled(rows[0], name)
    return tiled(rows, count)


def shapes_sheet(library: Library, face: bool, columns: int) -> Image.Image:
    """Return each shape at weight 1, those of the right side left out."""
    studio = Studio(library.character, CLOSE_PX, ground=False)
    shown = ["", *(name for name in library.character.shapes if not name.startswith("right_"))]
    middle = MOON_M if face else DRAGON_FACE_M
    place = around(MOON_M, MOON_FAR_M, 18.0, 0.02) if face else np.array(DRAGON_FACE_FROM_M)
    return tiled(
        (
            labelled(
                studio.shot(None, 0, {name: 1.0}, np.array(middle), place, 18.5 if face else 21.0),
                name or "at rest",
            )
            for name in shown
        ),
        columns,
    )


def views(library: Library, face: bool) -> Image.Image:
    """Return the character idling, from the front, half from the side, and from the side."""
    studio = Studio(library.character, (420, 360), ground=not face)
    middle, far = (MOON_M, 1.3) if face else (DRAGON_M, DRAGON_FAR_M)
    clip = library.clip("idle")
    return tiled(
        (
            studio.shot(
                clip,
                0,
                {},
                np.array(middle),
                around(middle, far, angle, 0.02 if face else 0.6),
                17.0,
            )
            for angle in (0.0, 45.0, 90.0)
        ),
        3,
    )


def stacked(pictures: Iterable[Image.Image]) -> Image.Image:
    """Return pictures one below the other."""
    pictures = list(pictures)
    width, height = max(p.width for p in pictures), sum(p.height for p in pictures)
    sheet = Image.new("RGB", (width, height), "white")
    y = 0
    for picture in pictures:
        sheet.paste(picture, (0, y))
        y += picture.height
    return sheet


def saved(picture: Image.Image, path: Path) -> None:
    """Write a picture in few colours, and say so."""
    picture.quantize(128, Image.Quantize.MAXCOVERAGE).save(path, optimize=True)
    print(path.name)


def main() -> None:
    """Draw both pictures, or everything into a folder."""
    dragon, moon = (load_library(LIBRARIES / name) for name in ("dragon", "moon"))
    if len(sys.argv) > 1:
        folder = Path(sys.argv[1])
        for library, face in ((dragon, False), (moon, True)):
            studio = Studio(library.character, STRIP_PX, ground=not face)
            saved(views(library, face), folder / f"{library.name}.views.png")
            saved(shapes_sheet(library, face, 6), folder / f"{library.name}.shapes.png")
            for action in library.actions:
                picture = strip(studio, library, action.name, STRIP_FRAMES, face)
                saved(picture, folder / f"{library.name}.{action.name}.png")
        return
    studio = Studio(dragon.character, STRIP_PX, ground=True)
    rows = [strip(studio, dragon, name, 8, False) for name in ("walk", "fly", "roar")]
    saved(stacked([views(dragon, False), *rows]), HERE / "creature.png")
    names = ("smile", "frown", "sad", "surprise", "wink", "yawn", "kiss", "huff")
    studio = Studio(moon.character, (300, 300), ground=False)
    middle = np.array(MOON_M)
    shots = []
    for name in names:
        clip = moon.clip(name)
        frame = int(0.5 * (clip.stage_end_frames[1] + clip.stage_end_frames[2]))
        place = around(MOON_M, MOON_FAR_M, 14.0, 0.02)
        shots.append(labelled(studio.shot(clip, frame, {}, middle, place, 18.5), name))
    saved(tiled(shots, 4), HERE / "mask.png")


if __name__ == "__main__":
    main()
