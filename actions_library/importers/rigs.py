"""Files without skeleton as rigs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from laban.faults import Fault
from smd.character.rig import ControlRig
from smd.errors import ImportedFileError
from smd.geometry.arrays import FloatArray


class FileRig(ControlRig, Protocol):
    """A rig that came from a file, with the poses that the file has."""

    @property
    def animations(self) -> Mapping[str, FloatArray]:
        """The file's own poses ``(n, d)`` by name."""

    @property
    def rate_hz(self) -> float:
        """Frames a second of all of them."""


def read_rig(path: Path | str, *, up: str | None = None, unit_m: float | None = None) -> FileRig:
    """Read a USD or glTF file without skeleton as a rig: what it animates are the controls.

    A file with a skeleton is a character: `actions_library.importers.import_file`.

    Parameters
    ----------
    path
        Its suffix says which format it has.
    up, unit_m
        As in `actions_library.importers.import_file`.

    Raises
    ------
    ImportedFileError
        If it is missing, of another format or damaged, has a skeleton, animates no number, or shows
        no mesh of one topology.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix in (".usd", ".usda", ".usdc", ".usdz"):
        from actions_library.importers.usd_rig import read_usd_rig

        return read_usd_rig(path, up=up, unit_m=unit_m)
    if suffix in (".gltf", ".glb"):
        from actions_library.importers.gltf_rig import read_gltf_rig

        return read_gltf_rig(path, up=up, unit_m=unit_m)
    bad = Fault("", "a file of .usd, .usda, .usdc, .usdz, .gltf, .glb", suffix or "no suffix")
    raise bad.of(path, ImportedFileError)
