"""Importers: characters and clips from BVH, glTF and USD files, one module per format."""

from __future__ import annotations

from pathlib import Path

from actions_library.importers.imported import Animation, Imported
from laban.faults import Fault, naming
from smd.errors import CharacterError, ImportedFileError

__all__ = ["SUFFIXES", "Animation", "Imported", "import_file"]

SUFFIXES = (".bvh", ".glb", ".gltf", ".usd", ".usda", ".usdc", ".usdz")
"""Of the files that can be imported."""


def import_file(
    path: Path | str,
    *,
    up: str | None = None,
    unit_m: float | None = None,
    skeleton: str | None = None,
) -> Imported:
    """Read a file's skeleton, meshes and animations, in our convention: metres, +Y up.

    Parameters
    ----------
    path
        Its suffix says which format it has.
    up
        The file's axis that points up, one of ``x -x y -y z -z``; by default what the file says,
        or for a BVH file a guess.
    unit_m
        Metres per unit of the file; by default what the file says, or for a BVH file a guess.
    skeleton
        Name or path of one of a USD file's skeletons; by default the one that moves most.

    Raises
    ------
    ImportedFileError
        If the file is missing, of another format, damaged, or holds no skeleton.
    """
    path = Path(path)
    with naming(path, ImportedFileError):
        try:
            return _read(path, up, unit_m, skeleton)
        except CharacterError as error:
            raise Fault.saying("", str(error)) from error


def _read(path: Path, up: str | None, unit_m: float | None, skeleton: str | None) -> Imported:
    """Read a file by the importer of its suffix; a fault does not name the file."""
    if not path.is_file():
        raise Fault("", "a file", "none")
    suffix = path.suffix.lower()
    if skeleton is not None and not suffix.startswith(".usd"):
        raise Fault("skeleton", "a USD file to choose one from", suffix or "no suffix")
    if suffix == ".bvh":
        from actions_library.importers import bvh

        return bvh.read(path, up=up, unit_m=unit_m)
    if suffix in (".glb", ".gltf"):
        from actions_library.importers import gltf

        return gltf.read(path, up=up, unit_m=unit_m)
    if suffix in (".usd", ".usda", ".usdc", ".usdz"):
        from actions_library.importers import usd

        return usd.read(path, up=up, unit_m=unit_m, skeleton=skeleton)
    raise Fault("", f"a file of {', '.join(SUFFIXES)}", suffix or "no suffix")
