from __future__ import annotations

import numpy as np
import pytest

from smd.cli.app import main
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take
from tests.standin import runtime
from tests.standin.runtime import Played, Scene


@pytest.fixture(scope="session")
def registry(tmp_path_factory):
    """Folder of the path registry that names the stand-in runtime."""
    if runtime.compiler() is None:
        pytest.skip("no C++ compiler to build the stand-in OpenVR runtime with, or not Linux")
    return runtime.build(tmp_path_factory.mktemp("standin"))


@pytest.fixture
def play_scene(registry, tmp_path, monkeypatch):
    """Make the stand-in play a scene to whoever asks for OpenVR."""

    def play(scene: Scene) -> dict[str, str]:
        variables = runtime.environment(registry, scene, tmp_path)
        for name, value in variables.items():
            monkeypatch.setenv(name, value)
        return variables

    return play


@pytest.fixture
def run_smd(capfd):
    """Run the command line; return its exit code, output and error output."""

    def run(*arguments: object) -> tuple[int, str, str]:
        capfd.readouterr()
        with pytest.raises(SystemExit) as exit_:
            main([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        return int(exit_.value.code or 0), out, err

    return run


def circling(time_s):
    """Position and orientation of a hand that circles, front along its way (a closed form)."""
    t = np.asarray(time_s, float)
    position = np.stack([np.sin(t), 1.0 + 0.1 * np.sin(3 * t), np.cos(t)], axis=-1)
    turn = 0.5 * (t + 0.5 * np.pi)
    zero = np.zeros_like(t)
    return position, np.stack([zero, np.sin(turn), zero, np.cos(turn)], axis=-1)


def hand(serial="LHR-1", kind=runtime.CONTROLLER, role=runtime.LEFT, seconds=2.0, **more) -> Played:
    time_s = np.arange(0.0, seconds, 4e-3)
    return Played(kind, role, serial, time_s, *circling(time_s), **more)


def played(*actions: str, seed: int = 3, pause_s: float = 0.7):
    """A doodle of a simulated person who plays some actions in a row."""
    rng = np.random.default_rng(seed)
    take = Take(simulated_person(rng), rng).pause(pause_s)
    for action in actions:
        take.play(action).pause(pause_s)
    return take.doodle()
