"""What a USD file holds beside the characters: the doodle, the prop, the ground and a camera."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt

from actions_library.stage_frame import StageFrame
from actions_library.usd_skel import define_material, define_mesh
from exporters.palette import IDLE_RGB, RGB, linear_from_srgb
from smd.acting.performance import Actor, Performance
from smd.acting.terrain import Terrain
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.score import Phrase

DOODLE_WIDTH_M = 0.03
GROUND_RGB: RGB = (0.78, 0.79, 0.80)
PROP_RGB: RGB = (0.95, 0.55, 0.10)
BACK = np.array([0.45, 0.35, 1.0]) / np.linalg.norm([0.45, 0.35, 1.0])
"""Direction from the performers to the camera."""

WIDE = 16.0 / 9.0
_HEIGHT_MM, _FOCAL_MM = 20.25, 40.0  # of Super 35 film, the lens long enough to bend nothing
_HALF_HEIGHT = 0.5 * _HEIGHT_MM / _FOCAL_MM / 1.08  # room around what is seen

MARGIN_M = 2.0
"""Margin of the ground around everything on it."""

HELD = np.array([0.1, 0.2, 0.7])
"""Size of a prop in a hand, over that of one that shows where it was drawn: it fits into a fist."""

REACH_M = 0.3
"""Greatest extent of a prop from its position."""

# A dart, its nose to +Z and its fin to +Y: it shows which way the prop faces and which is up.
_DART_M = 0.4 * np.array(
    [[0.0, 0.0, 0.6], [0.4, 0.0, -0.4], [-0.4, 0.0, -0.4], [0.0, 0.25, -0.4], [0.0, -0.1, -0.3]]
)
_DART_FACES = np.array([[0, 1, 3], [0, 3, 2], [1, 2, 3], [0, 4, 1], [0, 2, 4], [1, 4, 2]])


def define_doodle(
    stage: Usd.Stage, path: str, actor: Actor, action_colors: Mapping[str, RGB]
) -> None:
    """Define the doodle as linear curves: one a stretch, in its phrase's colour, idle ones grey.

    Stretches that follow each other share the point between them. A doodle of a single sample
    draws nothing.
    """
    points, counts, colors = [], [], []
    for doodle in actor.doodles:
        for action, stretch in stretches(doodle, actor.phrases):
            points.append(doodle.position_m[stretch])
            counts.append(len(points[-1]))
            colors.append(action_colors[action] if action else IDLE_RGB)
    if not points:
        return
    frame = StageFrame.of(stage)
    drawn = frame.points(np.concatenate(points)).astype(np.float32)
    curves = UsdGeom.BasisCurves.Define(stage, path)
    curves.CreateTypeAttr(UsdGeom.Tokens.linear)
    curves.CreateWrapAttr(UsdGeom.Tokens.nonperiodic)
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(drawn))
    curves.CreateCurveVertexCountsAttr(counts)
    curves.CreateWidthsAttr([frame.length(DOODLE_WIDTH_M)])
    curves.SetWidthsInterpolation(UsdGeom.Tokens.constant)
    radius = 0.5 * frame.length(DOODLE_WIDTH_M)
    box = np.stack([drawn.min(axis=0) - radius, drawn.max(axis=0) + radius])
    curves.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(box))
    seen = list(dict.fromkeys(colors))
    shown = curves.CreateDisplayColorPrimvar(UsdGeom.Tokens.uniform)
    shown.Set(Vt.Vec3fArray.FromNumpy(linear_from_srgb(seen).astype(np.float32)))
    shown.SetIndices(Vt.IntArray([seen.index(color) for color in colors]))


def stretches(doodle: Doodle, phrases: Sequence[Phrase]) -> Iterator[tuple[str, slice]]:
    """Yield each stretch of a doodle with its phrase's action, empty where there is none.

    A stretch has at least two samples; its last is the next one's first.
    """
    starts = np.array([phrase.start_s for phrase in phrases])
    ends = np.array([phrase.end_s for phrase in phrases])
    middle_s = 0.5 * (doodle.time_s[1:] + doodle.time_s[:-1])
    index = np.searchsorted(starts, middle_s, side="right") - 1
    inside = index >= 0
    inside[inside] = middle_s[inside] < ends[index[inside]]
    label = np.where(inside, index, -1)
    edges = np.flatnonzero(np.diff(label)) + 1
    for first, last in zip([0, *edges], [*edges, len(label)], strict=True):
        if last > first:
            action = phrases[label[first]].action if label[first] >= 0 else ""
            yield action, slice(int(first), int(last) + 1)


def doodle_boxes(actor: Actor) -> list[FloatArray]:
    """Return the box ``(1, 2, 3)`` that an actor's doodles and prop are in, if it has any."""
    if not actor.doodles:
        return []
    every = np.concatenate([doodle.position_m for doodle in actor.doodles])
    return [np.stack([every.min(axis=0) - REACH_M, every.max(axis=0) + REACH_M])[None]]


def define_prop(stage: Usd.Stage, path: str, actor: Actor, performance: Performance) -> None:
    """Define a dart with the prop's poses, hidden while tracking was lost, or in a hand."""
    held = actor.held
    if held is None:
        time_s = performance.start_s + np.arange(len(performance)) / performance.rate_hz
        position, orientation, tracked = prop_poses(actor.doodles, time_s)
    else:
        position, orientation = held.position_m, held.orientation_xyzw
        tracked = np.ones(len(position), bool)
    frame = StageFrame.of(stage)
    places, turns = frame.points(position).tolist(), frame.rotations(orientation).tolist()
    prop = UsdGeom.Xform.Define(stage, path)
    translate = prop.AddTranslateOp().GetAttr().GetPath()
    orient = prop.AddOrientOp().GetAttr().GetPath()
    visibility = prop.CreateVisibilityAttr().GetPath()
    layer = stage.GetEditTarget().GetLayer()
    with Sdf.ChangeBlock():
        for code, (p, q) in enumerate(zip(places, turns, strict=True)):
            layer.SetTimeSample(translate, float(code), Gf.Vec3d(*p))
            layer.SetTimeSample(orient, float(code), Gf.Quatf(q[3], q[0], q[1], q[2]))
        for code in (0, *(np.flatnonzero(np.diff(tracked)) + 1).tolist()):
            value = UsdGeom.Tokens.inherited if tracked[code] else UsdGeom.Tokens.invisible
            layer.SetTimeSample(visibility, float(code), value)
    color = tuple(linear_from_srgb(PROP_RGB).tolist())
    # Each face has its own corners, so that the dart keeps its edges.
    faces = np.arange(_DART_FACES.size).reshape(-1, 3)
    points_m = _DART_M[_DART_FACES].reshape(-1, 3) * (1.0 if held is None else HELD)
    mesh = define_mesh(stage, f"{path}/Dart", points_m, faces, color)
    if held is None:
        # A guide: it often is inside the character, so viewers show it only when asked to.
        mesh.CreatePurposeAttr(UsdGeom.Tokens.guide)
    material = define_material(stage, f"{path}/Materials/Dart", color)
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)


def prop_poses(
    doodles: Sequence[Doodle], time_s: FloatArray
) -> tuple[FloatArray, FloatArray, np.ndarray]:
    """Return position, orientation xyzw and whether tracked, at each time.

    Between doodles the prop waits where the last one ended.
    """
    owner = np.searchsorted([doodle.time_s[0] for doodle in doodles], time_s, side="right") - 1
    owner = np.maximum(owner, 0)
    position, orientation = np.empty((len(time_s), 3)), np.empty((len(time_s), 4))
    tracked = np.zeros(len(time_s), bool)
    for index, doodle in enumerate(doodles):
        mine = owner == index
        at_s = time_s[mine]
        position[mine] = interpolate_linear(doodle.time_s, doodle.position_m, at_s)
        orientation[mine] = interpolate_rotation(doodle.time_s, doodle.orientation_xyzw, at_s)
        tracked[mine] = (at_s >= doodle.time_s[0] - 1e-9) & (at_s <= doodle.time_s[-1] + 1e-9)
    return position, orientation, tracked


def define_ground(
    stage: Usd.Stage, path: str, boxes: Sequence[FloatArray], terrain: Terrain | None = None
) -> None:
    """Define the terrain, or a level plane under everything that the characters do."""
    color = tuple(linear_from_srgb(GROUND_RGB).tolist())
    if terrain is None:
        low, high = _whole(boxes)
        (x0, _, z0), (x1, _, z1) = np.floor(low - MARGIN_M), np.ceil(high + MARGIN_M)
        points = np.array([[x0, 0.0, z0], [x0, 0.0, z1], [x1, 0.0, z1], [x1, 0.0, z0]])
        triangles = np.array([[0, 1, 2], [0, 2, 3]])
    else:
        points, triangles = terrain.points_m, terrain.triangles
    mesh = define_mesh(stage, path, points, triangles, color)
    material = define_material(stage, f"{path}Material", color, roughness=0.9)
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)


def define_camera(stage: Usd.Stage, path: str, boxes: Sequence[FloatArray]) -> None:
    """Define a camera that sees everything in the boxes ``(n, 2, 3)``, from their front left."""
    eye_m, away_m = camera_place(np.concatenate(boxes), BACK, _HALF_HEIGHT * WIDE, _HALF_HEIGHT)
    frame = StageFrame.of(stage)
    camera = UsdGeom.Camera.Define(stage, path)
    tenth = 10.0 * frame.length(0.001)  # USD has lenses in tenths of the stage's unit
    camera.CreateHorizontalApertureAttr(WIDE * _HEIGHT_MM * tenth)
    camera.CreateVerticalApertureAttr(_HEIGHT_MM * tenth)
    camera.CreateFocalLengthAttr(_FOCAL_MM * tenth)
    near, far = frame.length(0.05), frame.length(4.0 * away_m)
    camera.CreateClippingRangeAttr(Gf.Vec2f(near, far))
    camera.CreateFocusDistanceAttr(frame.length(away_m))
    eye, back = frame.points(eye_m), frame.directions(BACK)
    up = frame.directions([0.0, 1.0, 0.0])
    view = Gf.Matrix4d().SetLookAt(Gf.Vec3d(*eye), Gf.Vec3d(*(eye - back)), Gf.Vec3d(*up))
    camera.AddTransformOp().Set(view.GetInverse())


def camera_place(
    boxes_m: FloatArray, back: FloatArray, half_width: float, half_height: float
) -> tuple[FloatArray, float]:
    """Return the nearest position that sees whole boxes, and the distance of their middle.

    Parameters
    ----------
    boxes_m
        ``(n, 2, 3)``, least and greatest corners.
    back
        From what is seen to the camera, unit, not upright.
    half_width, half_height
        Of the picture, one unit before the camera.
    """
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(back, right), back])
    which = np.array(list(np.ndindex(2, 2, 2)))
    x, y, z = (boxes_m[:, which, [0, 1, 2]].reshape(-1, 3) @ axes.T).T
    # A point is in the picture where |x - eye_x| <= half_width (eye_z - z): four planes that
    # bound the eye, each by one point.
    left, right_, low, high = (
        float(np.max(side + half * z))
        for side, half in ((-x, half_width), (x, half_width), (-y, half_height), (y, half_height))
    )
    distance = max((left + right_) / (2.0 * half_width), (low + high) / (2.0 * half_height))
    eye = np.array([0.5 * (right_ - left), 0.5 * (high - low), distance])
    return eye @ axes, distance - 0.5 * float(z.min() + z.max())


def _whole(boxes: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the corners of the box around boxes ``(n, 2, 3)``."""
    every = np.concatenate(boxes)
    return every[:, 0].min(axis=0), every[:, 1].max(axis=0)
