"""The layers that a USD file refers to, checked before USD itself composes them.

Composing opens every layer that is referred to, wherever it is, and waits for what never ends; and
USD's reader of text calls itself once a brace, until the stack is gone and the program with it.
So each layer is looked at first: it is a plain file in the asset's folder, or in its archive, it
is not too large and not nested too deeply. The asset's folder is the one above the first file's,
for assets keep clips, geometry and materials in folders of their own side by side.
"""

from __future__ import annotations

import re
import zipfile
from pathlib import Path, PurePosixPath

from pxr import Ar, Sdf, Tf, Usd

from actions_library.importers.imported import MOST_BYTES
from laban.faults import Fault

_DEEPEST_BRACES = 512
_MOST_LAYERS = 256


def check_layers(path: Path) -> None:
    """Refuse a USD file that leads out of its asset's folder, is too large or too deep.

    Raises
    ------
    Fault
        For the first layer at fault.
    """
    folder = _asset_folder(path)
    pending = [path.resolve()]
    seen: set[Path] = set()
    size = 0
    while pending:
        file = pending.pop()
        if file in seen:
            continue
        seen.add(file)
        if not file.is_relative_to(folder):
            raise Fault("layers", "files of the same asset", repr(str(file))[:120])
        if not file.exists():  # USD goes on without it
            continue
        if not file.is_file():
            raise Fault("layers", "plain files", repr(str(file))[:120])
        size += file.stat().st_size
        if size > MOST_BYTES or len(seen) > _MOST_LAYERS:
            raise Fault("layers", f"at most {MOST_BYTES} bytes, {_MOST_LAYERS} files", "more")
        pending += _led_to(file)


def check_used(path: Path, stage: Usd.Stage) -> None:
    """Refuse a stage that came to use layers from elsewhere after all, or may do so later.

    Raises
    ------
    Fault
        For the first such layer, or prim with value clips.
    """
    folder = _asset_folder(path)
    for layer in stage.GetUsedLayers():
        if layer.realPath and not layer.anonymous:
            file = layer.realPath
            if Ar.IsPackageRelativePath(file):
                file = Ar.SplitPackageRelativePathOuter(file)[0]
            if not Path(file).resolve().is_relative_to(folder):
                raise Fault("layers", "files of the same asset", repr(file)[:120])
    for prim in stage.TraverseAll():
        if prim.HasAuthoredMetadata("clips"):
            raise Fault(str(prim.GetPath()), "no value clips", "some")


def _asset_folder(path: Path) -> Path:
    """Return the folder that an asset's layers lie in: never the root of everything."""
    folder = path.resolve().parent
    above = folder.parent
    return folder if above == above.parent else above


def _led_to(file: Path) -> list[Path]:
    """Return the files outside an archive to which a file's layers refer."""
    found: list[Path] = []
    for layer, package in _layers(file):
        for name in _references(layer):
            if "`" in name or "${" in name:
                raise Fault("layers", "paths without expressions", repr(name)[:80])
            target, _ = Sdf.Layer.SplitIdentifier(layer.ComputeAbsolutePath(name))
            if Ar.IsPackageRelativePath(target):
                outer, inner = Ar.SplitPackageRelativePathOuter(target)
                found.append(Path(outer).resolve())
                if package is not None and ".." in PurePosixPath(inner).parts:
                    raise Fault("archive", "files inside it", repr(name)[:80])
            elif package is None or Path(target).is_absolute():
                found.append(Path(target).resolve())
    return found


def _layers(file: Path) -> list[tuple[Sdf.Layer, Path | None]]:
    """Return a file's layer, or those of an archive, each with the archive that holds it."""
    if file.suffix.lower() != ".usdz":
        _check_depth(file.read_bytes())
        return [(_opened(str(file)), None)]
    layers: list[tuple[Sdf.Layer, Path | None]] = []
    for name in _checked_archive(file):
        inside = Ar.JoinPackageRelativePath([str(file), name])
        layers.append((_opened(inside), file))
    return layers


def _opened(name: str) -> Sdf.Layer:
    try:
        layer = Sdf.Layer.FindOrOpen(name)
    except Tf.ErrorException as error:
        raise Fault("", "a USD file", first_line(error)) from None
    if layer is None:
        raise Fault("", "a USD file", "something else")
    return layer


def _references(layer: Sdf.Layer) -> list[str]:
    try:
        return [str(name) for name in layer.GetCompositionAssetDependencies() if name]
    except (Tf.ErrorException, UnicodeDecodeError) as error:
        raise Fault("", "a USD file", first_line(error)) from None


def _check_depth(data: bytes) -> None:
    """Refuse text whose braces are nested too deeply."""
    if not data.startswith(b"#"):
        return
    deepest = depth = 0
    for found in re.finditer(rb"[({\[]+|[)}\]]+", data):
        count = found.end() - found.start()
        depth = depth + count if found[0][0] in b"({[" else max(depth - count, 0)
        deepest = max(deepest, depth)
    if deepest > _DEEPEST_BRACES:
        raise Fault("", f"braces nested at most {_DEEPEST_BRACES} deep", deepest)


def _checked_archive(file: Path) -> list[str]:
    """Return the names of an archive's layers; refuse one too large, compressed, or leading out."""
    try:
        with zipfile.ZipFile(file) as archive:
            entries = archive.infolist()
            for entry in entries:
                _check_entry(entry)
            total = sum(entry.file_size for entry in entries)
            if total > MOST_BYTES or len(entries) > _MOST_LAYERS:
                most = f"at most {MOST_BYTES} bytes, {_MOST_LAYERS} files"
                raise Fault("archive", most, f"{total}, {len(entries)}")
            names = [entry.filename for entry in entries]
            layers = [n for n in names if n.lower().endswith((".usd", ".usda", ".usdc"))]
            for name in layers:
                _check_depth(archive.read(name))
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, RuntimeError) as error:
        raise Fault("archive", "a zip archive", str(error)[:80]) from None
    if not layers:
        raise Fault("archive", "a USD file in it", "none")
    return layers


def _check_entry(entry: zipfile.ZipInfo) -> None:
    name = entry.filename
    outside = ".." in PurePosixPath(name).parts or name.startswith("/") or "\\" in name
    if outside or ":" in name or "[" in name:
        raise Fault("archive", "files inside it", repr(name)[:80])
    if entry.compress_type != zipfile.ZIP_STORED or entry.compress_size != entry.file_size:
        raise Fault(f"archive: {name[:60]}", "a file as it is", "a compressed one")
    if (entry.external_attr >> 16) & 0o170000 == 0o120000:
        raise Fault(f"archive: {name[:60]}", "a file", "a link")


def first_line(error: Exception) -> str:
    """Return what USD says in an error, without where in its sources."""
    said = re.search(r" : '(.*)'", str(error), re.DOTALL)
    words = (said[1] if said else str(error)).split()
    return " ".join(words)[:100] or "something else"
