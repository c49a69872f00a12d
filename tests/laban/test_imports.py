"""laban is a ground floor: it knows nothing of smd, and loading a model is light."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import pytest

import laban

MODULES = sorted(Path(laban.__file__).parent.glob("*.py"))


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_laban_needs_numpy_and_nothing_else(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    names = {
        name.split(".")[0]
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in (
            [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else [alias.name for alias in node.names]
        )
    }
    assert names <= {"laban", "numpy"} | set(sys.stdlib_module_names)
