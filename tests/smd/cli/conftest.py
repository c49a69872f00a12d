from __future__ import annotations

from pathlib import Path

import pytest

from smd.cli.app import main


@pytest.fixture
def run_smd(capsys):
    """Run the command line in this process; return its exit code, output and error output."""

    def run(*arguments: object) -> tuple[int, str, str]:
        capsys.readouterr()
        with pytest.raises(SystemExit) as exit_:
            main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return int(exit_.value.code or 0), out, err

    return run


@pytest.fixture(scope="session")
def stories() -> Path:
    return Path(__file__).parents[3] / "recordings"
