"""Importers: characters and clips from BVH, glTF and USD files, one module per format."""

from __future__ import annotations

from pathlib import Path

from actions_library.importers.format import Importer, ImportFormat, ImportOptions
from actions_library.importers.imported import Animation, Imported
from laban.faults import Fault, naming
from smd.errors import CharacterError, ImportedFileError

__all__ = ["FORMATS", "SUFFIXES", "Animation", "Imported", "import_file"]


def _bvh() -> Importer:
    from actions_library.importers import bvh

    return bvh


def _gltf() -> Importer:
    from actions_library.importers import gltf

    return gltf


def _usd() -> Importer:
    from actions_library.importers import usd

    return usd


FORMATS = (
    ImportFormat("BVH", (".bvh",), _bvh),
    ImportFormat("glTF", (".glb", ".gltf"), _gltf),
    ImportFormat("USD", (".usd", ".usda", ".usdc", ".usdz"), _usd, has_skeletons=True),
)
"""Those of characters and clips; a file's suffix says which one it has."""

SUFFIXES = tuple(suffix for each in FORMATS for suffix in each.suffixes)
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
            return _read(path, ImportOptions(up, unit_m, skeleton))
        except CharacterError as error:
            raise Fault.saying("", str(error)) from error


def _read(path: Path, asked: ImportOptions) -> Imported:
    """Read a file by the importer of its suffix; a fault does not name the file."""
    if not path.is_file():
        raise Fault("", "a file", "none")
    suffix = path.suffix.lower()
    found = next((each for each in FORMATS if suffix in each.suffixes), None)
    if asked.skeleton is not None and not (found and found.has_skeletons):
        several = " or ".join(each.name for each in FORMATS if each.has_skeletons)
        raise Fault("skeleton", f"a {several} file to choose one from", suffix or "no suffix")
    if found is None:
        raise Fault("", f"a file of {', '.join(SUFFIXES)}", suffix or "no suffix")
    return found.importer().read(path, asked)
