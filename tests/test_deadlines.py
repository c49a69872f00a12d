"""No test waits for ever: whoever waits for a process or a thread says for how long."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
OF_SUBPROCESS = ("run", "call", "check_call", "check_output")


def names_in(node: ast.AST) -> list[ast.Attribute | ast.Name]:
    return [n for n in ast.walk(node) if isinstance(n, ast.Attribute | ast.Name)]


def endless_waits(text: str) -> list[int]:
    """Lines that wait for a process or a thread, or sleep in a loop, without a deadline."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.While):
            names = {n.attr if isinstance(n, ast.Attribute) else n.id for n in names_in(node)}
            if "sleep" in names and not {"monotonic", "deadline"} <= names:
                found.append(node.lineno)
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
            continue
        name, of = node.func.attr, node.func.value
        if name in OF_SUBPROCESS:
            waits = isinstance(of, ast.Name) and of.id == "subprocess"
        else:  # a thread's join and a queue's get have no argument, a string's and a dict's have
            waits = name in ("communicate", "wait", "join", "get") and not node.args
        if waits and "timeout" not in {keyword.arg for keyword in node.keywords}:
            found.append(node.lineno)
    return found


@pytest.mark.parametrize("path", sorted(TESTS.rglob("*.py")), ids=lambda p: p.stem)
def test_every_wait_has_a_deadline(path):
    assert not endless_waits(path.read_text(encoding="utf-8")), path


def test_waits_are_found():
    endless = 'subprocess.run(["a"])\nprocess.communicate()\nprocess.wait()\nthread.join()\n'
    assert endless_waits(endless) == [1, 2, 3, 4]
    assert endless_waits("while not done():\n    time.sleep(0.1)\n") == [1]
    ending = 'subprocess.run(["a"], timeout=1)\nprocess.wait(timeout=2)\n", ".join(words)\nd.get(1)'
    assert not endless_waits(ending)
