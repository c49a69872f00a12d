"""Which devices are recorded, and what is said where that is not clear."""

from __future__ import annotations

import pytest

from smd.capture.selection import chosen_devices, require_trigger
from smd.capture.source import Device
from smd.errors import CaptureError

ROOM = (
    Device("HMD-1", "headset"),
    Device("LHR-1", "controller", "left"),
    Device("LHR-2", "controller", "right"),
    Device("TRK-1", "tracker"),
    Device("LHR-3", "controller", tracking="away"),
)


def names(*asked: str) -> list[str]:
    return [device.name for device in chosen_devices(ROOM, asked)]


def test_all_that_is_played_with_is_recorded_unless_some_are_named():
    assert names() == ["left", "right", "TRK-1"]
    assert names("LHR-2") == names("right") == names("Right") == ["right"]
    assert names("tracker", "left", "LHR-1") == ["TRK-1", "left"]
    assert names("headset") == ["headset"]
    assert names("LHR-3") == ["LHR-3"]  # whoever names it means it


@pytest.mark.parametrize(
    ("devices", "asked", "said"),
    [
        ((), (), "expected a controller or a tracker, found none"),
        (ROOM[:1], (), r"found HMD-1 \(headset\): switch one on"),
        (ROOM, ("LHR-9",), r"'LHR-9', found .*LHR-1 \(left controller\).*--device"),
        (ROOM, ("controller",), "found 3: name one with --device LHR-1 or LHR-2 or LHR-3"),
        ((ROOM[1], Device("LHR-7", "controller", "left")), (), "role 'left', found 2"),
        ((ROOM[1], Device("LHR-7", "controller", "left")), ("left",), "LHR-1 or LHR-7"),
    ],
)
def test_what_is_not_clear_is_told_with_the_next_step(devices, asked, said):
    with pytest.raises(CaptureError, match=said):
        chosen_devices(devices, asked)


def test_a_tracker_alone_has_no_trigger():
    require_trigger(ROOM)
    with pytest.raises(CaptureError, match="expected a controller"):
        require_trigger([ROOM[0], ROOM[3], ROOM[4]])
