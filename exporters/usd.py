"""A performance as a USD stage: .usda to read, .usdc to keep, .usdz to send.

::

    /Performance                      default prim
        /Actors/<device>_character    SkelRoot: meshes, Materials
            /<device>                 Skeleton
            /<device>_animation       SkelAnimation
        /Doodles/<device>_doodle      BasisCurves, one a stretch, coloured by phrase
        /Props/<device>_prop          Xform that goes where the prop went
        /Scenery                      Ground, Camera

Frame i of the performance is time code i, and a second has as many time codes as the
performance has frames. The Score travels along as text, in the layer's custom data under
``smd:score``, with the recording's time at frame 0 under ``smd:start_s``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from pxr import Sdf, Tf, Usd, UsdGeom

from actions_library.naming import numbered
from actions_library.stage_frame import OURS, StageFrame
from actions_library.storage import new_stage
from actions_library.usd_skel import MATERIALS, unique_identifiers
from exporters.package import write_package
from exporters.palette import RGB, action_colors
from exporters.performer import Performer, Places, define_performer
from exporters.scenery import define_camera, define_ground, doodle_boxes
from smd.acting.performance import Performance
from smd.errors import ExportError
from smd.files import write_together
from smd.geometry.arrays import FloatArray

ROOT, PERFORMER = "Performance", "Performer"
ACTORS, DOODLES, PROPS, SCENERY = (
    f"/{ROOT}/{name}" for name in ("Actors", "Doodles", "Props", "Scenery")
)
START_KEY = "smd:start_s"
"""In the layer's custom data, beside the performance's source: ``smd:`` and each entry's name."""

Files = dict[Path, Callable[[Path], None]]
"""The writer of each of the files that belong together (`smd.files.write_together`)."""


def write_usd(
    performance: Performance,
    path: Path | str,
    *,
    neutral: Performance | None = None,
    frame: StageFrame = OURS,
    keys_within_m: float | None = None,
) -> None:
    """Write a performance as one USD file; equal performances give equal bytes.

    Parameters
    ----------
    performance
        What to write.
    path
        Ends in .usda, .usdc or .usdz; replaced as a whole once written.
    neutral
        The same Score performed without expression: it becomes the variant ``neutral`` of each
        character's variant set ``expression``, and ``performance`` the variant ``expressive``.
    frame
        Coordinates of the USD stage.
    keys_within_m
        Few keys instead of one each frame: no point of the skin is further than this from where it
        is at each frame (`exporters.keys`). Props keep every frame.

    Raises
    ------
    ExportError
        If the file cannot be written, the two performances do not fit each other, or the distance
        is not positive.
    """
    files = usd_file(
        performance, Path(path), neutral=neutral, frame=frame, keys_within_m=keys_within_m
    )
    write_together(files)


def write_usd_layers(
    performance: Performance,
    path: Path | str,
    *,
    neutral: Performance | None = None,
    frame: StageFrame = OURS,
    keys_within_m: float | None = None,
) -> None:
    """Write a performance as a small file that references one more for each performer.

    For ``take.usda`` they are ``take.<device>.usdc`` beside it. All of them are replaced, or
    none. Parameters and errors are those of `write_usd`; a package is one file, so that .usdz
    is an error too.
    """
    files = usd_layers(
        performance, Path(path), neutral=neutral, frame=frame, keys_within_m=keys_within_m
    )
    write_together(files)


def usd_file(
    performance: Performance,
    path: Path,
    *,
    neutral: Performance | None,
    frame: StageFrame,
    keys_within_m: float | None,
) -> Files:
    """Return the writer of the file of `write_usd`."""
    stage = performance_stage(
        performance, neutral=neutral, frame=frame, keys_within_m=keys_within_m
    )
    layer = stage.GetRootLayer()
    return {path: partial(_export, layer, path)}


def usd_layers(
    performance: Performance,
    path: Path,
    *,
    neutral: Performance | None,
    frame: StageFrame,
    keys_within_m: float | None,
) -> Files:
    """Return the writers of `write_usd_layers`; the file that refers to others is the last."""
    if path.suffix.lower() not in (".usda", ".usdc"):
        raise ExportError(f"{path}: expected .usda or .usdc for layers, found {path.suffix}")
    stage = _new_stage(performance, ROOT, frame)
    _define_scopes(stage)
    files: Files = {}
    boxes, references = [], []
    colors = _colors(performance)
    performers = _performers(performance, neutral, keys_within_m)
    names = _names(performance)
    # Where the file system does not tell Left from left, two layers would be one.
    file_names = numbered(name.lower() for name in names)
    for name, file_name, performer in zip(names, file_names, performers, strict=True):
        inside, inner = _new_stage(performance, PERFORMER, frame), _places_in_layer(name)
        UsdGeom.Xform.Define(inside, f"/{PERFORMER}")
        boxes += [
            define_performer(inside, inner, performer, colors),
            *doodle_boxes(performer.actor),
        ]
        beside = path.with_name(f"{path.stem}.{file_name}.usdc")
        files[beside] = partial(_export, inside.GetRootLayer(), beside)
        for here, there in zip(places(name)[:3], inner[:3], strict=True):
            if prim := inside.GetPrimAtPath(there):  # a doodle of one sample draws nothing
                references.append(
                    (here, prim.GetTypeName(), Sdf.Reference(f"./{beside.name}", there))
                )
    _define_scenery(stage, performance, boxes)
    layer = stage.GetRootLayer()
    # Only now, with no stage to compose it: from memory the relative paths lead nowhere.
    del stage
    for here, kind, reference in references:
        prim = Sdf.CreatePrimInLayer(layer, here)
        prim.specifier, prim.typeName = Sdf.SpecifierDef, kind
        prim.referenceList.Prepend(reference)
    files[path] = partial(_export, layer, path)
    return files


def performance_stage(
    performance: Performance,
    *,
    neutral: Performance | None = None,
    frame: StageFrame = OURS,
    keys_within_m: float | None = None,
) -> Usd.Stage:
    """Return a performance as a USD stage in memory; parameters are those of `write_usd`."""
    stage = _new_stage(performance, ROOT, frame)
    _define_scopes(stage)
    colors = _colors(performance)
    boxes = []
    performers = _performers(performance, neutral, keys_within_m)
    for name, performer in zip(_names(performance), performers, strict=True):
        boxes += [
            define_performer(stage, places(name), performer, colors),
            *doodle_boxes(performer.actor),
        ]
    _define_scenery(stage, performance, boxes)
    return stage


def _new_stage(performance: Performance, root: str, frame: StageFrame) -> Usd.Stage:
    stage = new_stage(root, frame)
    stage.SetTimeCodesPerSecond(performance.rate_hz)
    stage.SetFramesPerSecond(performance.rate_hz)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(performance) - 1)
    return stage


def _define_scopes(stage: Usd.Stage) -> None:
    UsdGeom.Xform.Define(stage, f"/{ROOT}")
    for scope in (ACTORS, DOODLES, PROPS, SCENERY):
        UsdGeom.Scope.Define(stage, scope)


def _define_scenery(
    stage: Usd.Stage, performance: Performance, boxes: Sequence[FloatArray]
) -> None:
    """Define ground and camera, and write the custom data of the layer."""
    define_ground(stage, f"{SCENERY}/Ground", boxes, performance.terrain)
    define_camera(stage, f"{SCENERY}/Camera", boxes)
    stage.GetRootLayer().customLayerData = {
        **{f"smd:{name}": text for name, text in performance.source.items()},
        START_KEY: performance.start_s,
    }


def _performers(
    performance: Performance, neutral: Performance | None, keys_within_m: float | None
) -> list[Performer]:
    if neutral is None:
        count = len(performance.actors)
        return [Performer(performance, i, None, keys_within_m) for i in range(count)]
    told = [
        (p.rate_hz, p.start_s, len(p), [(a.name, a.character.skeleton.joints) for a in p.actors])
        for p in (performance, neutral)
    ]
    if told[0] != told[1]:
        raise ExportError("neutral: expected a performance of the same devices, joints and frames")
    return [
        Performer(performance, i, actor, keys_within_m) for i, actor in enumerate(neutral.actors)
    ]


def _colors(performance: Performance) -> dict[str, RGB]:
    return action_colors(phrase.action for a in performance.actors for phrase in a.phrases)


def _names(performance: Performance) -> list[str]:
    # A Skeleton of that name would stand where the materials are.
    return unique_identifiers([MATERIALS, *(actor.name for actor in performance.actors)])[1:]


def places(name: str) -> Places:
    """Return where the prims of a device of this name are."""
    return Places(
        f"{ACTORS}/{name}_character",
        f"{DOODLES}/{name}_doodle",
        f"{PROPS}/{name}_prop",
        name,
        f"{name}_animation",
    )


def _places_in_layer(name: str) -> Places:
    """Return where the prims of a device are in its own layer."""
    actor, doodle, prop = (f"/{PERFORMER}/{kind}" for kind in ("Actor", "Doodle", "Prop"))
    return Places(actor, doodle, prop, name, f"{name}_animation")


def _export(layer: Sdf.Layer, path: Path, temporary: Path) -> None:
    """Write a layer to a temporary file that is to become ``path``."""
    try:
        if path.suffix.lower() == ".usdz":
            write_package(layer, temporary)
        else:
            layer.Export(str(temporary))
    except Tf.ErrorException as error:
        raise ExportError(f"{path}: cannot be written: {_first_line(error)}") from error


def _first_line(error: Exception) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), "unknown error")
