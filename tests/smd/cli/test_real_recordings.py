"""Recordings that nobody on this project made."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest


@pytest.mark.parametrize("name", ["tracked-recording", "dance"])
def test_two_controllers_become_two_performers_on_a_valid_stage(
    run_smd, shared_data, tmp_path, name
):
    from pxr import Usd, UsdSkel, UsdValidation

    output = tmp_path / "out.usda"
    take = shared_data / "controllers" / "aframe" / "raw" / f"{name}.json"
    assert run_smd("convert", take, "-o", output)[0] == 0
    stage = Usd.Stage.Open(str(output))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    found = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [error.GetMessage() for error in found] == []
    skeletons = [prim for prim in stage.Traverse() if prim.IsA(UsdSkel.Skeleton)]
    hands = {"left", "right"} if name == "tracked-recording" else {"leftHand", "rightHand"}
    assert {prim.GetName() for prim in skeletons} == hands
    animations = [UsdSkel.Animation(p) for p in stage.Traverse() if p.IsA(UsdSkel.Animation)]
    assert len(animations) == 2
    for animation in animations:
        for attribute in (animation.GetRotationsAttr(), animation.GetTranslationsAttr()):
            codes = attribute.GetTimeSamples()
            assert len(codes) > 300
            for code in codes:
                assert np.isfinite(np.array(attribute.Get(code))).all()


@pytest.mark.parametrize(
    ("folder", "options", "files"),
    [("controllers/kettle", ["--quaternion", "xyzw"], 7), ("idle", ["--handedness", "left"], 6)],
)
def test_folders_of_other_trackers_are_read(run_smd, shared_data, tmp_path, folder, options, files):
    """Of the idle hands every third: tests of formats read all of them."""
    there = sorted((shared_data / folder).glob("*.csv"))
    for path in there[:: len(there) // files]:
        shutil.copy(path, tmp_path)
    code, out, err = run_smd("parse", tmp_path, *options, "--json")
    assert (code, err) == (0, "")
    scores = json.loads(out)
    assert len(scores) == files
    assert all(score["reading"] == dict([[options[0][2:], options[1]]]) for score in scores)
