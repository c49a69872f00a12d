"""A library's USD files: ``character.usdc``, and ``clips/<action>.usdc``.

A clip's file holds a SkelAnimation, and its stages and contacts as custom data; it references
the character, so that it plays when it is opened in usdview or Blender. We read it as a plain
layer, without composing anything.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Sdf, Tf, Usd, UsdSkel, Vt

from actions_library.stage_frame import OURS, StageFrame
from actions_library.usd_skel import (
    ANIMATION,
    bind_animation,
    define_animation,
    define_character,
    joint_paths,
    read_animation,
    read_character,
    unique_identifiers,
)
from smd.character.character import Character
from smd.character.clip import STAGES, Clip
from smd.errors import CharacterError, LibraryError

CHARACTER_FILE, CLIPS_FOLDER = "character.usdc", "clips"
CHARACTER_SCHEMA, CLIP_SCHEMA, VERSION = "smd.character", "smd.clip", 1

_CLIP_DATA = "smd"
_CLIP_ROOT = "/Clip"


def new_stage(root: str, frame: StageFrame = OURS) -> Usd.Stage:
    """Return an empty stage in memory, by default Y up in metres, its default prim's path set."""
    stage = Usd.Stage.Open(Sdf.Layer.CreateAnonymous(".usdc"))
    frame.mark(stage)
    stage.GetRootLayer().defaultPrim = root
    return stage


def write_character_file(path: Path, character: Character) -> None:
    """Write a character as a USD file of its own."""
    (root,) = unique_identifiers([character.name])
    stage = new_stage(root)
    define_character(stage, f"/{root}", character)
    _sign(stage.GetRootLayer(), CHARACTER_SCHEMA, {"smd:name": character.name})
    stage.GetRootLayer().Export(str(path))


def read_character_file(path: Path) -> Character:
    """Return the character that a file holds.

    Raises
    ------
    LibraryError
        If the file is missing, or is not one of ours.
    """
    layer = _open(path, CHARACTER_SCHEMA)
    try:
        return read_character(Usd.Stage.Open(layer), layer.customLayerData["smd:name"])
    except (CharacterError, KeyError) as error:
        raise LibraryError(f"{path}: {error}") from error


def write_clip_file(path: Path, clip: Clip, character: Character, character_file: str) -> None:
    """Write a clip as a USD file that shows it on the character of another file."""
    stage = new_stage(_CLIP_ROOT[1:])
    stage.SetTimeCodesPerSecond(clip.rate_hz)
    stage.SetFramesPerSecond(clip.rate_hz)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(clip) - 1)
    root = UsdSkel.Root.Define(stage, _CLIP_ROOT)
    animation = define_animation(
        stage,
        f"{_CLIP_ROOT}/{ANIMATION}",
        clip.skeleton,
        clip.rotation_xyzw,
        clip.translation_m,
        tracks=clip.tracks,
        shapes=character.shapes,
    )
    bind_animation(root, animation)
    # One digit a frame and joint: 1 while it touches the ground.
    contacts = ["".join("01"[touches] for touches in column.tolist()) for column in clip.contacts.T]
    animation.GetPrim().SetCustomDataByKey(
        _CLIP_DATA,
        {
            "stage_end_frames": dict(zip(STAGES, clip.stage_end_frames.tolist(), strict=True)),
            "contact_joints": Vt.StringArray(list(clip.contact_joints)),
            "contacts": Vt.StringArray(contacts),
            "cyclic": clip.cyclic,
        },
    )
    layer = stage.GetRootLayer()
    _sign(layer, CLIP_SCHEMA)
    # Only now, with no stage to compose it: from memory the relative path leads nowhere.
    del stage, root, animation
    layer.GetPrimAtPath(_CLIP_ROOT).referenceList.Prepend(Sdf.Reference(character_file))
    layer.Export(str(path))


def read_clip_file(path: Path, name: str, character: Character) -> Clip:
    """Return the clip that a file holds, if it moves this character.

    Raises
    ------
    LibraryError
        If the file is missing, is not one of ours, or moves joints or shapes of another character.
    """
    skeleton = character.skeleton
    layer = _open(path, CLIP_SCHEMA)
    animation = f"{_CLIP_ROOT}/{ANIMATION}"
    try:
        joints, rotation, translation, tracks = read_animation(layer, animation, character.shapes)
        if joints != joint_paths(skeleton):
            raise CharacterError("joints: expected those of the library's character")
        data = layer.GetPrimAtPath(animation).customData[_CLIP_DATA]
        contacts = np.array([list(column) for column in data["contacts"]]) == "1"
        return Clip(
            name=name,
            skeleton=skeleton,
            rate_hz=layer.timeCodesPerSecond,
            rotation_xyzw=rotation,
            translation_m=translation,
            stage_end_frames=np.array([data["stage_end_frames"][stage] for stage in STAGES]),
            contact_joints=tuple(data["contact_joints"]),
            contacts=contacts.reshape(-1, len(rotation)).T,
            cyclic=data["cyclic"],
            tracks=tracks,
        )
    except (CharacterError, ValueError) as error:
        raise LibraryError(f"{path}: {error}") from error
    except KeyError as error:
        raise LibraryError(f"{path}: {animation}: expected custom data {error}") from error


def _sign(layer: Sdf.Layer, schema: str, more: dict[str, Any] | None = None) -> None:
    """Write the schema and version of a layer into it."""
    layer.customLayerData = {"smd:schema": schema, "smd:version": VERSION, **(more or {})}


def _open(path: Path, schema: str) -> Sdf.Layer:
    """Return a layer of ours, read without regard to any that is open already."""
    if not path.is_file():
        raise LibraryError(f"{path}: expected a USD file, found none")
    try:
        layer = Sdf.Layer.OpenAsAnonymous(str(path))
    except Tf.ErrorException as error:
        raise LibraryError(f"{path}: expected a USD file, got something else") from error
    data = layer.customLayerData
    if data.get("smd:schema") != schema:
        raise LibraryError(f"{path}: smd:schema: expected {schema!r}")
    if data.get("smd:version") != VERSION:
        raise LibraryError(f"{path}: smd:version: expected {VERSION}")
    return layer
