"""Each script in examples/ runs as a newcomer would run it, and does what it says."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SCRIPTS = sorted((ROOT / "examples").glob("*.py"))
MOST_LINES = 45

PRINTED = {
    "arrays_to_usd": r": walk",
    "edit_a_score": r"corrected: +sneak .* leap",
    "effort_of_any_body": r"0.3 s: time \+(.|\n)*1.6 s: time -",  # sudden, then sustained
    "own_character": r"hurrah: 2.00 s, in place",
    "poses_to_usd": r"4 steps of 0.80 m",
    "recording_to_usd": r"rival: bow, walk, side_step_left, turn_right, throw",
    "stream": r"did jump (.|\n)*did fly (.|\n)*did turn_right (.|\n)*did fly ",
    "teach_a_gesture": r"taken for zorro",
}
"""What a script is to find, where that is known; the stories are made by simulated people."""


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_an_example_runs_and_writes_what_it_says(script, tmp_path):
    text = script.read_text(encoding="utf-8")
    said = ast.get_docstring(ast.parse(text))
    assert said is not None and "rint" in said, "what does it print?"
    assert len(text.splitlines()) <= MOST_LINES
    done = subprocess.run(
        [sys.executable, script],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    assert re.search(PRINTED.get(script.stem, "."), done.stdout), done.stdout
    written = {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()}
    named = [Path(name) for name in re.findall(r"``(smd-examples/[^`]+?)/?``", said)]
    for name in named:
        assert name in written or any(name in path.parents for path in written), name
    for path in written:
        assert path in named or set(named) & set(path.parents), f"{path} is not said to be written"
        assert (tmp_path / path).stat().st_size > 0, path


def test_the_page_shows_every_example():
    page = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    shown = re.findall(r"^\| \[([a-z_]+\.py)\]", page, re.M)
    assert sorted(shown) == [script.name for script in SCRIPTS]
