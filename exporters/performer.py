"""One performer of a USD stage: its character, its doodles and its prop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from pxr import Usd, UsdSkel, Vt

from actions_library.stage_frame import StageFrame
from actions_library.usd_skel import (
    bind_animation,
    define_animation,
    define_character,
    set_samples,
)
from exporters.bounds import body_boxes
from exporters.keys import key_frames
from exporters.palette import RGB, performer_colors
from exporters.phrases import name_phrases
from exporters.scenery import define_doodle, define_prop
from smd.acting.performance import Actor, Performance
from smd.geometry.arrays import FloatArray

DEVICE_KEY = "smd:device"
"""In a SkelRoot's custom data."""

EXPRESSION, NEUTRAL, EXPRESSIVE = "expression", "neutral", "expressive"
"""A SkelRoot's variant set, where it has one, and its variants; the last is selected."""


class Places(NamedTuple):
    """Where a performer's prims are.

    Blender names objects after prims, whatever their paths, and numbers names that it meets twice.

    Attributes
    ----------
    actor, doodle, prop : paths of its SkelRoot, its doodle and its prop.
    skeleton, animation : names of its Skeleton and its SkelAnimation, both under the SkelRoot.
    """

    actor: str
    doodle: str
    prop: str
    skeleton: str
    animation: str


@dataclass(frozen=True, slots=True, eq=False)
class Performer:
    """An actor of a performance.

    Attributes
    ----------
    performance : what it plays in.
    index : which of its actors it is.
    neutral : the same actor without expression, where that is shown too.
    keys_within_m : how far few keys may lead its skin from where it is (`exporters.keys`); None
        for a key each frame.
    """

    performance: Performance
    index: int
    neutral: Actor | None = None
    keys_within_m: float | None = None

    @property
    def actor(self) -> Actor:
        """What it plays."""
        return self.performance.actors[self.index]


def define_performer(
    stage: Usd.Stage, places: Places, performer: Performer, action_colors: Mapping[str, RGB]
) -> FloatArray:
    """Define a performer and return the bounding boxes of its body, ``(n, 2, 3)`` metres, Y up."""
    actor = performer.actor
    character = actor.character
    colors = performer_colors(character, performer.index)
    root = define_character(
        stage,
        places.actor,
        character,
        colors,
        skeleton=places.skeleton,
        animation=places.animation,
    )
    prim = root.GetPrim()
    prim.SetCustomDataByKey(DEVICE_KEY, actor.name)
    prim.SetDisplayName(actor.name)
    name_phrases(prim, performer.performance, actor.phrases)
    animation = f"{places.actor}/{places.animation}"
    within_m = performer.keys_within_m
    if performer.neutral is None:
        boxes = _define_acting(root, animation, actor, within_m)
    else:
        boxes = _define_variants(root, animation, actor, performer.neutral, within_m)
    # Its target's path, not its prim: inside a variant it is there only while that is selected.
    bind_animation(root, UsdSkel.Animation.Get(stage, animation), places.skeleton)
    if actor.doodles:
        define_doodle(stage, places.doodle, actor, action_colors)
        define_prop(stage, places.prop, actor, performer.performance)
    return boxes


def _define_variants(
    root: UsdSkel.Root,
    animation: str,
    expressive: Actor,
    neutral: Actor,
    keys_within_m: float | None,
) -> FloatArray:
    """Define both animations as variants, and return the boxes of both, ``(n, 2, 3)``."""
    variants = root.GetPrim().GetVariantSets().AddVariantSet(EXPRESSION)
    boxes = {}
    for name, actor in ((NEUTRAL, neutral), (EXPRESSIVE, expressive)):
        variants.AddVariant(name)
        variants.SetVariantSelection(name)
        with variants.GetVariantEditContext():
            boxes[name] = _define_acting(root, animation, actor, keys_within_m)
    return np.concatenate([boxes[NEUTRAL], boxes[EXPRESSIVE]])


def _define_acting(
    root: UsdSkel.Root, animation: str, actor: Actor, keys_within_m: float | None
) -> FloatArray:
    """Define an actor's animation, and return its bounding box in each frame, ``(n, 2, 3)``."""
    stage, character = root.GetPrim().GetStage(), actor.character
    boxes = body_boxes(character, *actor.poses, actor.tracks)
    frames = None
    if keys_within_m is not None:
        frames = key_frames(character, actor.poses, keys_within_m, actor.tracks)
        boxes = boxes + np.array([[-keys_within_m], [keys_within_m]])
    define_animation(
        stage,
        animation,
        character.skeleton,
        *actor.poses,
        frames,
        tracks=actor.tracks,
        shapes=character.shapes,
    )
    extents = StageFrame.of(stage).boxes(boxes)
    set_samples(root.CreateExtentAttr(), extents, Vt.Vec3fArray)
    return boxes
