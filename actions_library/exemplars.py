"""A library's ``exemplars/<action>.npz``: what verification remembers of an action's examples.

Plain arrays, compressed, read without pickle: a file can hold numbers and nothing that runs.
"""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path

import numpy as np

from smd.errors import DoodleError, LibraryError
from smd.geometry.arrays import FloatArray
from smd.recognition.exemplar import Exemplar, Ownership

MOST_NUMBERS = 50_000_000
"""In one array: 400 MB, a hundred thousand examples. More is a broken header."""


def write_exemplar(path: Path, exemplar: Exemplar) -> None:
    """Write an exemplar, in single precision; the same one gives the same bytes."""
    arrays = {key: array.astype(np.float32) for key, array in sorted(exemplar.to_arrays().items())}
    np.savez_compressed(path, allow_pickle=False, **arrays)


def read_exemplar(path: Path, own: Ownership = False) -> Exemplar:
    """Return the exemplar that a file holds.

    Parameters
    ----------
    path
        Of the file.
    own
        Which examples are the performer's own; ``library.json`` says it.

    Raises
    ------
    LibraryError
        If the file is missing, damaged or not one of ours, or has no example of some number; it
        names the file and the key.
    """
    if not path.is_file():
        raise LibraryError(f"{path}: expected an exemplar, found no such file")
    try:
        with zipfile.ZipFile(path) as archive:
            arrays = {
                name.removesuffix(".npy"): _array(path, archive, name)
                for name in archive.namelist()
            }
    except (OSError, zipfile.BadZipFile) as error:
        raise LibraryError(f"{path}: expected an npz file of arrays, found: {error}") from error
    try:
        return Exemplar.from_arrays(arrays, own)
    except DoodleError as error:
        raise LibraryError(f"{path}: {error}") from error


def _array(path: Path, archive: zipfile.ZipFile, name: str) -> FloatArray:
    """Return one array of the archive, if it holds floating-point numbers."""
    key = name.removesuffix(".npy")
    try:
        with archive.open(name) as stream:
            version = np.lib.format.read_magic(stream)
            read_header = {
                (1, 0): np.lib.format.read_array_header_1_0,
                (2, 0): np.lib.format.read_array_header_2_0,
            }.get(version)
            shape, _, dtype = read_header(stream) if read_header else ((), False, np.dtype("O"))
        if dtype.kind != "f" or np.prod(shape, dtype=float) > MOST_NUMBERS:
            raise LibraryError(
                f"{path}: {key}: expected floating-point numbers, got {shape} of {dtype}"
            )
        with archive.open(name) as stream:
            return np.asarray(np.lib.format.read_array(stream, allow_pickle=False), np.float64)
    except (ValueError, EOFError, OSError, zlib.error, zipfile.BadZipFile) as error:
        raise LibraryError(f"{path}: {key}: expected an array, found: {error}") from error
    except (NotImplementedError, RuntimeError) as error:  # another compression, a password
        raise LibraryError(f"{path}: {key}: expected a plain npz file: {error}") from error
