"""A performance as a USD stage: .usda to read, .usdc to keep, .usdz to send.

::

    /Performance                      default prim
        /Actors/<device>              SkelRoot: Skeleton, Animation, meshes, Materials
        /Doodles/<device>             BasisCurves, one a stretch, coloured by phrase
        /Props/<device>               Xform that goes where the prop went
        /Scenery                      Ground, Camera

Frame i of the performance is time code i, and a second has as many time codes as the
performance has frames. The Score travels along as text, in the layer's custom data under
``smd:score``, with the recording's time at frame 0 under ``smd:start_s``.
"""

from __future__ import annotations

import tempfile
import zipfile
from pathlib import Path

from pxr import Sdf, Tf, Usd, UsdGeom, Vt

from actions_library.storage import new_stage
from actions_library.usd_skel import (
    ANIMATION,
    bind_animation,
    define_animation,
    define_character,
    set_samples,
    unique_identifiers,
)
from exporters.bounds import body_boxes
from exporters.palette import action_colors, performer_colors
from exporters.scenery import define_camera, define_doodle, define_ground, define_prop
from smd.errors import ExportError
from smd.files import replacing
from smd.geometry.arrays import FloatArray
from smd.score import score_to_json
from smd.transfer.performance import Actor, Performance

ROOT = "Performance"
ACTORS, DOODLES, PROPS, SCENERY = (
    f"/{ROOT}/{name}" for name in ("Actors", "Doodles", "Props", "Scenery")
)
SCORE_KEY, START_KEY, DEVICE_KEY = "smd:score", "smd:start_s", "smd:device"
"""In the layer's custom data the first two, in each SkelRoot's the last."""

_ALIGNMENT = 64  # usdz: readers map the layers inside straight into memory


def write_usd(performance: Performance, path: Path | str) -> None:
    """Write a performance as USD; equal performances give equal bytes.

    Parameters
    ----------
    performance
        What to write.
    path
        Ends in .usda, .usdc or .usdz; replaced as a whole once written.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    path = Path(path)
    layer = performance_stage(performance).GetRootLayer()
    with replacing(path) as temporary:
        try:
            if path.suffix.lower() == ".usdz":
                _write_package(layer, temporary)
            else:
                layer.Export(str(temporary))
        except Tf.ErrorException as error:
            raise ExportError(f"{path}: cannot be written: {_first_line(error)}") from error


def performance_stage(performance: Performance) -> Usd.Stage:
    """Return a performance as a stage in memory."""
    stage = new_stage(ROOT)
    stage.SetTimeCodesPerSecond(performance.rate_hz)
    stage.SetFramesPerSecond(performance.rate_hz)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(performance) - 1)
    stage.GetRootLayer().customLayerData = {
        SCORE_KEY: score_to_json(performance.score),
        START_KEY: performance.start_s,
    }
    UsdGeom.Xform.Define(stage, f"/{ROOT}")
    for scope in (ACTORS, DOODLES, PROPS, SCENERY):
        UsdGeom.Scope.Define(stage, scope)
    colors = action_colors(performance.score)
    boxes = []
    names = unique_identifiers(actor.device for actor in performance.actors)
    for index, (name, actor) in enumerate(zip(names, performance.actors, strict=True)):
        boxes.append(_define_actor(stage, f"{ACTORS}/{name}", actor, index))
        define_doodle(stage, f"{DOODLES}/{name}", actor, colors)
        define_prop(stage, f"{PROPS}/{name}", actor, performance)
    define_ground(stage, f"{SCENERY}/Ground", boxes, performance.terrain)
    define_camera(stage, f"{SCENERY}/Camera", boxes)
    return stage


def _define_actor(stage: Usd.Stage, path: str, actor: Actor, index: int) -> FloatArray:
    """Define an actor's SkelRoot and return the box it is in at each frame, ``(n, 2, 3)``."""
    character = actor.character
    root = define_character(stage, path, character, performer_colors(character, index))
    root.GetPrim().SetCustomDataByKey(DEVICE_KEY, actor.device)
    root.GetPrim().SetDisplayName(actor.device)
    animation = define_animation(
        stage,
        f"{path}/{ANIMATION}",
        character.skeleton,
        actor.rotation_xyzw,
        actor.translation_m,
    )
    bind_animation(root, animation)
    boxes = body_boxes(character, actor.rotation_xyzw, actor.translation_m)
    set_samples(root.CreateExtentAttr(), boxes, Vt.Vec3fArray)
    return boxes


def _write_package(layer: Sdf.Layer, path: Path) -> None:
    """Write a layer as usdz: a zip, neither compressed nor dated, whose content is aligned.

    USD's own writer stamps each file with its date in local time, so that no two packages of
    one performance were ever the same.
    """
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder) / "performance.usdc"
        layer.Export(str(inside))
        entry = zipfile.ZipInfo(inside.name, date_time=(1980, 1, 1, 0, 0, 0))
        entry.create_system = 3  # else the package tells which system made it
        header = 30 + len(entry.filename.encode())  # of a zip's local file header
        padding = -(header + 4) % _ALIGNMENT
        entry.extra = b"\x86\x19" + padding.to_bytes(2, "little") + bytes(padding)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as package:
            package.writestr(entry, inside.read_bytes())


def _first_line(error: Exception) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), "unknown error")
