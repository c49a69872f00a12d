"""What the dog does on the spot: looks, shakes itself, scratches, barks, yawns, gives a paw."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from actions_library.authoring.dog.standing import HOCKS_DOWN, SIT, STAND, in_place, tucked
from actions_library.authoring.feet import ALWAYS_S, OnBall, Plant, Via
from actions_library.authoring.gait import standing_plants
from actions_library.authoring.keys import LegKey, Place, Turn
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, on_both_sides, rekeyed
from actions_library.authoring.waves import Wave
from smd.character.clip import Clip


def look(rig: Rig) -> Clip:
    """Lift the head and look far to the left, then to the right; the ears go first."""
    end = 3.0
    keys = [
        STAND,
        on_both_sides(key(0.20, left_ear=Turn(lean=-4.0, tilt=18.0))),
        key(0.60, head=Turn(yaw=58.0, lean=-10.0), spine=Turn(yaw=9.0), tail=Turn(lean=26.0)),
        key(1.10, head=Turn(yaw=62.0, lean=-8.0, tilt=6.0), spine=Turn(yaw=9.0)),
        key(0.62, place=Place(left=0.010, up=-0.010)),
        key(1.75, head=Turn(yaw=-58.0, lean=-10.0), spine=Turn(yaw=-9.0), tail=Turn(lean=22.0)),
        key(1.80, place=Place(left=-0.010, up=-0.010)),
        on_both_sides(key(1.60, left_ear=Turn(lean=-4.0, tilt=18.0))),
        key(2.25, head=Turn(yaw=-62.0, lean=-8.0, tilt=-6.0), spine=Turn(yaw=-9.0)),
        rekeyed(end, STAND),
    ]
    return in_place(rig, "look", keys, standing_plants(rig), (0.2, 0.6, 2.25, 2.6, end))


def shake(rig: Rig) -> Clip:
    """Shake from head to tail, as wet dogs do: about 4.5 times a second [1]_.

    References
    ----------
    .. [1] A. K. Dickerson, Z. G. Mills, D. L. Hu, "Wet mammals shake at tuned frequencies to dry",
       J. R. Soc. Interface 9, 2012: 4.5 Hz for large dogs.
    """
    end, times = 2.0, 9
    keys = [
        STAND,
        key(0.25, place=Place(up=-0.045), head=Turn(lean=22.0), tail=Turn(lean=0.0)),
        key(1.45, place=Place(up=-0.050), head=Turn(lean=18.0), tail=Turn(lean=0.0)),
        rekeyed(end, STAND),
    ]
    waves = [
        Wave("head", "tilt", 12.0, tip=30.0, wavelength=4.0, per_cycle=times),
        Wave("spine", "tilt", 2.5, tip=4.5, wavelength=-3.0, phase=-0.1, per_cycle=times),
        Wave("left_ear", "tilt", 38.0, tip=30.0, wavelength=3.0, phase=-0.2, per_cycle=times),
        Wave("right_ear", "tilt", 38.0, tip=30.0, wavelength=3.0, phase=-0.2, per_cycle=times),
        Wave("tail", "yaw", 6.0, tip=16.0, wavelength=1.5, phase=-0.3, per_cycle=times),
    ]
    return in_place(rig, "shake", keys, standing_plants(rig), (0.1, 0.25, 1.6, 1.8, end), waves)


def bark(rig: Rig) -> Clip:
    """Bark twice: the jaw opens as the head is thrown up, and the body jerks ahead."""
    end = 1.8
    keys = [STAND, on_both_sides(key(0.15, left_ear=Turn(lean=-4.0, tilt=14.0)))]
    for start in (0.30, 0.85):
        keys += [
            key(start, place=Place(up=-0.012, ahead=-0.012), head=Turn(lean=10.0)),
            key(start, jaw=Turn(), spine=Turn(lean=3.0), tail=Turn(lean=14.0)),
            key(start + 0.11, jaw=Turn(lean=30.0), spine=Turn(lean=-4.0)),
            key(start + 0.12, place=Place(up=-0.006, ahead=0.014), head=Turn(lean=-14.0)),
            on_both_sides(key(start + 0.16, left_ear=Turn(lean=16.0, tilt=4.0))),
            key(start + 0.17, jaw=Turn(lean=26.0), tail=Turn(lean=24.0)),
            key(start + 0.26, jaw=Turn(), head=Turn(lean=-2.0)),
            on_both_sides(key(start + 0.34, left_ear=Turn(lean=-4.0, tilt=12.0))),
        ]
    keys += [key(1.3, jaw=Turn()), rekeyed(end, STAND)]
    return in_place(rig, "bark", keys, standing_plants(rig), (0.15, 0.3, 1.11, 1.3, end))


def yawn(rig: Rig) -> Clip:
    """Yawn: the head goes back, the jaw opens wide and stays so, then snaps shut; ears back."""
    end = 2.8
    back = on_both_sides(key(1.2, left_ear=Turn(lean=26.0, tilt=-4.0)))
    keys = [
        STAND,
        key(0.35, jaw=Turn(), head=Turn(lean=8.0)),
        key(1.10, jaw=Turn(lean=42.0), head=Turn(lean=-26.0), spine=Turn(lean=-3.0)),
        key(1.60, jaw=Turn(lean=46.0), head=Turn(lean=-30.0, tilt=5.0), tail=Turn(lean=-6.0)),
        key(1.12, place=Place(up=-0.016, ahead=-0.014)),
        back,
        rekeyed(1.7, back),
        key(2.0, jaw=Turn(lean=2.0), head=Turn(lean=4.0), spine=Turn(lean=1.0)),
        key(2.12, jaw=Turn()),
        rekeyed(end, STAND),
    ]
    return in_place(rig, "yawn", keys, standing_plants(rig), (0.2, 0.35, 1.6, 2.0, end))


def bow(rig: Rig) -> Clip:
    """Bow to play: elbows down, the rump up, the tail wagging."""
    end = 2.4
    low = on_both_sides(
        key(
            0.80,
            place=Place(up=-0.130, ahead=-0.115),
            body=Turn(lean=27.0),
            spine=Turn(lean=-8.0),
            head=Turn(lean=-4.0),
            tail=Turn(lean=44.0),
            left_ear=Turn(lean=-8.0, tilt=16.0),
        )
    )
    keys = [
        STAND,
        key(0.20, place=Place(up=-0.004, ahead=0.008), head=Turn(lean=4.0)),
        low,
        key(1.1, head=Turn(yaw=7.0, lean=-10.0)),
        rekeyed(1.55, low),
        rekeyed(end, STAND),
    ]
    wags = [Wave("tail", "yaw", 4.0, tip=10.0, wavelength=2.0, per_cycle=10)]
    return in_place(rig, "bow", keys, standing_plants(rig), (0.2, 0.35, 0.8, 1.55, end), wags)


def wave(rig: Rig) -> Clip:
    """Raise the left fore paw beside the face and wave it."""
    end = 3.0
    raised = LegKey(to=(0.14, -0.62, 0.80), bend=78.0, knee=(0.1, -1.0, -0.4), point=18.0)
    lifted = replace(raised, to=(0.10, -0.75, 0.65), bend=100.0, point=50.0)
    up = replace(raised, to=(0.16, -0.26, 0.95), bend=70.0, point=-22.0)
    leans = key(
        0.5,
        place=Place(left=-0.022, up=-0.020, ahead=-0.014),
        body=Turn(lean=-3.0, tilt=2.0),
        head=Turn(lean=-6.0, tilt=6.0),
    )
    strokes = [
        key(0.95 + 0.2 * k, left_fore=raised if k % 2 else up, head=Turn(lean=-6.0, tilt=tilt))
        for k, tilt in enumerate((6.0, 9.0, 6.0, 9.0, 6.0, 9.0))
    ]
    keys = [
        STAND,
        key(0.15, place=Place(left=-0.012, up=-0.010), head=Turn(lean=2.0)),
        leans,
        on_both_sides(key(0.5, left_ear=Turn(lean=-4.0, tilt=12.0))),
        key(0.36, left_fore=lifted),
        *strokes,
        rekeyed(2.15, leans),
        on_both_sides(key(2.1, left_ear=Turn(lean=-4.0, tilt=12.0))),
        key(2.30, left_fore=lifted),
        rekeyed(end, STAND),
    ]
    plants = standing_plants(rig)
    (stand,) = plants["left_fore"]
    plants["left_fore"] = [
        replace(stand, leave=0.34, leave_pitch=40.0),
        replace(stand, land=2.55, land_pitch=-10.0, swing=None),
    ]
    wags = [Wave("tail", "yaw", 3.0, tip=8.0, wavelength=2.0, per_cycle=9)]
    return in_place(rig, "wave", keys, plants, (0.15, 0.5, 1.95, 2.15, end), wags)


def scratch(rig: Rig) -> Clip:
    """Sit, scratch the neck with a hind paw, the head bent to it, and get up."""
    end, sat, first, times = 4.7, 1.05, 1.62, 6
    keys = [
        STAND,
        rekeyed(0.15, STAND),
        key(0.45, place=Place(up=-0.03), head=Turn(lean=10.0), tail=Turn(lean=22.0)),
        rekeyed(sat, SIT),
        *_bent_to_the_paw(first - 0.05),
        *_bent_to_the_paw(first + 0.22 * times),
        *_strokes(first, times),
        rekeyed(3.42, SIT),
        key(3.55, head=Turn(lean=12.0)),
        rekeyed(4.27, STAND),
        rekeyed(end, STAND),
    ]
    plants = standing_plants(rig)
    (stand,) = plants["right_hind"]
    down = (OnBall(0.50, 0.0), OnBall(sat, HOCKS_DOWN), OnBall(3.42, HOCKS_DOWN), OnBall(3.90, 0.0))
    plants["right_hind"] = [
        replace(stand, leave=0.25, leave_pitch=20.0),
        tucked(stand, 0.47, 3.95, down),
        replace(stand, land=4.17, swing=(Via(0.5, 0.04),)),
    ]
    plants["left_hind"] = _scratching(plants["left_hind"][0], sat)
    return in_place(rig, "scratch", keys, plants, (0.15, sat, 2.95, 3.42, end))


def _bent_to_the_paw(time: float) -> Iterator[RigKey]:
    yield key(
        time,
        place=Place(left=-0.030, up=-0.150, ahead=-0.015),
        body=Turn(lean=-44.0, tilt=7.0),
        spine=Turn(yaw=22.0, lean=16.0, tilt=-6.0),
        head=Turn(yaw=40.0, lean=20.0, tilt=-34.0),
        tail=Turn(lean=50.0, yaw=-12.0),
    )
    yield key(time, left_ear=Turn(lean=10.0, tilt=20.0), right_ear=Turn(lean=-4.0, tilt=10.0))


def _strokes(first: float, times: int) -> Iterator[RigKey]:
    """Yield keys of a hind leg that scratches, and of the ear that is in its way."""
    near = LegKey(to=(0.42, 0.30, 0.95), bend=70.0, knee=(0.5, 0.8, -0.3), point=8.0)
    far = replace(near, to=(0.46, 0.05, 0.95), bend=84.0, point=-14.0)
    under = LegKey(to=(0.70, -0.50, 0.35), bend=140.0, knee=(-0.15, 0.3, 1.0), point=-20.0)
    yield key(first - 0.22, left_hind=under)
    yield key(first + 0.22 * times + 0.24, left_hind=under)
    for k in range(2 * times + 1):
        time = first + 0.11 * k
        yield key(time, left_hind=far if k % 2 else near)
        yield key(time + 0.03, left_ear=Turn(lean=10.0, tilt=12.0 if k % 2 else 30.0))


def _scratching(stand: Plant, sat: float) -> list[Plant]:
    """Return the stands of the paw that scratches: tucked under, in the air, tucked, standing."""
    under = (OnBall(0.70, 0.0), OnBall(sat, HOCKS_DOWN), OnBall(sat + 0.25, HOCKS_DOWN + 25.0))
    again = (OnBall(3.40, HOCKS_DOWN), OnBall(3.68, 0.0))
    return [
        replace(stand, leave=0.45, leave_pitch=20.0),
        tucked(stand, 0.67, sat + 0.25, under),
        replace(tucked(stand, 3.32, 3.72, again), swing=None),
        replace(stand, land=3.94, leave=ALWAYS_S, swing=(Via(0.5, 0.04),)),
    ]
