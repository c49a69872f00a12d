"""Recordings that nobody on this project made."""

from __future__ import annotations

import json

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
    roots = [prim for prim in stage.Traverse() if prim.IsA(UsdSkel.Root)]
    hands = {"left", "right"} if name == "tracked-recording" else {"leftHand", "rightHand"}
    assert {prim.GetName() for prim in roots} == hands
    animations = [UsdSkel.Animation(p) for p in stage.Traverse() if p.IsA(UsdSkel.Animation)]
    assert len(animations) == 2
    for animation in animations:
        for attribute in (animation.GetRotationsAttr(), animation.GetTranslationsAttr()):
            codes = attribute.GetTimeSamples()
            assert len(codes) > 300
            for code in codes:
                values = attribute.Get(code)
                parts = (
                    [[q.GetReal(), *q.GetImaginary()] for q in values]
                    if hasattr(values[0], "GetReal")
                    else values
                )
                assert np.isfinite(np.array(parts)).all()


@pytest.mark.parametrize(
    ("folder", "options", "files"),
    [("controllers/kettle", ["--quaternion", "xyzw"], 7), ("idle", ["--handedness", "left"], 18)],
)
def test_folders_of_other_trackers_are_read(run_smd, shared_data, folder, options, files):
    code, out, err = run_smd("parse", shared_data / folder, *options, "--json")
    assert (code, err) == (0, "")
    scores = json.loads(out)
    assert len(scores) == files
    assert all(score["reading"] == dict([[options[0][2:], options[1]]]) for score in scores)
