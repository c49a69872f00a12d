"""Importers: characters and clips from BVH, glTF and USD files, one module per format."""

from __future__ import annotations

from pathlib import Path

from actions_library.importers.imported import Animation, Imported, fault

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
    if not path.is_file():
        raise fault(path, "", "a file", "none")
    suffix = path.suffix.lower()
    if skeleton is not None and not suffix.startswith(".usd"):
        raise fault(path, "skeleton", "a USD file to choose one from", suffix or "no suffix")
    if suffix == ".bvh":
        from actions_library.importers import bvh

        return bvh.read(path, up=up, unit_m=unit_m)
    if suffix in (".glb", ".gltf"):
        from actions_library.importers import gltf

        return gltf.read(path, up=up, unit_m=unit_m)
    if suffix in (".usd", ".usda", ".usdc", ".usdz"):
        from actions_library.importers import usd

        return usd.read(path, up=up, unit_m=unit_m, skeleton=skeleton)
    raise fault(path, "", f"a file of {', '.join(SUFFIXES)}", suffix or "no suffix")
