"""Surfaces of rigs: `OMP_NUM_THREADS=1 python -m benchmarks.rigs`.

A synthetic USD file of 742 controls and the shipped humanoid, 100 poses each, wall time of the best
of five.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom

from actions_library.folder import load_library
from actions_library.importers.rigs import read_rig
from smd.character.character_rig import CharacterRig
from smd.character.rig import ControlRig
from smd.geometry.arrays import FloatArray

CONTROLS, POSES, TIMES = 742, 100, 5


def write_many_controls(path: Path, count: int) -> None:
    """Write a USD file of triangles that each turn by a control of their own."""
    stage = Usd.Stage.CreateInMemory()
    stage.SetTimeCodesPerSecond(24.0)
    for k in range(count):
        turn = UsdGeom.Xform.Define(stage, f"/Rig/Turn_{k}").AddRotateYOp()
        for code, degrees in ((0.0, 0.0), (24.0, 90.0)):
            turn.Set(degrees, code)
        mesh = UsdGeom.Mesh.Define(stage, f"/Rig/Turn_{k}/Mesh")
        mesh.CreatePointsAttr([(0.0, k, 0.0), (1.0, k, 0.0), (0.0, k + 1.0, 0.0)])
        mesh.CreateFaceVertexCountsAttr([3])
        mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
    stage.GetRootLayer().Export(str(path))


def random_poses(rig: ControlRig, count: int) -> FloatArray:
    """Return poses within the ranges of a rig's controls."""
    controls = rig.controls
    rng = np.random.default_rng(0)
    return rng.uniform(controls.low, controls.high, size=(count, len(controls)))


def told(name: str, rig: ControlRig) -> str:
    """Return what surfaces of a rig cost, in words."""
    poses, spent = random_poses(rig, POSES), []
    for _ in range(TIMES):
        start = time.perf_counter()
        surface = rig.surface_m(poses)
        spent.append(time.perf_counter() - start)
    each_ms = 1000.0 * min(spent) / POSES
    return (
        f"{name}: {len(rig.controls)} controls, {surface.shape[1]} points, {each_ms:.2f} ms a pose"
    )


def main() -> None:
    """Print what a pose of each rig costs."""
    library = load_library()
    print(told("humanoid", CharacterRig(library.character, list(library.clips.values()))))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "many.usdc")
        write_many_controls(path, CONTROLS)
        print(told("USD file", read_rig(path)))


if __name__ == "__main__":
    main()
