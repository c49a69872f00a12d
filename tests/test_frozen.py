"""Every domain type crosses a process: pickled and made again, it is the same and as frozen."""

from __future__ import annotations

import importlib
import inspect
import pickle
import pkgutil
import re
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import actions_library
import exporters
import laban
import smd
from actions_library.library import Library
from laban.frozen import Frozen
from smd.acting.grip import with_props_held
from smd.acting.terrain import Terrain
from smd.cast import Cast
from smd.character.ik import limb_of
from smd.character.mass import mass_of
from smd.recognition.automaton import compile_automaton
from smd.recognition.compiled_actions import compile_actions
from smd.recognition.lever import LeverArm
from smd.recognition.recognizer import Recognizer
from smd.score import Score
from smd.transfer.path import ground_path
from smd.transfer.scene import scene_scale
from tests.naive.puppet import waving_clip
from tests.naive.shaped import shaped_performance


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


def roots() -> list[Any]:
    """Objects that hold, all together, one of every class that freezes."""
    played = shaped_performance(seconds=1.0, rate_hz=24.0)
    library = smd.load_library()
    actor = played.actors[0]
    skeleton = actor.character.skeleton
    recording = smd.Recording(actor.doodles, "made up", metadata={"up": "y"})
    arm = [f"left_{part}" for part in ("upper_arm", "lower_arm", "hand")]
    stage = scene_scale(recording, 1.75, 0.175)
    square = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    pattern = library.action("wave").pattern
    return [
        played,
        recording,
        waving_clip(),
        Cast(library, {"prop": library}),
        library,
        Library("mine", Path("mine"), (library.action("idle"),), "c.usdc", {"idle": "i.usdc"}),
        library.action("wave"),
        Terrain(square, np.array([[0, 1, 2], [0, 2, 3]]), name="square"),
        limb_of(skeleton, *arm, [0.0, 0.0, 1.0]),
        smd.smooth(actor.doodles[0]),
        LeverArm(np.zeros(3), np.ones(3), 0.1, 0.2, 0.1, 6.0),
        laban.load_effort_model(),
        stage,
        ground_path(actor.doodles, stage),
        compile_actions(library),
        compile_automaton(pattern),
        Score((), "made up"),
        mass_of(skeleton),
        with_props_held(played.actors),
    ]


def held(value: Any, path: str = "", seen: set[int] | None = None) -> Iterator[tuple[str, Any]]:
    """Yield all that an object is made of, with where it is."""
    seen = set() if seen is None else seen
    yield path or type(value).__name__, value
    if is_dataclass(value):
        parts = {field.name: getattr(value, field.name, None) for field in fields(value)}
    elif isinstance(value, Mapping):
        parts = {str(name): part for name, part in value.items()}
    elif isinstance(value, tuple | list):
        parts = {str(index): part for index, part in enumerate(value)}
    else:
        return
    if id(value) in seen:
        return
    seen.add(id(value))
    for name, part in parts.items():
        yield from held(part, f"{path or type(value).__name__}.{name}", seen)


ROOTS = roots()


def test_every_class_that_freezes_is_frozen_again_where_it_arrives():
    assert len(FREEZING) > 15
    assert not [kind.__name__ for kind in FREEZING if not issubclass(kind, Frozen)]


def test_an_object_of_every_class_that_freezes_is_tried():
    tried = {type(part) for root in ROOTS for _, part in held(root)}
    assert not [kind.__name__ for kind in FREEZING if kind not in tried]


@pytest.mark.parametrize("root", ROOTS, ids=lambda root: type(root).__name__)
def test_what_crosses_a_process_is_the_same_and_as_frozen(root):
    again = dict(held(pickle.loads(pickle.dumps(root))))
    before = dict(held(root))
    assert again.keys() == before.keys()
    for path, part in before.items():
        assert type(again[path]) is type(part), path
        if isinstance(part, np.ndarray):
            np.testing.assert_array_equal(again[path], part, err_msg=path)
            assert part.flags.writeable or not again[path].flags.writeable, path
        elif not isinstance(part, tuple | list | Mapping) and not is_dataclass(part):
            assert again[path] == part or part != part, path


def test_a_parser_pickles_small_and_reads_the_same_on_the_other_side():
    parser = smd.Parser(smd.load_library(), tolerance=0.9)
    text = pickle.dumps(parser)
    assert len(text) < 1000
    recording = smd.read_recording(Path(__file__).parents[1] / "recordings" / "postman.csv")
    assert pickle.loads(text).parse(recording) == parser.parse(recording)


def test_a_recognizer_pickles_as_what_it_was_made_of():
    library = smd.load_library()
    actions = [library.action("wave"), library.action("bow")]
    one = Recognizer(actions, tolerance=0.8)
    other = pickle.loads(pickle.dumps(one))
    doodle = swinging()
    assert other.names == one.names
    assert other.rank(doodle) == one.rank(doodle)


def swinging() -> smd.Doodle:
    """A prop that swings to and fro for one and a half seconds."""
    time_s = np.linspace(0.0, 1.5, 136)
    place = np.stack([0.1 * np.sin(6.0 * time_s), 0.0 * time_s, 0.0 * time_s], axis=-1)
    return smd.Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (136, 1)), "prop")
