"""The dragon's body: a melted skin, a lighter belly, wings, horns, claws, a face."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from actions_library.authoring.body_field import Ellipsoid, RoundCone
from actions_library.authoring.displacement import LEAST_M, sided, swung, with_shapes
from actions_library.authoring.dragon.face import (
    BROW_IN,
    BROW_OUT,
    NOSTRIL,
    jaw_motion,
    skin_motions,
)
from actions_library.authoring.dragon.skeleton import EYE, NECK, TAIL, TAIL_TIP
from actions_library.authoring.dragon.wings import wing_bones, wing_claw, wing_skin
from actions_library.authoring.eyes import eye_meshes, lid_mesh, lids_moved
from actions_library.authoring.flesh import Lump, ball, bone, melted_mesh
from actions_library.authoring.rigging import Point
from actions_library.authoring.solids import (
    Solid,
    capsule,
    globe,
    on_both_sides_of,
    solid_mesh,
)
from smd.character.blend_shape import BlendShape
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

STEP_M = 0.005
"""Distance between nodes of the grid that the shape is sampled on."""

SKIN_TRIANGLES, BELLY_TRIANGLES = 11_000, 2_400
SKIN_RGB = (0.10, 0.36, 0.24)
LID_RGB = (0.07, 0.27, 0.17)
BELLY_RGB = (0.78, 0.62, 0.30)
WING_RGB = (0.80, 0.30, 0.10)
HORN_RGB = (0.80, 0.72, 0.55)
CREST_RGB = (0.75, 0.22, 0.08)
DARK_RGB = (0.07, 0.012, 0.015)
TONGUE_RGB = (0.55, 0.10, 0.12)
IRIS_RGB = (0.85, 0.45, 0.02)

CREST_DEG = -52.0
"""How far the crest rises."""


def dragon_character(skeleton: Skeleton, *, step_m: float = STEP_M) -> Character:
    """Return the dragon, standing with its wings spread and facing +Z.

    Parameters
    ----------
    skeleton
        That of `actions_library.authoring.dragon.skeleton.dragon_rig`.
    step_m
        Coarser is quicker and loses paws and nostrils.
    """
    motions = skin_motions()
    skin = melted_mesh(
        "skin",
        skeleton,
        [*_trunk(skeleton), *_neck(skeleton), *_head(), *_tail(skeleton), *_legs(skeleton)],
        step_m=step_m,
        triangle_count=SKIN_TRIANGLES,
        color_rgb=SKIN_RGB,
        hollows=[ball("head", (0.0235, 0.8520, 0.5700), 0.0085, reach_m=0.005), _socket()],
        magnified=_face_magnified,
    )
    jaw = melted_mesh(
        "jaw",
        skeleton,
        _jaw(),
        step_m=0.8 * step_m,
        triangle_count=1200,
        color_rgb=SKIN_RGB,
    )
    belly = melted_mesh(
        "belly",
        skeleton,
        _belly(skeleton),
        step_m=step_m,
        triangle_count=BELLY_TRIANGLES,
        color_rgb=BELLY_RGB,
    )
    lids = lid_mesh(EYE, skeleton, "head", LID_RGB)
    horns = solid_mesh("horns", skeleton, on_both_sides_of(_horns()), HORN_RGB)
    bones = solid_mesh("wing_bones", skeleton, on_both_sides_of(wing_bones()), SKIN_RGB)
    return Character(
        "dragon",
        skeleton,
        (
            with_shapes(skin, motions),
            with_shapes(belly, motions),
            with_shapes(jaw, {"jaw_open": jaw_motion()}),
            with_shapes(lids, sided({"blink": lids_moved(EYE, 1.04, 1.0)})),
            *eye_meshes(EYE, skeleton, "left_eye", IRIS_RGB),
            with_shapes(_brows(skeleton), motions),
            horns,
            *_mouth(skeleton),
            _crest(skeleton),
            bones,
            wing_skin(skeleton, WING_RGB),
        ),
    )


def _trunk(skeleton: Skeleton) -> list[Lump]:
    """A barrel of a chest, a round belly, a broad croup."""
    back: tuple[tuple[str, Point, Point, float, float], ...] = (
        ("chest", (0.0, 0.448, 0.085), (0.0, 0.460, 0.165), 0.118, 0.100),
        ("back", (0.0, 0.440, -0.010), (0.0, 0.446, 0.085), 0.116, 0.120),
        ("loin", (0.0, 0.442, -0.115), (0.0, 0.440, -0.010), 0.108, 0.114),
        ("pelvis", (0.0, 0.448, -0.235), (0.0, 0.444, -0.120), 0.092, 0.104),
    )
    return [
        bone(skeleton, joint, end, a, b, start=start, reach_m=0.06)
        for joint, start, end, a, b in back
    ]


def _neck(skeleton: Skeleton) -> list[Lump]:
    radius = (0.094, 0.074, 0.062, 0.056, 0.054)
    names = [*(f"neck_{k}" for k in range(1, 5)), "head"]
    return [
        bone(skeleton, names[k], names[k + 1], radius[k], radius[k + 1], reach_m=0.05)
        for k in range(4)
    ]


def _head() -> list[Lump]:
    """A round skull, a snout with nostrils, cheeks."""
    return [
        ball("head", (0.0, 0.845, 0.385), 0.074, reach_m=0.04),
        Lump("head", Ellipsoid((0.0, 0.826, 0.470), (0.056, 0.038, 0.070)), 0.030),
        Lump("head", Ellipsoid((0.0, 0.824, 0.530), (0.046, 0.029, 0.044)), 0.025),
        ball("head", NOSTRIL, 0.0175, reach_m=0.012),
        ball("head", (0.052, 0.812, 0.400), 0.036, reach_m=0.03),
        ball("head", (0.0, 0.872, 0.360), 0.055, reach_m=0.03),
        Lump("head", RoundCone(_below(BROW_IN), _below(BROW_OUT), 0.015, 0.012), 0.025),
    ]


def _below(brow: Point) -> Point:
    return brow[0], brow[1] - 0.008, brow[2] - 0.010


def _socket() -> Lump:
    return ball("head", EYE.centre, 1.07 * EYE.radius, reach_m=0.006)


def _jaw() -> list[Lump]:
    return [
        Lump("head", Ellipsoid((0.0, 0.793, 0.420), (0.050, 0.023, 0.052)), 0.02),
        Lump("head", Ellipsoid((0.0, 0.791, 0.486), (0.043, 0.018, 0.062)), 0.02),
        Lump("head", Ellipsoid((0.0, 0.792, 0.520), (0.036, 0.015, 0.044)), 0.02),
    ]


def _tail(skeleton: Skeleton) -> list[Lump]:
    radius = (0.078, 0.064, 0.054, 0.046, 0.038, 0.031, 0.025, 0.020, 0.013)
    lumps = [
        bone(skeleton, f"tail_{k}", f"tail_{k + 1}", radius[k - 1], radius[k], reach_m=0.04)
        for k in range(1, len(TAIL))
    ]
    return [*lumps, bone(skeleton, f"tail_{len(TAIL)}", TAIL_TIP, radius[-2], radius[-1])]


def _belly(skeleton: Skeleton) -> list[Lump]:
    """Light below and ahead: from the throat over the chest to the root of the tail."""
    lumps = []
    names = [*(f"neck_{k}" for k in range(1, 5)), "head"]
    places = [*NECK, (0.0, 0.795, 0.345)]
    radius = (0.074, 0.060, 0.049, 0.044, 0.042)
    for k in range(4):
        (_, ya, za), (_, yb, zb) = places[k], places[k + 1]
        start, end = (0.0, ya - 0.014, za + 0.024), (0.0, yb - 0.008, zb + 0.018)
        lumps.append(bone(skeleton, names[k], end, radius[k], radius[k + 1], start=start))
    trunk: tuple[tuple[str, Point, Point, float, float], ...] = (
        ("chest", (0.0, 0.424, 0.085), (0.0, 0.440, 0.185), 0.100, 0.086),
        ("back", (0.0, 0.416, -0.010), (0.0, 0.422, 0.085), 0.098, 0.102),
        ("loin", (0.0, 0.418, -0.115), (0.0, 0.416, -0.010), 0.090, 0.096),
        ("pelvis", (0.0, 0.428, -0.240), (0.0, 0.420, -0.120), 0.076, 0.086),
    )
    lumps += [bone(skeleton, j, end, a, b, start=start) for j, start, end, a, b in trunk]
    below = [(0.0, y - 0.014, z) for _, y, z in TAIL]
    width = (0.066, 0.054, 0.045, 0.037, 0.029, 0.022)
    lumps += [
        bone(skeleton, f"tail_{k + 1}", below[k + 1], width[k], width[k + 1], start=below[k])
        for k in range(5)
    ]
    return lumps


def _legs(skeleton: Skeleton) -> list[Lump]:
    return [
        bone(skeleton, "left_hip", "left_knee", 0.078, 0.052, reach_m=0.05),
        bone(skeleton, "left_knee", "left_hock", 0.050, 0.028, reach_m=0.03),
        bone(skeleton, "left_hock", "left_hind_toes", 0.028, 0.027, reach_m=0.015),
        *_paw("left_hind_toes", 0.102, -0.242),
        bone(
            skeleton,
            "left_shoulder_blade",
            "left_shoulder",
            0.040,
            0.058,
            start=(0.052, 0.480, 0.130),
            reach_m=0.05,
        ),
        bone(skeleton, "left_shoulder", "left_elbow", 0.058, 0.044, reach_m=0.04),
        bone(skeleton, "left_elbow", "left_wrist", 0.041, 0.029, reach_m=0.025),
        bone(skeleton, "left_wrist", "left_fore_toes", 0.029, 0.027, reach_m=0.015),
        *_paw("left_fore_toes", 0.100, 0.166),
    ]


def _paw(joint: str, left: float, ahead: float) -> list[Lump]:
    """A broad pad and three toes."""
    pad = Lump(joint, Ellipsoid((left, 0.026, ahead), (0.036, 0.026, 0.040)), 0.015)
    toes = [
        ball(joint, (left + side, 0.018, ahead + reach), 0.0175, reach_m=0.008)
        for side, reach in ((-0.023, 0.026), (0.0, 0.038), (0.023, 0.026))
    ]
    return [pad, *toes]


def _horns() -> list[Solid]:
    """Horns, claws on feet and wings, upper fangs."""
    horns = [
        capsule("head", (0.036, 0.902, 0.360), (0.058, 0.950, 0.305), 0.017, 0.012),
        capsule("head", (0.058, 0.950, 0.305), (0.066, 0.998, 0.225), 0.012, 0.002),
        capsule("head", (0.070, 0.838, 0.345), (0.110, 0.850, 0.290), 0.012, 0.002),
        wing_claw(),
    ]
    for joint, left, ahead in (("left_hind_toes", 0.102, -0.242), ("left_fore_toes", 0.100, 0.166)):
        for side, reach in ((-0.023, 0.026), (0.0, 0.038), (0.023, 0.026)):
            base = (left + side, 0.017, ahead + reach + 0.010)
            tip = (left + 1.15 * side, 0.005, ahead + reach + 0.034)
            horns.append(capsule(joint, base, tip, 0.0085, 0.002))
    for x, z, long in ((0.030, 0.535, 0.026), (0.040, 0.500, 0.018), (0.044, 0.465, 0.014)):
        horns.append(capsule("head", (x, 0.806, z), (x, 0.803 - long, z), 0.006, 0.0012))
    return horns


def _brows(skeleton: Skeleton) -> Mesh:
    """Return ridges over the eyes that go where the skin goes."""
    rods = [capsule("head", BROW_IN, BROW_OUT, 0.0115, 0.007, rings=8, around=12)]
    return solid_mesh("brows", skeleton, on_both_sides_of(rods), LID_RGB)


def _mouth(skeleton: Skeleton) -> list[Mesh]:
    """Return the dark palate, which stays, and what lies in the jaw: dark, tongue, teeth."""
    palate = [globe("head", (0.0, 0.800, 0.465), (0.043, 0.010, 0.085), rings=12, around=24)]
    floor = [globe("head", (0.0, 0.801, 0.460), (0.040, 0.0085, 0.088), rings=12, around=24)]
    tongue = [globe("head", (0.0, 0.804, 0.478), (0.020, 0.0075, 0.062), rings=12)]
    teeth = [
        capsule("head", (x, 0.796, z), (x, 0.796 + long, z), 0.0055, 0.0012)
        for x, z, long in ((0.021, 0.548, 0.020), (0.033, 0.516, 0.016), (0.038, 0.482, 0.013))
    ]
    throat = [globe("head", (0.0, 0.798, 0.392), (0.044, 0.026, 0.030), rings=12, around=24)]
    turned = {"jaw_open": jaw_motion()}
    return [
        solid_mesh("palate", skeleton, [*palate, *throat], DARK_RGB),
        with_shapes(solid_mesh("mouth", skeleton, floor, DARK_RGB), turned),
        with_shapes(solid_mesh("tongue", skeleton, tongue, TONGUE_RGB), turned),
        with_shapes(solid_mesh("teeth", skeleton, on_both_sides_of(teeth), HORN_RGB), turned),
    ]


def _crest(skeleton: Skeleton) -> Mesh:
    """Return a row of spikes from the brow to the tail; those of head and neck can rise."""
    rows: list[tuple[str, Point, float, bool]] = [
        ("head", (0.0, 0.918, 0.385), 0.060, True),
        ("head", (0.0, 0.905, 0.335), 0.078, True),
        ("neck_4", (0.0, 0.838, 0.296), 0.080, True),
        ("neck_4", (0.0, 0.772, 0.278), 0.074, True),
        ("neck_3", (0.0, 0.700, 0.256), 0.066, True),
        ("neck_2", (0.0, 0.628, 0.222), 0.058, True),
        ("neck_1", (0.0, 0.570, 0.150), 0.052, False),
        ("back", (0.0, 0.556, 0.030), 0.044, False),
        ("loin", (0.0, 0.550, -0.060), 0.044, False),
        ("pelvis", (0.0, 0.546, -0.160), 0.044, False),
    ]
    for k in range(len(TAIL)):
        top = (0.074, 0.060, 0.050, 0.042, 0.035, 0.028, 0.022, 0.017)[k]
        _, y, z = TAIL[k]
        rows.append((f"tail_{k + 1}", (0.0, y + top, z - 0.01), 0.044 - 0.003 * k, False))
    solids, offsets = [], []
    for joint, base, long, rises in rows:
        x, y, z = base
        low: Point = (x, y - 0.008, z)
        up = -0.40 if joint.startswith("neck") else 0.50  # they lie along the neck
        tip: Point = (x, y + up * long, z - 0.95 * long)
        spike = capsule(joint, low, tip, 0.20 * long, 0.0015, rings=6, around=10)
        flat = spike.points_m * np.array([0.55, 1.0, 1.0])
        solids.append(replace(spike, points_m=flat))
        turned = swung(base, (1.0, 0.0, 0.0), -CREST_DEG)(flat)
        offsets.append(turned * (1.0 if rises else 0.0))
    point, vane = TAIL_TIP, 0.060
    for side in (-1.0, 1.0):  # a vane at the tip of the tail
        out: Point = (side * vane, point[1] + 0.055, point[2] - 0.035)
        solids.append(capsule(f"tail_{len(TAIL)}", point, out, 0.018, 0.002))
        offsets.append(np.zeros_like(solids[-1].points_m))
    end: Point = (0.0, point[1] + 0.09, point[2] - 0.10)
    solids.append(capsule(f"tail_{len(TAIL)}", point, end, 0.020, 0.002))
    offsets.append(np.zeros_like(solids[-1].points_m))
    mesh = solid_mesh("crest", skeleton, solids, CREST_RGB)
    every = np.concatenate(offsets)
    far = np.linalg.norm(every, axis=1, keepdims=True) >= LEAST_M
    return replace(mesh, shapes=(BlendShape.sparse("crest_raise", np.where(far, every, 0.0)),))


def _face_magnified(points: FloatArray) -> FloatArray:
    """Return points with the head larger: looked at closely, it needs more triangles."""
    middle = np.array([0.0, 0.84, 0.45])
    on_head = np.clip((points[:, 1:2] - 0.74) / 0.05, 0.0, 1.0)
    return points + 0.7 * on_head * (points - middle)
