"""laban is a ground floor: it knows nothing of smd, and loading a model is light."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import laban

MODULES = sorted(Path(laban.__file__).parent.glob("*.py"))


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_laban_needs_numpy_and_to_fit_scikit_learn(path):
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
    fitting = {"sklearn", "threadpoolctl"} if path.stem == "linear" else set()
    assert names <= {"laban", "numpy"} | fitting | set(sys.stdlib_module_names)


def test_reading_does_not_load_what_fits():
    code = (
        "import sys; from laban import load_effort_model; load_effort_model(); print(*sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert "laban.linear" in done.stdout
    assert "sklearn" not in done.stdout


def test_importing_laban_loads_no_numpy_and_every_public_name_is_there():
    code = "import sys, laban; print(*sys.modules); print(*map(laban.__getattr__, laban.__all__))"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert "numpy" not in done.stdout.splitlines()[0].split()
