"""Drawing skinned characters without a screen: one plotter, updated between pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pyvista as pv
from PIL import Image

from actions_library.usd_skel import vertex_normals
from exporters.palette import RGB
from exporters.viewpoint import Viewpoint
from smd.geometry.arrays import FloatArray, IntArray

SUPERSAMPLING = 2
"""Factor by which pictures are drawn larger, then averaged down; the renderer's own smoothing
differs between machines."""

_GROUND_RGB = (0.972, 0.975, 0.98)
_MINOR_RGB, _MAJOR_RGB = (0.86, 0.87, 0.895), (0.72, 0.745, 0.785)
_SHADOW_RGB = (0.84, 0.85, 0.87)
# Heights above the ground, so that what lies on it does not flicker.
_SHADOW_M, _GRID_M, _PATH_M = 0.001, 0.002, 0.008

_FLAT_FROM_WORLD = np.array(
    [[1.0, -0.35, 0.0, 0.0], [0.0, 0.0, 0.0, _SHADOW_M], [0.0, -0.45, 1.0, 0.0], [0, 0, 0, 1]]
)
"""Where a light from (0.35, 1, 0.45) throws a point onto the ground."""


@dataclass(frozen=True, eq=False)
class Trace:
    """A line through the air or over the ground: ``points_m (n, 3)``, at least 2."""

    points_m: FloatArray
    rgb: RGB
    width_px: float


class Renderer:
    """A ground, characters and lines, drawn again and again from different viewpoints.

    Parameters
    ----------
    size_px
        Width and height of a picture.
    bodies
        Triangles ``(t, 3)`` and sRGB of the points ``(p, 3)`` of each character.
    """

    def __init__(
        self, size_px: tuple[int, int], bodies: Sequence[tuple[IntArray, FloatArray]]
    ) -> None:
        width, height = size_px
        self._plotter = pv.Plotter(
            off_screen=True,
            window_size=[SUPERSAMPLING * width, SUPERSAMPLING * height],
            lighting="none",
        )
        self._plotter.set_background(_GROUND_RGB)
        self._plotter.disable_anti_aliasing()
        self._bodies = [self._add_body(triangles, rgb) for triangles, rgb in bodies]
        self._traces: list[pv.Actor] = []
        self._ground: list[pv.Actor] = []

    def close(self) -> None:
        """Free the renderer."""
        self._plotter.close()

    def look_from(self, viewpoint: Viewpoint, grid_m: float) -> None:
        """Set the camera, and with it the lights and the ground's grid."""
        camera = self._plotter.camera
        camera.position, camera.focal_point = viewpoint.eye_m, viewpoint.target_m
        camera.up = (0.0, 1.0, 0.0)
        camera.view_angle = float(np.degrees(viewpoint.view_angle_rad))
        reach_m = 3.0 + 1.5 * viewpoint.width_m
        distance = float(np.linalg.norm(viewpoint.eye_m - viewpoint.target_m))
        camera.clipping_range = (0.02 * distance, distance + 2.0 * reach_m)
        self._light_from(viewpoint)
        self._lay_grid(viewpoint.target_m, reach_m, grid_m)

    def draw_traces(self, traces: Sequence[Trace]) -> None:
        """Replace the lines."""
        for actor in self._traces:
            self._plotter.remove_actor(actor, render=False)
        self._traces = [
            self._plotter.add_mesh(
                pv.lines_from_points(trace.points_m),
                color=trace.rgb,
                line_width=SUPERSAMPLING * trace.width_px,
                lighting=False,
                render=False,
            )
            for trace in traces
        ]

    def picture(self, points_m: Mapping[int, FloatArray]) -> Image.Image:
        """Return the picture with the bodies of these indices, each with its given points."""
        for index, (body, actors) in enumerate(self._bodies):
            for actor in actors:
                actor.SetVisibility(index in points_m)
            if index in points_m:
                points = points_m[index]
                body.points = points.astype(np.float32)
                normals = vertex_normals(points, body.regular_faces)
                body["Normals"] = normals.astype(np.float32)
        self._plotter.render()
        image = Image.fromarray(self._plotter.screenshot(return_img=True)[..., :3])
        return image.reduce(SUPERSAMPLING)

    def _add_body(
        self, triangles: IntArray, rgb: FloatArray
    ) -> tuple[pv.PolyData, tuple[pv.Actor, pv.Actor]]:
        body = pv.PolyData.from_regular_faces(np.zeros((len(rgb), 3), np.float32), triangles)
        body["rgb"] = np.round(255 * rgb).astype(np.uint8)
        body["Normals"] = np.tile(np.array([0.0, 1.0, 0.0], np.float32), (len(rgb), 1))
        body.GetPointData().SetActiveNormals("Normals")
        seen = self._plotter.add_mesh(
            body,
            scalars="rgb",
            rgb=True,
            smooth_shading=True,
            ambient=0.2,
            diffuse=0.9,
            specular=0.12,
            specular_power=12,
            render=False,
            copy_mesh=False,
        )
        # The shadow is the same mesh, pressed flat by its actor: its points travel to the
        # renderer once.
        shadow = self._plotter.add_mesh(
            body, color=_SHADOW_RGB, lighting=False, render=False, copy_mesh=False
        )
        shadow.user_matrix = _FLAT_FROM_WORLD
        return body, (seen, shadow)

    def _light_from(self, viewpoint: Viewpoint) -> None:
        """Place three lights about the camera: a warm key, a cool fill, a rim from behind."""
        back = viewpoint.eye_m - viewpoint.target_m
        right = np.cross([0.0, 1.0, 0.0], back)
        up = np.array([0.0, np.linalg.norm(back), 0.0])
        self._plotter.remove_all_lights()
        for direction, color, intensity in (
            (0.9 * back - 0.7 * right + 0.7 * up, (1.0, 0.98, 0.94), 0.82),
            (0.8 * back + 0.9 * right + 0.2 * up, (0.92, 0.95, 1.0), 0.5),
            (-1.0 * back + 0.4 * right + 0.9 * up, (1.0, 1.0, 1.0), 0.35),
        ):
            self._plotter.add_light(
                pv.Light(
                    position=viewpoint.target_m + direction,
                    focal_point=viewpoint.target_m,
                    color=color,
                    intensity=intensity,
                )
            )

    def _lay_grid(self, centre_m: FloatArray, reach_m: float, grid_m: float) -> None:
        """Replace the grid by one around a point that fades into the ground at ``reach_m``."""
        for actor in self._ground:
            self._plotter.remove_actor(actor, render=False)
        self._ground = []
        for every, rgb, width in ((1, _MINOR_RGB, 1.0), (2, _MAJOR_RGB, 1.4)):
            grid = _fading_grid(centre_m, reach_m, every * grid_m, rgb)
            self._ground.append(
                self._plotter.add_mesh(
                    grid,
                    scalars="rgb",
                    rgb=True,
                    line_width=SUPERSAMPLING * width,
                    lighting=False,
                    render=False,
                )
            )


def on_ground(points_m: FloatArray) -> FloatArray:
    """Return points moved straight down onto the ground, a little above its grid."""
    flat = points_m.copy()
    flat[:, 1] = _PATH_M
    return flat


def _fading_grid(centre_m: FloatArray, reach_m: float, step_m: float, rgb: RGB) -> pv.PolyData:
    """Return lines along X and Z, each step of the world, in pieces that pale outwards."""
    ticks = step_m * np.arange(-np.ceil(reach_m / step_m), np.ceil(reach_m / step_m) + 1)
    x = ticks + step_m * np.round(centre_m[0] / step_m)
    z = ticks + step_m * np.round(centre_m[2] / step_m)
    corners = np.stack(np.meshgrid(x, [_GRID_M * step_m], z, indexing="ij"), axis=-1)[:, 0]
    along_x = np.stack([corners[:-1], corners[1:]], axis=2).reshape(-1, 3)
    along_z = np.stack([corners[:, :-1], corners[:, 1:]], axis=2).reshape(-1, 3)
    points = np.concatenate([along_x, along_z])
    grid = pv.line_segments_from_points(points)
    away = np.hypot(*(points - centre_m)[:, [0, 2]].T) / reach_m
    share = np.clip(1.0 - away, 0.0, 1.0)[:, None] ** 0.8
    colors = share * np.array(rgb) + (1.0 - share) * np.array(_GROUND_RGB)
    grid["rgb"] = np.round(255 * colors).astype(np.uint8)
    return grid
