"""Drawing skinned characters without a screen: one plotter, whose points move between pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from exporters.palette import RGB
from exporters.viewpoint import Viewpoint
from smd.geometry.arrays import FloatArray, IntArray

SUPERSAMPLING = 2
"""Pictures are drawn that much larger and averaged down; the renderer's own smoothing differs
between machines."""

GRID_M = 0.5
_GROUND_RGB, _MINOR_RGB, _MAJOR_RGB = (0.965, 0.968, 0.972), (0.87, 0.88, 0.90), (0.74, 0.76, 0.80)
_SHADOW_RGB = (0.84, 0.85, 0.87)
_LIGHT_FROM = np.array([0.35, 1.0, 0.45])
"""Where the light that casts the shadows comes from."""

# Heights above the ground, so that what lies on it does not flicker.
_SHADOW_M, _GRID_M, _PATH_M = 0.001, 0.002, 0.008


@dataclass(frozen=True, eq=False)
class Trace:
    """A line through the air or over the ground: ``points_m (n, 3)``, at least 2."""

    points_m: FloatArray
    rgb: RGB
    width_px: float


class Stage:
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
        self._plotter.set_background("white")
        self._bodies = [self._add_body(triangles, rgb) for triangles, rgb in bodies]
        self._traces: list[pv.Actor] = []
        self._ground: list[pv.Actor] = []
        self._lights: list[pv.Light] = []

    def close(self) -> None:
        """Free the renderer."""
        self._plotter.close()

    def look_from(self, viewpoint: Viewpoint, reach_m: float) -> None:
        """Set the camera, and with it the lights and the ground up to ``reach_m`` around."""
        camera = self._plotter.camera
        camera.position, camera.focal_point = viewpoint.eye_m, viewpoint.target_m
        camera.up = (0.0, 1.0, 0.0)
        camera.view_angle = float(np.degrees(viewpoint.view_angle_rad))
        distance = float(np.linalg.norm(viewpoint.eye_m - viewpoint.target_m))
        camera.clipping_range = (0.02 * distance, distance + 4.0 * reach_m)
        self._light_from(viewpoint)
        self._lay_ground(viewpoint.target_m, reach_m)

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

    def picture(self, points_m: Mapping[int, FloatArray]) -> NDArray[np.uint8]:
        """Return the picture ``(height, width, 3)`` with the bodies of these indices in it."""
        for index, (body, shadow, actors) in enumerate(self._bodies):
            for actor in actors:
                actor.SetVisibility(index in points_m)
            if index in points_m:
                body.points = points_m[index]
                body["Normals"] = _normals(body)
                shadow.points = _shadow(points_m[index])
        self._plotter.render()
        image = self._plotter.screenshot(return_img=True)[..., :3]
        k = SUPERSAMPLING
        height, width = image.shape[0] // k, image.shape[1] // k
        blocks = image[: k * height, : k * width].reshape(height, k, width, k, 3)
        return np.round(blocks.mean(axis=(1, 3))).astype(np.uint8)

    def _add_body(
        self, triangles: IntArray, rgb: FloatArray
    ) -> tuple[pv.PolyData, pv.PolyData, tuple[pv.Actor, pv.Actor]]:
        body = pv.PolyData.from_regular_faces(np.zeros((len(rgb), 3)), triangles)
        body["rgb"] = np.round(255 * rgb).astype(np.uint8)
        body["Normals"] = np.tile([0.0, 1.0, 0.0], (len(rgb), 1))
        body.GetPointData().SetActiveNormals("Normals")
        shadow = pv.PolyData.from_regular_faces(np.zeros((len(rgb), 3)), triangles)
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
        cast = self._plotter.add_mesh(shadow, color=_SHADOW_RGB, lighting=False, render=False)
        return body, shadow, (seen, cast)

    def _light_from(self, viewpoint: Viewpoint) -> None:
        """Place three lights about the camera: a warm key, a cool fill, a rim from behind."""
        back = viewpoint.eye_m - viewpoint.target_m
        right = np.cross([0.0, 1.0, 0.0], back)
        up = np.array([0.0, np.linalg.norm(back), 0.0])
        self._plotter.remove_all_lights()
        for direction, color, intensity in (
            (0.7 * back - 0.7 * right + 0.9 * up, (1.0, 0.98, 0.94), 0.85),
            (0.8 * back + 0.9 * right + 0.2 * up, (0.92, 0.95, 1.0), 0.42),
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

    def _lay_ground(self, centre_m: FloatArray, reach_m: float) -> None:
        """Replace the ground by one around a point, with a line each half metre."""
        for actor in self._ground:
            self._plotter.remove_actor(actor, render=False)
        steps = int(np.ceil(reach_m / (2 * GRID_M)))
        middle = np.round(centre_m[[0, 2]]).astype(float)
        ticks = GRID_M * np.arange(-2 * steps, 2 * steps + 1)
        whole = np.arange(len(ticks)) % 2 == 0
        plane = pv.Plane(
            center=(middle[0], 0.0, middle[1]),
            direction=(0, 1, 0),
            i_size=2 * ticks[-1],
            j_size=2 * ticks[-1],
        )
        add = self._plotter.add_mesh
        self._ground = [add(plane, color=_GROUND_RGB, lighting=False, render=False)]
        for which, rgb, width in ((~whole, _MINOR_RGB, 1.0), (whole, _MAJOR_RGB, 1.4)):
            lines = _grid(middle, ticks[which], float(ticks[-1]))
            self._ground.append(
                add(
                    lines, color=rgb, line_width=SUPERSAMPLING * width, lighting=False, render=False
                )
            )


def on_ground(points_m: FloatArray) -> FloatArray:
    """Return points moved straight down onto the ground, a little above its grid."""
    flat = points_m.copy()
    flat[:, 1] = _PATH_M
    return flat


def _grid(middle: FloatArray, ticks: FloatArray, end: float) -> pv.PolyData:
    """Return lines along X and Z at the ticks around a point."""
    edge = np.full_like(ticks, end)
    along_z = np.stack([np.column_stack([ticks, -edge]), np.column_stack([ticks, edge])], axis=1)
    flat = np.concatenate([along_z, along_z[..., ::-1]]).reshape(-1, 2) + middle
    points = np.column_stack([flat[:, 0], np.full(len(flat), _GRID_M), flat[:, 1]])
    return pv.line_segments_from_points(points)


def _shadow(points_m: FloatArray) -> FloatArray:
    """Return where the light throws points onto the ground."""
    flat = points_m - points_m[:, 1:2] / _LIGHT_FROM[1] * _LIGHT_FROM
    flat[:, 1] = _SHADOW_M
    return flat


def _normals(body: pv.PolyData) -> FloatArray:
    from actions_library.usd_skel import vertex_normals

    return vertex_normals(np.asarray(body.points, float), body.regular_faces)
