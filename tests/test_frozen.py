"""Every domain type crosses a process: pickled and made again, it is the same and as frozen."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

import actions_library
import exporters
import laban
import smd
from smd.acting.performance import Performance
from smd.acting.terrain import Terrain
from smd.cast import Cast
from smd.character.ik import limb_of
from smd.recognition.lever import LeverArm
from smd.score import Score
from smd.transfer.path import ground_path
from smd.transfer.stage import stage_for
from tests.naive.puppet import performance, waving_clip


def classes() -> Iterator[type[Any]]:
    """Every class that our packages define."""
    for package in (laban, smd, actions_library, exporters):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if found.name.endswith("__main__") or ".capture.openvr" in found.name:
                continue
            module = importlib.import_module(found.name)
            for _, kind in inspect.getmembers(module, inspect.isclass):
                if kind.__module__ == module.__name__:
                    yield kind


def freezes(kind: type[Any]) -> bool:
    """Tell whether a class makes read-only copies of what it is given."""
    source = inspect.getsource(kind)
    return is_dataclass(kind) and bool(
        re.search(r"frozen_array\(|flags\.writeable|MappingProxyType\(", source)
    )


FREEZING = sorted({kind for kind in classes() if freezes(kind)}, key=lambda kind: kind.__name__)


def made() -> list[Any]:
    """At least one object of every class that freezes, and of those that hold them."""
    played: Performance = performance(seconds=1.0, rate_hz=24.0)
    library = smd.load_library()
    actor = played.actors[0]
    recording = smd.Recording(actor.doodles, "made up", metadata={"up": "y"})
    parser = smd.Parser(library)
    stage = stage_for(recording, 1.75, 0.175)
    skeleton = actor.character.skeleton
    arm = [f"left_{part}" for part in ("upper_arm", "forearm", "hand")]
    arm = [name for name in arm if name in skeleton.joints] or list(skeleton.joints[2:5])
    square = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    recognizer = parser.recognizer("prop")
    return [
        played,
        recording,
        waving_clip(),
        Cast(library, {"prop": library}),
        Terrain(square, np.array([[0, 1, 2], [0, 2, 3]]), name="square"),
        limb_of(skeleton, *arm, [0.0, 0.0, 1.0]),
        smd.smooth(actor.doodles[0]),
        LeverArm(np.zeros(3), np.zeros(3), 1.0, 0.1) if len(fields(LeverArm)) == 4 else None,
        laban.load_effort_model(),
        stage,
        ground_path(actor.doodles, stage),
        *vars(recognizer).values(),
        *vars(recognizer._tokens).values(),
        parser,
        Score((), "made up"),
    ]
