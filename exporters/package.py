"""A layer as a .usdz package."""

from __future__ import annotations

import tempfile
import zipfile
from pathlib import Path

from pxr import Sdf

_ALIGNMENT = 64  # readers map the layers inside straight into memory


def write_package(layer: Sdf.Layer, path: Path) -> None:
    """Write a layer as usdz: a zip, neither compressed nor dated, whose content is aligned.

    USD's own writer stamps each file with its date in local time, so that no two packages of
    one performance were ever the same.
    """
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder) / "performance.usdc"
        layer.Export(str(inside))
        entry = zipfile.ZipInfo(inside.name, date_time=(1980, 1, 1, 0, 0, 0))
        entry.create_system = 3  # else the package tells which system made it
        header = 30 + len(entry.filename.encode())  # of a zip's local file header
        padding = -(header + 4) % _ALIGNMENT
        entry.extra = b"\x86\x19" + padding.to_bytes(2, "little") + bytes(padding)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as package:
            package.writestr(entry, inside.read_bytes())
