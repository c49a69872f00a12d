"""One word, one thing: no two classes have one name."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("laban", "smd", "actions_library", "exporters", "benchmarks")
MODULES = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]


def classes_of(text: str) -> list[str]:
    return [node.name for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ClassDef)]


def homes_by_class(modules: Iterable[Path]) -> dict[str, list[str]]:
    homes = defaultdict(list)
    for path in modules:
        for name in classes_of(path.read_text(encoding="utf-8")):
            homes[name].append(str(path.relative_to(ROOT)))
    return homes


def test_every_class_has_a_name_of_its_own():
    homes = homes_by_class(MODULES)
    shared = {name: where for name, where in homes.items() if len(where) > 1}
    assert not shared


def test_the_search_sees_classes_within_classes_and_functions():
    text = "class A:\n    class B: ...\ndef f():\n    class C: ...\n"
    assert sorted(classes_of(text)) == ["A", "B", "C"]
