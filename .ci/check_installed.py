"""The installed package holds what runs, whole and nothing else: compared with a checkout's files.

Usage: python check_installed.py CHECKOUT, with the Python that it is installed in. That Python is
run outside of the checkout, so that only what is installed can be imported.
"""

from __future__ import annotations

import importlib.metadata
import sys
import tomllib
from pathlib import Path, PurePosixPath

ONLY_IN_A_CHECKOUT = ("actions_library/authoring/",)
PACKAGES = ("actions_library", "exporters", "laban", "smd")
INSTALLED_AS = {"recordings": "smd/recordings"}


def expected(checkout: Path) -> set[str]:
    """Return the names that the package should have, of a checkout's files."""
    names = set()
    for folder in (*PACKAGES, *INSTALLED_AS):
        for path in (checkout / folder).rglob("*"):
            name = path.relative_to(checkout).as_posix()
            if path.is_file() and "__pycache__" not in path.parts:
                names.add(name.replace(folder, INSTALLED_AS.get(folder, folder), 1))
    return {name for name in names if not name.startswith(ONLY_IN_A_CHECKOUT)}


def installed(project: str) -> dict[str, Path]:
    """Return the files that were installed, but for the compiled ones and what pip adds."""
    files = importlib.metadata.files(project)
    if files is None:
        raise SystemExit(f"{project}: no list of the files that were installed")
    return {
        path.as_posix(): Path(path.locate())
        for path in files
        if path.suffix != ".pyc"
        and not path.parts[0].endswith(".dist-info")
        and ".." not in path.parts
    }


def main() -> None:
    """Compare, and say what is missing and what is too much."""
    checkout = Path(sys.argv[1]).resolve()
    project = tomllib.loads((checkout / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found, wanted = installed(project["name"]), expected(checkout)
    faults = [f"missing: {name}" for name in sorted(wanted - set(found))]
    faults += [f"too much: {name}" for name in sorted(set(found) - wanted)]
    import smd

    if checkout in Path(smd.__file__).resolve().parents:
        faults.append(f"smd was imported from the checkout: {smd.__file__}")
    if faults:
        raise SystemExit("\n".join(faults))
    size_mb = sum(path.stat().st_size for path in found.values()) / 1e6
    kinds = sorted({PurePosixPath(name).parts[0] for name in found})
    print(f"{project['name']}: {len(found)} files, {size_mb:.1f} MB, of {', '.join(kinds)}")


if __name__ == "__main__":
    main()
