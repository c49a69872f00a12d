"""docs/api.md is what the code says, and holds what examples and docs use."""

from __future__ import annotations

import ast
import importlib.util
import re
import sys
import textwrap
from pathlib import Path
from types import ModuleType

import pytest

import laban
import smd

ROOT = Path(__file__).parents[1]
OURS = ("smd", "laban", "actions_library", "exporters")


@pytest.fixture(scope="module")
def make_api() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_api", ROOT / "docs" / "make_api.py")
    made = sys.modules[spec.name] = importlib.util.module_from_spec(spec)  # dataclasses look there
    spec.loader.exec_module(made)
    return made


def snippets() -> list[str]:
    """The Python of examples/ and of the pages, as a reader sees it."""
    found = [path.read_text(encoding="utf-8") for path in (ROOT / "examples").glob("*.py")]
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        text = page.read_text(encoding="utf-8")
        found += map(textwrap.dedent, re.findall(r"^ *```python\n(.*?)^ *```", text, re.S | re.M))
    return found


def names_used(text: str) -> set[str]:
    tree = ast.parse(text)
    said = {
        f"{node.module}.{one.name}"
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module.split(".")[0] in OURS
        for one in node.names
    }
    return said | {
        f"smd.{node.attr}"
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "smd"
    }


def test_the_page_is_what_the_code_says(make_api):
    written = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    assert written == make_api.page(), "run `python docs/make_api.py`"


@pytest.mark.parametrize("face", [smd, laban], ids=["smd", "laban"])
def test_every_public_name_says_what_it_is(make_api, face):
    for name in face.__all__:
        assert make_api.first_line(face.__name__, name).endswith(".")


def test_what_examples_and_pages_use_is_on_the_page():
    page = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"^\| `([\w.]+)` \|", page, re.M))
    # `load_library` and its like stand on the page as `smd.load_library`.
    listed |= {f"{home}.{name}" for name, home in smd._HOME.items()}
    used = set().union(*map(names_used, snippets()))
    assert {"smd.parse", "laban.read_effort"} <= used
    assert not used - listed


def test_no_name_is_listed_twice(make_api):
    rows = re.findall(r"^\| `([\w.]+)` \|", make_api.page(), re.M)
    assert len(rows) == len(set(rows))


def test_a_docstring_is_found_where_the_name_is_defined(make_api):
    text = 'A = 1\n"""1"""\nB = 2\nclass C:\n    """3"""\ndef d():\n    """4"""\n"""5"""\n'
    found = [make_api.docstring(text, name) for name in "ABCde"]
    assert found == ["1", None, "3", "4", None]


def test_a_name_without_a_docstring_is_refused(make_api):
    with pytest.raises(LookupError, match=r"smd\.__version__: expected a docstring"):
        make_api.first_line("smd", "__version__")
