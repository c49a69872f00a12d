"""Draw a second of some movements, as drawn and as planned: ``python docs/gallery/timings.py``.

Each picture has 24 frames of a second, from the front and from the side: first as drawn, then as
planned.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw, ImageFont

import smd
from smd.acting.performance import Actor, Performance
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.arrays import FloatArray

HERE = Path(__file__).parent
RECORDINGS = HERE.parents[1] / "recordings"

FRAMES, RATE_HZ = 24, 24.0
TILE_PX = (88, 132)
"""Width and height of a frame."""

CAMERA_M, LOOKS_AT_M = 6.2, 0.95
"""Distance of the camera from the body, and height that it looks at."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A movement to draw.

    Attributes
    ----------
    name : of the picture.
    story, device : who does it.
    action : of the phrase, the first of its kind.
    share : where in that phrase the second begins.
    """

    name: str
    story: str
    device: str
    action: str
    share: float


MOMENTS = (
    Moment("side-step", "duel", "rival", "side_step_left", 0.35),
    Moment("fence-jump", "postman", "postman", "jump", 0.35),
    Moment("punch", "duel", "knight", "punch", 0.2),
    Moment("throw", "duel", "rival", "throw", 0.35),
    Moment("landing", "fledgling", "bird", "fly", 0.75),
)


def main() -> None:
    """Draw each of the moments."""
    library = smd.load_library()
    for story in dict.fromkeys(moment.story for moment in MOMENTS):
        recording = smd.read_recording(RECORDINGS / f"{story}.csv")
        score = smd.parse(recording, library)
        played = [
            smd.animate(score, recording, library, rate_hz=RATE_HZ, timing=timing)
            for timing in ("drawn", "feasible")
        ]
        for moment in MOMENTS:
            if moment.story == story:
                draw(moment, played, HERE / f"timing-{moment.name}.png")


def draw(moment: Moment, played: list[Performance], path: Path) -> None:
    """Draw a moment of the same take in each of some performances, one below the other."""
    rows = []
    for performance, said in zip(played, ("as drawn", "as a body can"), strict=True):
        actor = next(a for a in performance.actors if a.name == moment.device)
        phrase = next(one for one in actor.phrases if one.action == moment.action)
        begin_s = phrase.start_s + moment.share * (phrase.end_s - phrase.start_s)
        first = round((begin_s - performance.start_s) * performance.rate_hz)
        frames = np.minimum(np.arange(first, first + FRAMES), len(performance) - 1)
        for side in (False, True):
            tiles = [tile(actor, int(frame), side=side) for frame in frames]
            row = Image.new("RGB", (FRAMES * TILE_PX[0], TILE_PX[1]), "white")
            for i, one in enumerate(tiles):
                row.paste(one, (i * TILE_PX[0], 0))
            if not side:
                text = f"{phrase.action}, {said}, from {begin_s:.2f} s"
                font = ImageFont.load_default(13)
                ImageDraw.Draw(row).text((6, 2), text, (35, 38, 42), font)
            rows.append(row)
    sheet = Image.new("RGB", (rows[0].width, sum(row.height for row in rows)), "white")
    for i, row in enumerate(rows):
        sheet.paste(row, (0, i * TILE_PX[1]))
    sheet.quantize(128, Image.Quantize.MAXCOVERAGE).save(path, optimize=True)
    print(path.name)


def tile(actor: Actor, frame: int, *, side: bool) -> Image.Image:
    """Return a picture of an actor in one frame, from its front or from its left."""
    skeleton, poses = actor.character.skeleton, actor.poses
    local = poses.rotation_xyzw[frame], poses.translation_m[frame]
    world_q, world_m = forward_kinematics(skeleton, *local)
    plotter = pv.Plotter(off_screen=True, window_size=list(TILE_PX))
    for mesh in actor.character.meshes:
        points = skin_points(mesh, skeleton, world_q, world_m)
        faces = np.insert(mesh.triangles, 0, 3, axis=1).ravel()
        plotter.add_mesh(pv.PolyData(points, faces), color="#c8a27a", smooth_shading=True)
    root = world_m[0] * [1.0, 0.0, 1.0]
    cell = np.round(root / 0.5) * 0.5  # the grid stands still while the camera goes along
    ground = pv.Plane(
        center=cell,
        direction=(0.0, 1.0, 0.0),
        i_size=3.0,
        j_size=3.0,
        i_resolution=6,
        j_resolution=6,
    )
    plotter.add_mesh(ground, style="wireframe", color="#b9bec4")
    up = np.array([0.0, 1.0, 0.0])
    plotter.camera.position = root + _away(world_q[0], side=side) + 1.3 * up
    plotter.camera.focal_point = root + LOOKS_AT_M * up
    plotter.camera.up = (0.0, 1.0, 0.0)
    plotter.camera.view_angle = 22.0
    shot = plotter.screenshot(return_img=True)
    plotter.close()
    return Image.fromarray(shot)


def _away(heading_xyzw: FloatArray, *, side: bool) -> FloatArray:
    """Return where the camera is from the body, over the ground."""
    angle = 2.0 * np.arctan2(heading_xyzw[1], heading_xyzw[3]) + (0.5 * np.pi if side else 0.0)
    return CAMERA_M * np.array([np.sin(angle), 0.0, np.cos(angle)])


if __name__ == "__main__":
    main()
