"""What a small file may cost: 10 s of a processor and 1 GiB, whatever it says."""

from __future__ import annotations

import base64
import io
import json
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from pxr import Sdf, Usd, UsdGeom, UsdSkel, Vt

from tests.actions_library.importers.test_gltf import appended, document
from tests.actions_library.importers.test_usd import ARM

pytest.importorskip("resource", reason="a process's costs are asked of Unix")

MOST_S, MOST_MB = 10.0, 1024

IMPORT = """
import resource, sys
from actions_library.importers import import_file
from smd.errors import ImportedFileError
try:
    import_file(sys.argv[1])
except ImportedFileError as error:
    print(error, file=sys.stderr)
used = resource.getrusage(resource.RUSAGE_SELF)
kilobytes = used.ru_maxrss / (1024 if sys.platform == "darwin" else 1)  # there it is in bytes
try:  # where a process was forked from a large one, ru_maxrss is what that one took
    with open("/proc/self/status") as status:
        kilobytes = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
except OSError:
    pass
print(used.ru_utime + used.ru_stime, kilobytes / 1024)
"""


def costs(path: Path) -> tuple[float, float]:
    """Return the seconds of a processor and the megabytes that a file's import takes."""
    done = subprocess.run(
        [sys.executable, "-c", IMPORT, path], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    seconds, megabytes = done.stdout.split()
    return float(seconds), float(megabytes)


def wide_json(path: Path) -> None:
    path.write_text('{"asset":{"version":"2.0"},"x":[' + "{}," * 10_000_000 + "{}]}")


def large_picture(path: Path) -> None:
    whole, data = document(), io.BytesIO()
    Image.new("RGB", (8192, 8192)).save(data, "PNG")
    uri = "data:image/png;base64," + base64.b64encode(data.getvalue()).decode()
    primitive = whole["meshes"][0]["primitives"][0]
    whole["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC2"})
    primitive["attributes"]["TEXCOORD_0"] = len(whole["accessors"]) - 1
    whole["images"] = [{"uri": uri}] * 12
    whole["textures"] = [{"source": k} for k in range(12)]
    surfaces = ({"baseColorTexture": {"index": k}} for k in range(12))
    whole["materials"] = [{"pbrMetallicRoughness": surface} for surface in surfaces]
    whole["meshes"][0]["primitives"] = [{**primitive, "material": k} for k in range(12)]
    path.write_text(json.dumps(whole))


def numbers_from_nothing(path: Path) -> None:
    whole = document()
    for i, (component, kind) in enumerate(((5126, "VEC3"), (5121, "VEC4"), (5126, "VEC4"))):
        whole["accessors"][i] = {"componentType": component, "count": 4_000_000, "type": kind}
    whole["meshes"][0]["primitives"] *= 50
    path.write_text(json.dumps(whole))


def endless_animations(path: Path) -> None:
    whole = document()
    whole["animations"] *= 200_000
    path.write_text(json.dumps(whole))


def many_animations(path: Path) -> None:
    whole = document()
    whole["animations"] *= 2000
    path.write_text(json.dumps(whole))


def archive_of_gigabytes(path: Path) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("a.usda", "#usda 1.0\n")
    data = path.read_bytes()
    at = data.rindex(b"PK\x01\x02") + 20  # sizes in the directory
    path.write_bytes(data[:at] + (3 << 30).to_bytes(4, "little") * 2 + data[at + 8 :])


def endless_braces(path: Path) -> None:
    path.write_text("#usda 1.0\n" + 'def "a" {' * 1_000_000)


def empty_lines(path: Path) -> None:
    path.write_text("HIERARCHY" + "\n" * 50_000_000)


def shared_targets(path: Path) -> None:
    whole, count = document(), 100_000
    moved = appended(whole, np.ones((count, 3), dtype="<f4"), "VEC3", 5126)
    primitive = whole["meshes"][0]["primitives"][0]
    for i, (component, kind) in enumerate(((5126, "VEC3"), (5121, "VEC4"), (5126, "VEC4"))):
        whole["accessors"].append({"componentType": component, "count": count, "type": kind})
        name = ("POSITION", "JOINTS_0", "WEIGHTS_0")[i]
        primitive["attributes"][name] = len(whole["accessors"]) - 1
    primitive["targets"] = [{"POSITION": moved}] * 4000
    path.write_text(json.dumps(whole))


def shared_offsets(path: Path) -> None:
    """A crate keeps equal arrays once: 2000 shapes of 100,000 points take 1.4 MB."""
    stage = Usd.Stage.CreateInMemory()
    stage.GetRootLayer().ImportFromString(ARM)
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/Root/Skin"))
    count = 100_000
    binding = UsdSkel.BindingAPI(mesh)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray(count))
    for primvar in (binding.GetJointIndicesPrimvar(), binding.GetJointWeightsPrimvar()):
        primvar.SetElementSize(1)
        primvar.GetAttr().Set(type(primvar.Get())(count))
    offsets, names = Vt.Vec3fArray(count, (1.0, 0.0, 0.0)), [f"s{k}" for k in range(2000)]
    with Sdf.ChangeBlock():
        for name in names:
            holder = stage.GetRootLayer().GetPrimAtPath("/Root/Skin")
            shape = Sdf.PrimSpec(holder, name, Sdf.SpecifierDef, "BlendShape")
            kind = Sdf.ValueTypeNames.Vector3fArray
            Sdf.AttributeSpec(shape, "offsets", kind, Sdf.VariabilityUniform).default = offsets
    binding.GetBlendShapesAttr().Set(names)
    binding.GetBlendShapeTargetsRel().SetTargets([f"/Root/Skin/{name}" for name in names])
    stage.GetRootLayer().Export(str(path))
    assert path.stat().st_size < 3_000_000


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (wide_json, "a.gltf"),
        (large_picture, "a.gltf"),
        (numbers_from_nothing, "a.gltf"),
        (endless_animations, "a.gltf"),
        (many_animations, "a.gltf"),
        (archive_of_gigabytes, "a.usdz"),
        (endless_braces, "a.usda"),
        (empty_lines, "a.bvh"),
        (shared_targets, "a.gltf"),
        (shared_offsets, "a.usdc"),
    ],
)
def test_a_file_costs_no_more_than_is_allowed(tmp_path, make, name):
    make(tmp_path / name)
    seconds, megabytes = costs(tmp_path / name)
    assert seconds < MOST_S
    assert megabytes < MOST_MB
