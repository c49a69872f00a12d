"""Work in a process of its own: in order, and nothing of it is lost silently."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from smd.capture.beside import Beside
from smd.errors import CaptureError


@dataclass(frozen=True)
class Notes:
    """Writes what it is given to a file."""

    path: Path

    def begun(self) -> Notes:
        self.path.write_text("begun\n", encoding="utf-8")
        return self

    def write(self, line: str) -> None:
        with self.path.open("a", encoding="utf-8") as file:
            file.write(f"{line}\n")

    def fail(self, message: str) -> None:
        raise CaptureError(message)

    def die(self) -> None:
        os._exit(7)

    def where(self) -> None:
        self.write(str(os.getpid()))


def lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines()


def test_jobs_are_done_in_order_all_of_them_and_elsewhere(tmp_path):
    notes = Notes(tmp_path / "notes.txt")
    with Beside(notes.begun) as beside:
        for i in range(2000):  # more than a pipe holds
            beside.do("write", f"{i} {'x' * 100}")
        beside.do("where")
    *written, process = lines(notes.path)
    assert [line.split()[0] for line in written] == ["begun", *map(str, range(2000))]
    assert int(process) != os.getpid()


def test_what_fails_is_raised_here_and_what_follows_is_passed_over(tmp_path):
    notes = Notes(tmp_path / "notes.txt")
    with pytest.raises(CaptureError, match=r"^no paper left$"), Beside(notes.begun) as beside:
        beside.do("write", "before")
        beside.do("fail", "no paper left")
        for _ in range(5000):
            beside.do("write", "after")
    assert lines(notes.path) == ["begun", "before"]


def test_what_cannot_begin_is_told_before_anything_is_given(tmp_path):
    notes = Notes(tmp_path / "missing" / "notes.txt")
    with pytest.raises(FileNotFoundError), Beside(notes.begun):
        pytest.fail("it has not begun")


def test_a_process_that_dies_is_said(tmp_path):
    notes = Notes(tmp_path / "notes.txt")
    with (
        pytest.raises(CaptureError, match=r"has stopped \(exit code 7\); what was recorded is"),
        Beside(notes.begun) as beside,
    ):
        beside.do("die")


def test_an_error_here_is_not_hidden_by_one_over_there(tmp_path):
    notes = Notes(tmp_path / "notes.txt")
    with pytest.raises(ZeroDivisionError), Beside(notes.begun) as beside:
        beside.do("fail", "over there")
        raise ZeroDivisionError


PARENT = """
import os, signal, sys
from pathlib import Path
from smd.capture.beside import Beside
from tests.smd.capture.test_beside import Notes

if __name__ == "__main__":
    # What is started in the background of a shell ignores Ctrl-C; a terminal's program does not.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with Beside(Notes(Path(sys.argv[1])).begun) as beside:
        beside.do("where")
        beside.do("write", "given")
        try:
            print("given", flush=True)
            sys.stdin.read()
        except KeyboardInterrupt:
            beside.do("write", "after Ctrl-C")
"""


@pytest.fixture
def parent(tmp_path):
    """Start a program that has work done beside; return it and the file of that work."""
    script = tmp_path / "parent.py"
    script.write_text(PARENT, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen(
        [sys.executable, script, tmp_path / "notes.txt"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=environment,
        start_new_session=True,
    )
    assert process.stdout.readline() == "given\n"
    yield process, tmp_path / "notes.txt"
    process.kill()
    process.communicate(timeout=20)


posix = pytest.mark.skipif(os.name != "posix", reason="signals of a terminal's process group")


@posix
def test_ctrl_c_ends_this_process_and_the_other_does_what_it_was_given(parent):
    process, notes = parent
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(timeout=20) == 0
    assert [line for line in lines(notes) if not line.isdigit()] == [
        "begun",
        "given",
        "after Ctrl-C",
    ]


@posix
def test_a_parent_that_is_killed_leaves_no_orphan(parent):
    process, notes = parent
    deadline = time.monotonic() + 20.0
    while len(lines(notes)) < 3:
        assert time.monotonic() < deadline
        time.sleep(0.01)
    (child,) = (int(line) for line in lines(notes) if line.isdigit())
    process.kill()
    process.wait(timeout=20)
    deadline = time.monotonic() + 20.0
    while _is_running(child):
        assert time.monotonic() < deadline
        time.sleep(0.01)


def _is_running(pid: int) -> bool:
    """Return whether a process runs; one that has ended may wait for somebody to notice."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    state = Path(f"/proc/{pid}/stat")
    return not state.exists() or state.read_text().rpartition(")")[2].split()[0] != "Z"
