"""Poses from OpenVR [1]_: SteamVR, or whatever runtime the path registry names.

We are a background application: we neither draw in the headset nor start the runtime. Poses are
those of the standing universe: metres, right-handed, Y up, the floor at 0; a device faces its own
-Z and has its right at +X, so that each is turned half round its Y to become ours.

The work of every frame is plain Python: with arrays of three rows, recording costs three times as
much.

References
----------
.. [1] https://github.com/ValveSoftware/openvr/wiki/API-Documentation
.. [2] S. W. Shepperd, "Quaternion from Rotation Matrix", Journal of Guidance and Control 1 (3),
   1978.
"""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from smd.capture.source import Device, Frame, Kind, Pose, Sample, Tracking
from smd.errors import CaptureError

if TYPE_CHECKING:
    import openvr

_POSE = np.dtype(  # TrackedDevicePose_t of openvr.h
    {
        "names": ["matrix", "result", "valid", "connected"],
        "formats": [("<f4", 12), "<i4", "?", "?"],
        "offsets": [0, 72, 76, 77],
        "itemsize": 80,
    }
)

MOST_DOUBT_S = 0.5e-3
"""Uncertainty of a pose's time, unless the system is busy for longer than three tries."""

_TRIES = 3

TICK_US = 3000
"""Length of a haptic tick: short, and felt."""

_NEXT_STEP = {
    100: "install SteamVR, start it, and try again",
    108: "connect the headset (or set up SteamVR without one), and try again",
    110: "install SteamVR, start it once, and try again",
    121: "start SteamVR, switch on the controllers, and try again",
}
"""What to do about the initialisation errors that a user can correct, by number."""


class OpenVRSource:
    """The devices of the OpenVR runtime that is running.

    Parameters
    ----------
    rate_hz
        Frames per second.

    Raises
    ------
    CaptureError
        If no runtime is installed or running, or it refuses; it says what to do next.
    """

    def __init__(self, rate_hz: float) -> None:
        self._vr = _openvr()
        self._system = _system(self._vr)
        self._period_s = 1.0 / rate_hz
        self._buffer = (self._vr.TrackedDevicePose_t * self._vr.k_unMaxTrackedDeviceCount)()
        self._poses = np.frombuffer(self._buffer, _POSE)  # a view: it changes with the buffer
        self._event = self._vr.VREvent_t()
        self._connected = b""
        self._serials: dict[int, str] = {}
        self._with_trigger: frozenset[int] = frozenset()

    def devices(self) -> tuple[Device, ...]:
        """Return headset, controllers and trackers, those that were switched off included."""
        self._ask()
        return tuple(
            Device(
                serial=self._serials[index],
                kind=kind,
                role=self._role(index) if kind == "controller" else "",
                model=self._text(index, self._vr.Prop_ModelNumber_String),
                battery=self._battery(index),
                tracking=self._tracking(index),
            )
            for index, kind in self._kinds()
        )

    def poses(self) -> Iterator[Frame]:
        """Yield a frame each period; the time of a late frame says that it is late.

        Raises
        ------
        CaptureError
            If the runtime quits.
        """
        start_s = time.perf_counter()
        periods = 0
        while True:
            yield self._frame()
            self._watch()
            passed_s = time.perf_counter() - start_s
            periods = max(periods + 1, int(passed_s / self._period_s))
            time.sleep(max(start_s + periods * self._period_s - time.perf_counter(), 0.0))

    def tick(self, serial: str) -> None:
        """Give a short haptic pulse on a controller."""
        for index, known in self._serials.items():
            if known == serial:
                self._system.triggerHapticPulse(index, 0, TICK_US)

    def close(self) -> None:
        """Leave the runtime."""
        self._vr.shutdown()

    def _ask(self) -> float:
        """Bring poses and the list of devices up to date; return the time of the poses.

        The poses are of a moment between two readings of the clock. If the operating system
        scheduled other work in between, the moment is uncertain, and the query is repeated. The
        earlier reading is the better one: on return another thread of ours may run first.
        """
        standing = self._vr.TrackingUniverseStanding
        for _ in range(_TRIES):
            now_s = time.perf_counter()
            self._system.getDeviceToAbsoluteTrackingPose(standing, 0.0, self._buffer)
            if time.perf_counter() - now_s < MOST_DOUBT_S:
                break
        connected = self._poses["connected"].tobytes()
        if connected != self._connected:
            self._connected = connected
            kinds = dict(self._kinds())
            self._serials = {index: self._serial(index) for index in kinds}
            self._with_trigger = frozenset(i for i, kind in kinds.items() if kind == "controller")
        return now_s

    def _frame(self) -> Frame:
        """Return what all devices report now."""
        time_s = self._ask()
        ok = self._vr.TrackingResult_Running_OK
        seen = self._poses["valid"] & (self._poses["result"] == ok)
        return Frame(
            time_s,
            tuple(
                Sample(
                    serial,
                    pose_of(self._poses["matrix"][index].tolist()) if seen[index] else None,
                    *(self._buttons(index) if index in self._with_trigger else ()),
                )
                for index, serial in self._serials.items()
            ),
        )

    def _buttons(self, index: int) -> tuple[bool, bool]:
        """Return whether trigger and grip are pressed."""
        known, state = self._system.getControllerState(index)
        pressed = state.ulButtonPressed if known else 0
        return (
            bool(pressed >> self._vr.k_EButton_SteamVR_Trigger & 1),
            bool(pressed >> self._vr.k_EButton_Grip & 1),
        )

    def _watch(self) -> None:
        """Empty the queue of events, and raise CaptureError if the runtime quits."""
        while self._system.pollNextEvent(self._event):
            if self._event.eventType == self._vr.VREvent_Quit:
                self._system.acknowledgeQuit_Exiting()
                raise CaptureError("SteamVR has quit; start it, and record again")

    def _kinds(self) -> Iterator[tuple[int, Kind]]:
        """Yield index and kind of each device that can play."""
        kinds: dict[int, Kind] = {
            self._vr.TrackedDeviceClass_HMD: "headset",
            self._vr.TrackedDeviceClass_Controller: "controller",
            self._vr.TrackedDeviceClass_GenericTracker: "tracker",
        }
        for index in range(self._vr.k_unMaxTrackedDeviceCount):
            kind = kinds.get(int(self._system.getTrackedDeviceClass(index)))
            if kind:
                yield index, kind

    def _role(self, index: int) -> str:
        """Return the hand that a controller is in."""
        hands = {
            self._vr.TrackedControllerRole_LeftHand: "left",
            self._vr.TrackedControllerRole_RightHand: "right",
        }
        return hands.get(int(self._system.getControllerRoleForTrackedDeviceIndex(index)), "")

    def _serial(self, index: int) -> str:
        """Return a serial, or what to call a device that has none."""
        return self._text(index, self._vr.Prop_SerialNumber_String) or f"device-{index}"

    def _text(self, index: int, what: int) -> str:
        """Return a property, or nothing where the device does not say."""
        try:
            return str(self._system.getStringTrackedDeviceProperty(index, what))
        except self._vr.OpenVRError:
            return ""

    def _battery(self, index: int) -> float | None:
        """Return the charge, or None where the device does not say."""
        what = self._vr.Prop_DeviceBatteryPercentage_Float
        try:
            return round(float(self._system.getFloatTrackedDeviceProperty(index, what)), 3)
        except self._vr.OpenVRError:
            return None

    def _tracking(self, index: int) -> Tracking:
        """Return a device's tracking state in the last poses."""
        pose = self._buffer[index]
        if not pose.bDeviceIsConnected:
            return "away"
        ok = pose.eTrackingResult == self._vr.TrackingResult_Running_OK
        return "tracked" if pose.bPoseIsValid and ok else "lost"


def pose_of(matrix: Sequence[float]) -> Pose:
    """Return our pose of an OpenVR matrix: three rows of four, world from device.

    Of the four ways to a quaternion that with the largest divisor is taken [2]_.
    """
    a, b, c, x, d, e, f, y, g, h, i, z = matrix
    trace = a + e + i
    largest = max(trace, a, e, i)
    if largest == trace:
        qx, qy, qz, qw = h - f, c - g, d - b, 1.0 + trace
    elif largest == a:
        qx, qy, qz, qw = 1.0 + a - e - i, b + d, c + g, h - f
    elif largest == e:
        qx, qy, qz, qw = b + d, 1.0 - a + e - i, f + h, c - g
    else:
        qx, qy, qz, qw = c + g, f + h, 1.0 - a - e + i, d - b
    length = math.hypot(qx, qy, qz, qw)
    # times (0, 1, 0, 0), the half turn about Y
    return x, y, z, -qz / length, qw / length, qx / length, -qy / length


def _openvr() -> Any:
    """Return the openvr package, or raise CaptureError where it cannot be loaded."""
    try:
        import openvr
    except (ImportError, OSError) as error:
        raise CaptureError(
            f"the openvr package cannot be loaded ({error}): run `pip install openvr`"
        ) from error
    return openvr


def _system(vr: Any) -> openvr.IVRSystem:
    """Return the running runtime, or raise CaptureError that says what to do."""
    with _hushed():
        installed = vr.isRuntimeInstalled()
    if not installed:
        raise CaptureError(f"no OpenVR runtime is installed: {_NEXT_STEP[100]}")
    try:
        with _hushed():
            return vr.init(vr.VRApplication_Background)
    except vr.OpenVRError as error:
        number = getattr(error, "error_value", None)
        said = vr.getVRInitErrorAsEnglishDescription(number) if number else str(error)
        step = _NEXT_STEP.get(number or 0, "restart SteamVR, and try again")
        raise CaptureError(f"the OpenVR runtime refuses ({said}): {step}") from error


@contextmanager
def _hushed() -> Iterator[None]:
    """Keep the loader's own prints, past Python, out of our output: errors are one line."""
    sys.stdout.flush()
    kept = [(fd, os.dup(fd)) for fd in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for fd, _ in kept:
            os.dup2(nowhere, fd)
        yield
    finally:
        for fd, copy in kept:
            os.dup2(copy, fd)
            os.close(copy)
        os.close(nowhere)
