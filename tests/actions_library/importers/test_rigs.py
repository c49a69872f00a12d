from __future__ import annotations

import json

import pytest

from actions_library.importers.rigs import read_rig
from smd.errors import ImportedFileError
from tests.actions_library.importers.test_gltf_rig import lamp
from tests.actions_library.importers.test_usd_rig import LAMP


def test_the_suffix_says_which_file_it_is(tmp_path):
    (tmp_path / "lamp.usda").write_text(LAMP)
    (tmp_path / "lamp.gltf").write_text(json.dumps(lamp()))
    for name, animation in (("lamp.usda", "lamp"), ("lamp.gltf", "nod")):
        rig = read_rig(tmp_path / name)
        assert list(rig.animations) == [animation]
        assert rig.surface_m(rig.animations[animation]).shape[0] == len(rig.animations[animation])
        assert not rig.animations[animation].flags.writeable


@pytest.mark.parametrize("name", ["lamp.bvh", "lamp", "gone.usda", "gone.glb"])
def test_other_files_are_refused(tmp_path, name):
    (tmp_path / "lamp.bvh").write_text("HIERARCHY")
    with pytest.raises(ImportedFileError, match=rf"{name}: expected a .*file"):
        read_rig(tmp_path / name)
