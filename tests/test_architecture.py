"""docs/architecture.md is true: its places exist, and imports run the way it says."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
LAYERS = [line.split() for line in re.search(r"```layers\n(.*?)```", PAGE, re.S)[1].splitlines()]
MODULES = sorted(
    path
    for package in ("laban", "smd", "actions_library", "exporters")
    for path in (ROOT / package).rglob("*.py")
)


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def layer_of(module: str) -> int | None:
    """The layer whose longest entry holds the module; None for modules that are not ours."""
    best, found = "", None
    for index, names in enumerate(LAYERS):
        for name in names:
            if (module == name or module.startswith(name + ".")) and len(name) > len(best):
                best, found = name, index
    return found


def imports_of(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            # `from smd import formats` names a module, `from smd.doodle import Doodle` does not
            found |= {
                f"{node.module}.{alias.name}"
                if (ROOT / Path(*node.module.split("."), alias.name)).exists()
                or (ROOT / Path(*node.module.split("."), alias.name + ".py")).exists()
                else node.module
                for alias in node.names
            }
    return found


@pytest.mark.parametrize("path", MODULES, ids=lambda path: module_name(path))
def test_imports_run_one_way(path):
    own = layer_of(module_name(path))
    assert own is not None
    for imported in imports_of(path):
        theirs = layer_of(imported)
        assert theirs is None or theirs <= own, f"{module_name(path)} imports {imported}"


FACE = ("smd", "smd.pipeline", "smd.cli")
"""What users meet: it may ask any package, lazily."""


def package_of(module: str) -> str:
    """Return the innermost package of ours that a module is in; itself where it is one."""
    path = ROOT.joinpath(*module.split("."))
    return module if path.is_dir() else module.rpartition(".")[0]


def is_face(module: str) -> bool:
    return module in FACE or module.startswith("smd.cli.")


def ours(module: str) -> bool:
    return layer_of(module) is not None


def graph_of(node) -> dict[str, set[str]]:
    """Return what each node imports; ``node`` names the one that a module belongs to."""
    graph: dict[str, set[str]] = {}
    for path in MODULES:
        name = module_name(path)
        if is_face(name):
            continue
        imported = {node(one) for one in imports_of(path) if ours(one)}
        graph.setdefault(node(name), set()).update(imported - {node(name)})
    return graph


@pytest.mark.parametrize(
    "node",
    [lambda name: name, package_of, lambda name: name.split(".")[0]],
    ids=["modules", "packages", "top-level packages"],
)
def test_nothing_imports_in_a_circle(node):
    # A module at the top of smd is a package of one, and a program is above what it runs.
    def of(name: str) -> str:
        alone = name.endswith("__main__") or (node is package_of and node(name) == "smd")
        return name if alone else node(name)

    tuple(TopologicalSorter(graph_of(of)).static_order())


def test_a_circle_would_be_found():
    graph = graph_of(lambda name: name)
    graph["smd.geometry.arrays"] = {"smd.transfer.perform"}
    with pytest.raises(CycleError):
        tuple(TopologicalSorter(graph).static_order())


def test_smd_behind_its_face_knows_no_other_package_but_laban():
    assert graph_of(lambda name: name.split(".")[0])["smd"] <= {"laban"}


def test_every_place_on_the_page_exists():
    places = re.findall(r"^\| `([^`]+)` \|", PAGE, re.M)
    assert len(places) > 15
    for place in places:
        assert (ROOT / place).exists(), place


def test_every_module_of_the_tree_is_on_the_page():
    for child in (ROOT / "smd").iterdir():
        if child.name not in {"__init__.py", "__pycache__", "py.typed", "recordings"}:
            name = f"smd/{child.name}/" if child.is_dir() else f"smd/{child.name}"
            assert f"`{name}`" in PAGE, name


def test_importing_smd_and_its_command_line_loads_nothing_heavy():
    heavy = {"numpy", "scipy", "pxr", "vtk", "pyvista", "matplotlib", "sklearn", "openvr"}
    code = "import sys, smd, smd.cli.app; print(*{m.split('.')[0] for m in sys.modules})"
    loaded = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
        timeout=60,
    )
    assert not heavy & set(loaded.stdout.split())


def test_links_between_pages_lead_somewhere():
    for page in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]:
        for link in re.findall(r"\]\((?!https?:|#)([^)#]+)", page.read_text(encoding="utf-8")):
            assert (page.parent / link).exists(), f"{page.name}: {link}"


def stays_in_the_tree(module: str) -> bool:
    """Whether a module makes the shipped library, and so never runs where that is installed."""
    return f"{module}.".startswith("actions_library.authoring.")


def test_every_package_that_runs_is_in_the_wheel():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    listed = set(project["tool"]["setuptools"]["packages"])
    folders = {module_name(path) for path in MODULES if path.name == "__init__.py"}
    run = {folder for folder in folders if not stays_in_the_tree(folder)}
    shipped = {f"actions_library.{name}" for name in ("humanoid", "dog", "dragon", "moon")}
    assert listed == run | shipped | {"smd.recordings"}


def test_nothing_in_the_wheel_imports_what_stays_in_the_tree():
    for path in MODULES:
        if not stays_in_the_tree(module_name(path)):
            assert not [name for name in imports_of(path) if stays_in_the_tree(name)], path
