"""Make a performance ready to be edited in Blender: each phrase an action, with few keys.

Blender makes a key of every joint at every time sample of a USD file. This script imports a file
that smd wrote and leaves each bone the keys that it needs: no bone's head or tail is further than
``--within`` millimetres from where the file has it, at any frame. It then

- gives each phrase an action of its own, laid one after the other on a track of the Nonlinear
  Animation editor, with what is between them;
- sets a marker where each phrase begins, and the scene's frame rate;
- makes the camera active, adds a key light and a fill light, and draws doodles in their colours.

It prints how many keys there were and are. Run it with Blender 4.4 or newer, or with its Python
module (``pip install bpy``)::

    blender --python phrases.py -- duel.usdc --within 1
    python phrases.py duel.usdc --within 1 --save duel.blend

A .blend file that is opened before (``blender scene.blend --python …``) keeps its objects, lights,
camera and frame rate. The script needs nothing of this project: it may be copied anywhere.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import bpy
import numpy as np

DEVICE, PHRASES = "smd:device", "smd:phrases"  # custom data of each character in the USD file
OLDEST = (4, 4)  # its actions have slots, and its Python finds USD
LONGEST = 48  # frames between two keys at most
STILL = 0.001  # of what a channel may stray: what moves less stands still
SUNS = (("Key light", 3.0, (50.0, 0.0, -35.0)), ("Fill light", 1.0, (60.0, 0.0, 60.0)))
"""Name, strength, and how each is turned, in degrees about x, y and z. The first casts shadows."""


def main(arguments: list[str]) -> None:
    """Import a file and make it ready."""
    parser = argparse.ArgumentParser(prog="phrases.py", description=__doc__.split("\n")[0])
    parser.add_argument("usd", type=Path, help="a .usda, .usdc or .usdz that smd wrote")
    parser.add_argument("--within", type=float, default=1.0, metavar="MM", help="default: 1")
    parser.add_argument("--save", type=Path, metavar="BLEND", help="save the scene as this file")
    options = parser.parse_args(arguments)
    if not options.usd.is_file():
        parser.error(f"{options.usd}: expected a USD file, found none")
    if not (math.isfinite(options.within) and options.within > 0):
        parser.error(f"--within: expected millimetres above 0, found {options.within:g}")
    if bpy.app.version < OLDEST:
        parser.error(
            f"expected Blender {OLDEST[0]}.{OLDEST[1]} or newer, found {bpy.app.version_string}"
        )
    scene, new = bpy.context.scene, not bpy.data.filepath
    try:
        rate, phrases = read_phrases(options.usd)
    except ValueError as error:
        parser.error(str(error))
    if new:
        remove_startup_objects()
        scene.render.fps = max(round(rate), 1)
        scene.render.fps_base = scene.render.fps / rate
    elif not math.isclose(scene.render.fps / scene.render.fps_base, rate):
        print(f"the file has {rate:g} frames a second: write it with --fps as the scene has it")
    imported = import_usd(options.usd, set_frame_range=new)
    for armature in (thing for thing in imported if thing.type == "ARMATURE"):
        performer = plain(armature.name)
        entries = phrases.get(performer, [])
        if armature.animation_data and armature.animation_data.action:
            print(edit_by_phrases(armature, entries, 0.001 * options.within))
        for action, start, _ in entries:
            scene.timeline_markers.new(f"{performer}: {action}", frame=start)
    paint([thing for thing in imported if thing.type == "CURVES"])
    film([thing for thing in imported if thing.type == "CAMERA"])
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))


def remove_startup_objects() -> None:
    """Remove what a new Blender shows."""
    for name in ("Cube", "Light", "Camera"):
        if thing := bpy.data.objects.get(name):
            bpy.data.objects.remove(thing)


def read_phrases(path: Path) -> tuple[float, dict[str, list[tuple[str, int, int]]]]:
    """Return the frame rate, and each performer's phrases: action, first and last frame.

    Raises ValueError if the file is not USD.
    """
    bpy.utils.expose_bundled_modules()
    from pxr import Tf, Usd, UsdSkel

    try:
        stage, found = Usd.Stage.Open(str(path)), {}
    except Tf.ErrorException as error:
        raise ValueError(f"{path}: expected a USD file, got something else") from error
    for root in stage.Traverse():
        if not root.HasCustomDataKey(DEVICE):
            continue
        (skeleton,) = (prim for prim in Usd.PrimRange(root) if prim.IsA(UsdSkel.Skeleton))
        entries = (root.GetCustomDataByKey(PHRASES) or {}).values()
        found[skeleton.GetName()] = sorted(
            ((e["action"], round(e["start"]), round(e["end"])) for e in entries),
            key=lambda entry: entry[1],
        )
    return stage.GetTimeCodesPerSecond(), found


def import_usd(path: Path, *, set_frame_range: bool) -> list[bpy.types.Object]:
    """Import a USD file and return its objects."""
    before = set(bpy.data.objects)
    bpy.ops.wm.usd_import(filepath=str(path.resolve()), set_frame_range=set_frame_range)
    return [thing for thing in bpy.data.objects if thing not in before]


def plain(name: str) -> str:
    """Return an object's name without the number of a name that was taken."""
    return name.split(".")[0]


def film(cameras: list[bpy.types.Object]) -> None:
    """See a scene without a camera of its own through the file's, and light it if it is dark."""
    scene = bpy.context.scene
    if cameras and scene.camera is None:
        scene.camera = cameras[0]
        for area in (area for screen in bpy.data.screens for area in screen.areas):
            if area.type == "VIEW_3D":
                area.spaces.active.region_3d.view_perspective = "CAMERA"
    if any(thing.type == "LIGHT" for thing in scene.objects):
        return
    for name, strength, degrees in SUNS:
        light = bpy.data.lights.new(name, "SUN")
        light.energy, light.angle = strength, math.radians(5.0)
        light.use_shadow = name == SUNS[0][0]
        sun = bpy.data.objects.new(name, light)
        sun.rotation_euler = [math.radians(angle) for angle in degrees]
        scene.collection.objects.link(sun)


def paint(doodles: list[bpy.types.Object]) -> None:
    """Draw curves in the colours that they have as an attribute, and without shadows."""
    if not doodles:
        return
    material = bpy.data.materials.new("Doodle")
    if material.node_tree is None:
        material.use_nodes = True  # Blender 5 has nodes from the beginning, and warns
    nodes = material.node_tree.nodes
    color = nodes.new("ShaderNodeAttribute")
    color.attribute_name = "displayColor"
    surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    material.node_tree.links.new(color.outputs["Color"], surface.inputs["Base Color"])
    for doodle in doodles:
        doodle.data.materials.append(material)
        doodle.visible_shadow = False


# An action a phrase ----------------------------------------------------------------------------


@dataclass
class Channel:
    """A location, rotation or scale of a bone over time: ``values (frames, components)``."""

    path: str
    bone: str
    values: np.ndarray

    @property
    def kind(self) -> str:
        """Which of the three it is."""
        return self.path.rsplit(".", 1)[1]

    @property
    def neutral(self) -> np.ndarray:
        """What a bone has without any curve."""
        neutral = {"location": [0.0, 0.0, 0.0], "scale": [1.0, 1.0, 1.0]}
        return np.array(neutral.get(self.kind, [1.0, 0.0, 0.0, 0.0]))

    def without_motion(self, step: float) -> Fit | None:
        """Return no key or one, where that is enough: values change by less than a step."""
        if np.abs(self.values - self.neutral).max() < step:
            return Fit([], [])
        return Fit([0], []) if np.ptp(self.values, axis=0).max() < step else None

    def shown(self, fit: Fit) -> Channel:
        """Return the channel as Blender has it with these keys of it."""
        values = self.values.copy()
        if not fit.handles:
            values[:] = values[0] if fit.keys else self.neutral
        for first, last, handles in zip(fit.keys, fit.keys[1:], fit.handles, strict=False):
            points = np.concatenate([values[first : first + 1], handles, values[last : last + 1]])
            values[first + 1 : last] = bezier(last - first)[1] @ points
        return Channel(self.path, self.bone, values)


@dataclass
class Fit:
    """Keys of a channel: their frames, and the values of the handles between each and the next."""

    keys: list[int]
    handles: list[np.ndarray]  # (2, components) each


def edit_by_phrases(
    armature: bpy.types.Object, phrases: list[tuple[str, int, int]], within_m: float
) -> str:
    """Replace an armature's action by one a phrase, with few keys; return what that gave."""
    data = armature.animation_data
    whole, before = data.action, curves_of(data.action, data.action_slot)
    keys_before, curves_before = sum(len(c.keyframe_points) for c in before), len(before)
    first, channels = read_channels(before)
    body = Body(armature)
    data.action = None
    track = data.nla_tracks.new()
    track.name = "Phrases"
    keys, curves, strayed_m = 0, set(), 0.0
    last = first + len(channels[0].values) - 1
    for name, start, end in stretches(plain(armature.name), phrases, first, last):
        part = slice(start - first, end - first + 1)
        cut = [Channel(c.path, c.bone, c.values[part]) for c in channels]
        fits, away_m = body.fewest_keys(cut, within_m)
        action = new_action(name, armature, cut, fits, start)
        strip = track.strips.new(action.name, start, action)
        strip.action_slot = action.slots[0]
        strip.extrapolation = "HOLD" if len(track.strips) == 1 else "HOLD_FORWARD"
        strayed_m = max(strayed_m, away_m)
        for curve in curves_of(action, action.slots[0]):
            keys += len(curve.keyframe_points)
            curves.add((curve.data_path, curve.array_index))
    bpy.data.actions.remove(whole)
    return (
        f"{armature.name}: {keys_before} keys on {curves_before} curves became {keys} on "
        f"{len(curves)}, in {len(track.strips)} actions, within {1000 * strayed_m:.2f} mm"
    )


def curves_of(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> list[bpy.types.FCurve]:
    """Return the curves of an action that move what has its slot."""
    return list(action.layers[0].strips[0].channelbag(slot).fcurves)


def read_channels(curves: list[bpy.types.FCurve]) -> tuple[int, list[Channel]]:
    """Return the first frame, and each channel at every frame from there to the last key."""
    found: dict[str, dict[int, np.ndarray]] = {}
    start = round(min(curve.keyframe_points[0].co[0] for curve in curves))
    end = round(max(curve.keyframe_points[-1].co[0] for curve in curves))
    for curve in curves:
        points = np.empty(2 * len(curve.keyframe_points))
        curve.keyframe_points.foreach_get("co", points)
        frames, values = points.reshape(-1, 2).T
        # Between the keys that the importer makes, Blender has straight lines.
        values = np.interp(np.arange(start, end + 1), frames, values)
        found.setdefault(curve.data_path, {})[curve.array_index] = values
    channels = []
    for path, columns in found.items():
        values = np.stack([columns[index] for index in sorted(columns)], axis=-1)
        channels.append(Channel(path, path.split('"')[1], values))
    return start, channels


def stretches(
    performer: str, phrases: list[tuple[str, int, int]], first: int, last: int
) -> Iterator[tuple[str, int, int]]:
    """Yield name, first and last frame of each phrase and each pause; neighbours share a frame."""
    done, name = first, f"{performer} 00 before"
    for number, (action, start, end) in enumerate(phrases, start=1):
        start, end = max(start, done), min(end, last)
        if end <= start:
            continue  # nothing is left of it
        if start > done:
            yield name, done, start
        yield f"{performer} {number:02d} {action}", start, end
        done, name = end, f"{performer} {number:02d} after {action}"
    if done < last or done == first:
        yield name, done, last


def new_action(
    name: str, armature: bpy.types.Object, channels: list[Channel], fits: list[Fit], start: int
) -> bpy.types.Action:
    """Return an action with these keys."""
    action = bpy.data.actions.new(name)
    slot = action.slots.new(id_type="OBJECT", name=armature.name)
    bag = action.layers.new("Layer").strips.new(type="KEYFRAME").channelbag(slot, ensure=True)
    groups = {}
    for channel, fit in zip(channels, fits, strict=True):
        if not fit.keys:
            continue
        if channel.bone not in groups:
            groups[channel.bone] = bag.groups.new(channel.bone)
        for index, values in enumerate(channel.values.T):
            curve = bag.fcurves.new(channel.path, index=index)
            curve.group = groups[channel.bone]
            set_keys(curve, fit, values, index, start)
    action.use_frame_range = True
    action.frame_start, action.frame_end = start, start + len(channels[0].values) - 1
    return action


def set_keys(
    curve: bpy.types.FCurve, fit: Fit, values: np.ndarray, component: int, start: int
) -> None:
    """Give a curve its keys and their handles."""
    keys = np.array(fit.keys)
    co = np.stack([keys + start, values[keys]], axis=-1)
    left, right = co.copy(), co.copy()
    if fit.handles:
        third = np.diff(keys) / 3.0
        heights = np.array(fit.handles)[:, :, component]
        right[:-1] = np.stack([co[:-1, 0] + third, heights[:, 0]], axis=-1)
        left[1:] = np.stack([co[1:, 0] - third, heights[:, 1]], axis=-1)
    points = curve.keyframe_points
    points.add(len(keys))
    for point in points:
        point.interpolation = "BEZIER"
        point.handle_left_type = point.handle_right_type = "FREE"
    for attribute, given in (("co", co), ("handle_left", left), ("handle_right", right)):
        points.foreach_set(attribute, given.ravel())
    curve.update()


# Few keys --------------------------------------------------------------------------------------


class Body:
    """An armature's bones, and where a pose puts their ends."""

    def __init__(self, armature: bpy.types.Object) -> None:
        bones = list(armature.data.bones)  # parents come before their children
        self.row = {bone.name: row for row, bone in enumerate(bones)}
        self.parent = [self.row[bone.parent.name] if bone.parent else -1 for bone in bones]
        self.moved = [
            [self.row[each.name] for each in (bone, *bone.children_recursive)] for bone in bones
        ]
        rest = [np.array(bone.matrix_local) for bone in bones]
        self.from_parent = [
            np.linalg.inv(rest[above]) @ own if above >= 0 else own
            for above, own in zip(self.parent, rest, strict=True)
        ]
        self.length = [bone.length for bone in bones]
        self.unit_m = max(armature.matrix_world.to_scale())

    def ends_m(self, channels: list[Channel]) -> np.ndarray:
        """Return heads and tails of all bones, ``(frames, bones, 2, 3)`` in metres."""
        count = len(channels[0].values)
        local = np.tile(np.eye(4), (len(self.row), count, 1, 1))
        for channel in channels:
            basis = local[self.row[channel.bone]]
            if channel.kind == "location":
                basis[:, :3, 3] = channel.values
            elif channel.kind == "rotation_quaternion":
                basis[:, :3, :3] = matrices(channel.values)
        world: list[np.ndarray] = []
        for row, above in enumerate(self.parent):
            own = self.from_parent[row] @ local[row]
            world.append(world[above] @ own if above >= 0 else own)
        heads = np.stack(world, axis=1)[..., :3, 3]
        along = np.stack(world, axis=1)[..., :3, 1] * np.array(self.length)[:, None]
        return self.unit_m * np.stack([heads, heads + along], axis=2)

    def fewest_keys(self, channels: list[Channel], within_m: float) -> tuple[list[Fit], float]:
        """Return the keys of each channel, and how far any end of a bone strays, in metres.

        Each channel may stray as much as alone would move an end by a share of the distance. The
        share is the largest that keeps all of them together within the distance.
        """
        true_m = self.ends_m(channels)
        away_m = [true_m[:, moved] - true_m[:, [moved[0]], :1] for moved in self.moved]
        reach_m = [np.linalg.norm(away, axis=-1).max() for away in away_m]
        allowed = [
            # A quaternion that is off by d turns by 2 d.
            within_m / (2.0 * reach_m[self.row[channel.bone]])
            if channel.kind == "rotation_quaternion"
            else within_m / self.unit_m
            for channel in channels
        ]
        still = [c.without_motion(STILL * a) for c, a in zip(channels, allowed, strict=True)]
        errors = [
            None if fit else window_errors(channel.values)
            for channel, fit in zip(channels, still, strict=True)
        ]

        def tried(share: float) -> tuple[list[Fit], float]:
            fits = [
                fit or fitted(channel.values, error, share * most)
                for channel, fit, error, most in zip(channels, still, errors, allowed, strict=True)
            ]
            shown_m = self.ends_m([c.shown(fit) for c, fit in zip(channels, fits, strict=True)])
            return fits, float(np.linalg.norm(shown_m - true_m, axis=-1).max())

        best, low, high = tried(0.0), 0.0, 4.0
        for _ in range(9):
            middle = 0.5 * (low + high)
            found = tried(middle)
            if found[1] <= within_m:
                best, low = found, middle
            else:
                high = middle
        return best


def matrices(wxyz: np.ndarray) -> np.ndarray:
    """Return rotation matrices ``(n, 3, 3)`` of quaternions of any length."""
    w, x, y, z = (wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True)).T
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def fitted(values: np.ndarray, errors: np.ndarray, allowed: float) -> Fit:
    """Return keys, from each to the furthest whose segment is not further off than allowed."""
    keys, handles = [0], []
    while keys[-1] < len(values) - 1:
        here = keys[-1]
        gap = int(np.flatnonzero(errors[here] <= allowed)[-1])
        handles.append(bezier(gap)[0] @ values[here : here + gap + 1])
        keys.append(here + gap)
    return Fit(keys, handles)


def window_errors(values: np.ndarray) -> np.ndarray:
    """Return how far the best Bézier segment is from the values, ``(frames, LONGEST + 1)``.

    The row is the frame of its first key, the column the gap to its second.
    """
    count = len(values)
    errors = np.full((count, LONGEST + 1), np.inf)
    errors[:-1, 1] = 0.0
    for gap in range(2, min(LONGEST, count - 1) + 1):
        windows = np.lib.stride_tricks.sliding_window_view(values, gap + 1, axis=0)
        off = windows @ residual(gap)  # (starts, components, gap - 1)
        errors[: count - gap, gap] = np.sqrt((off**2).sum(axis=1).max(axis=1))
    return errors


@cache
def bezier(gap: int) -> tuple[np.ndarray, np.ndarray]:
    """Return matrices for a Bézier segment between two keys that are so many frames apart.

    Its handles are a third of the way from their keys, so that it is a cubic in time. The first
    matrix ``(2, gap + 1)`` gives the handles that fit the values of all frames best, the second
    ``(gap - 1, 4)`` the values between the keys from those of key, handle, handle and key.
    """
    u = np.arange(1, gap)[:, None] / gap
    shape = np.hstack([(1 - u) ** 3, 3 * (1 - u) ** 2 * u, 3 * (1 - u) * u**2, u**3])
    # From a straight line to what is left of the values; the least, where many are as good.
    straight = np.zeros((2, gap + 1))
    straight[:, [0, -1]] = np.array([[2.0, 1.0], [1.0, 2.0]]) / 3.0
    line = np.hstack([1 - u, u])
    left = np.eye(gap + 1)[1:-1]
    left[:, [0, -1]] -= line
    return straight + np.linalg.pinv(shape[:, 1:3]) @ left, shape


@cache
def residual(gap: int) -> np.ndarray:
    """Return the matrix ``(gap + 1, gap - 1)`` from values to how far the best segment is off."""
    handles, shape = bezier(gap)
    ends = np.eye(gap + 1)[[0, -1]]
    fit = shape @ np.stack([ends[0], *handles, ends[1]])
    return (fit - np.eye(gap + 1)[1:-1]).T


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
