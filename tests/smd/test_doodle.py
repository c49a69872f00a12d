from __future__ import annotations

from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.testing import assert_allclose, assert_array_equal

from smd.doodle import Doodle, Dropout, Recording
from smd.errors import DoodleError

IDENTITY = [0.0, 0.0, 0.0, 1.0]


def doodle(start_s: float, n: int = 3, device: str = "prop") -> Doodle:
    t = start_s + np.arange(n) / 60.0
    return Doodle(t, np.zeros((n, 3)), np.tile(IDENTITY, (n, 1)), device)


@st.composite
def arrays(draw):
    """Times, positions and quaternions that make a doodle."""
    n = draw(st.integers(1, 20))
    steps = draw(hnp.arrays(float, n, elements=st.floats(1e-3, 10.0)))
    position = draw(hnp.arrays(float, (n, 3), elements=st.floats(-1e6, 1e6)))
    q = draw(hnp.arrays(float, (n, 4), elements=st.floats(-1.0, 1.0)))
    length = np.linalg.norm(q, axis=1, keepdims=True)
    assume((length > 1e-3).all())
    return np.cumsum(steps), position, q / length


@settings(max_examples=50, deadline=None)
@given(arrays())
def test_a_doodle_holds_read_only_copies_and_the_same_rotations(given_arrays):
    time_s, position, q = given_arrays
    made = Doodle(time_s, position, q)
    assert_array_equal(made.time_s, time_s)
    assert_array_equal(made.position_m, position)
    assert_allclose(np.linalg.norm(made.orientation_xyzw, axis=1), 1.0, atol=1e-12)
    assert_allclose(np.abs(np.sum(made.orientation_xyzw * q, axis=1)), 1.0, atol=1e-9)
    assert (np.sum(made.orientation_xyzw[1:] * made.orientation_xyzw[:-1], axis=1) >= 0).all()
    drawn = Doodle(time_s, position, q, drawing=np.ones(len(time_s), bool))
    for array in (made.time_s, made.position_m, made.orientation_xyzw, drawn.drawing):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(FrozenInstanceError):
        made.device = "other"


def test_a_doodle_does_not_change_when_its_input_does():
    position = np.zeros((3, 3))
    made = Doodle([0.0, 0.1, 0.2], position, np.tile(IDENTITY, (3, 1)))
    position[:] = 7.0
    assert not made.position_m.any()


def test_nothing_is_said_of_drawing_unless_it_is():
    made = Doodle([0.0, 0.1], np.zeros((2, 3)), np.tile(IDENTITY, (2, 1)))
    assert made.drawing is None
    assert made.drawing_at(np.array([0.0, 0.05])) is None
    assert made.selected(np.array([1])).drawing is None


def test_what_a_sample_says_of_drawing_holds_until_the_next():
    mark = np.array([True, False, True])
    made = Doodle([0.0, 0.1, 0.2], np.zeros((3, 3)), np.tile(IDENTITY, (3, 1)), drawing=mark)
    at_s = np.array([-1.0, 0.0, 0.099, 0.1 - 1e-10, 0.1, 0.15, 0.2, 9.0])
    assert_array_equal(made.drawing_at(at_s), [True, True, True, False, False, False, True, True])


@pytest.mark.parametrize("rows", [np.array([0, 2]), np.array([True, False, True])])
def test_selected_samples_keep_all_that_is_said_of_them(rows):
    q = np.tile(IDENTITY, (3, 1))
    made = Doodle([0.0, 0.1, 0.2], np.eye(3), q, "left", np.array([True, True, False]))
    part = made.selected(rows)
    assert part.device == "left"
    assert_array_equal(part.time_s, [0.0, 0.2])
    assert_array_equal(part.position_m, np.eye(3)[[0, 2]])
    assert_array_equal(part.drawing, [True, False])


def test_length_and_duration_are_those_of_the_samples():
    made = doodle(5.0, n=7)
    assert len(made) == 7
    assert made.duration_s == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time_s": []}, "time_s: expected at least one sample, got none"),
        ({"time_s": [0.0, 0.0, 0.1]}, "time_s: expected increasing times, got 0 then 0"),
        ({"time_s": [0.0, 0.2, 0.1]}, "time_s: expected increasing times, got 0.2 then 0.1"),
        (
            {"time_s": [0.0, np.nan, 0.1]},
            "time_s: expected finite numbers, got nan at index (1,)",
        ),
        ({"position_m": np.zeros((3, 2))}, "position_m: expected shape (3, 3), got (3, 2)"),
        ({"position_m": np.zeros((2, 3))}, "position_m: expected shape (3, 3), got (2, 3)"),
        (
            {"position_m": [[0, 0, 0], [0, np.inf, 0], [0, 0, 0]]},
            "position_m: expected finite numbers, got inf at index (1, 1)",
        ),
        (
            {"orientation_xyzw": np.zeros((3, 4))},
            "orientation_xyzw: expected unit length, got 0",
        ),
        (
            {"orientation_xyzw": [IDENTITY, [0, 0, 0, 1.1], IDENTITY]},
            "orientation_xyzw: expected unit length, got 1.1",
        ),
        ({"drawing": [True]}, "drawing: expected shape (3), got (1,)"),
    ],
)
def test_what_is_no_doodle_is_refused(change, message):
    good = {
        "time_s": [0.0, 0.1, 0.2],
        "position_m": np.zeros((3, 3)),
        "orientation_xyzw": np.tile(IDENTITY, (3, 1)),
    }
    with pytest.raises(DoodleError) as caught:
        Doodle(**{**good, **change})
    assert str(caught.value) == message


def test_a_recording_lists_devices_as_they_appear_and_gives_each_its_doodles():
    lost = Dropout("b", 0.1, 1.0, "gap", False)
    recording = Recording(
        (doodle(0.0, device="b"), doodle(1.0, device="b"), doodle(0.0, device="a")),
        source="take.csv",
        dropouts=(lost,),
        metadata={"story": "two"},
    )
    assert recording.devices == ("b", "a")
    assert recording.of("b") == recording.doodles[:2]
    assert recording.of("c") == ()
    assert (recording.source, recording.dropouts) == ("take.csv", (lost,))
    with pytest.raises(TypeError):
        recording.metadata["story"] = "three"


@pytest.mark.parametrize(
    ("doodles", "message"),
    [
        ((), "recording: expected at least one doodle, got none"),
        (
            (doodle(0, device="a"), doodle(0, device="b"), doodle(1, device="a")),
            "recording: doodles of device 'a' are not together",
        ),
        ((doodle(1.0), doodle(0.0)), "recording: doodles of device 'prop' overlap in time"),
        ((doodle(0.0), doodle(0.02)), "recording: doodles of device 'prop' overlap in time"),
    ],
)
def test_what_is_no_recording_is_refused(doodles, message):
    with pytest.raises(DoodleError) as caught:
        Recording(doodles)
    assert str(caught.value) == message
