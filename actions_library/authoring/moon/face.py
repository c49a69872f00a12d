"""The moon's face: a flat ball with craters, eyes under lids, lips before a dark mouth."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.body_field import Ellipsoid, Field, RoundCone
from actions_library.authoring.body_surface import half_surface, mirrored
from actions_library.authoring.displacement import (
    Motion,
    on_both,
    sided,
    step,
    with_shapes,
)
from actions_library.authoring.eyes import eye_meshes, lid_mesh, lids_moved, pupils_scaled
from actions_library.authoring.moon.motions import JAW_MM, mouth_motions, skin_motions
from actions_library.authoring.moon.mouth import MOUTH_M, MoonLipGap, closed, lip_front_m, lips
from actions_library.authoring.moon.skeleton import CENTRE_M, EYE
from actions_library.authoring.solids import (
    Solid,
    capsule,
    globe,
    on_both_sides_of,
    solid_mesh,
)
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

STEP_M = 0.0024
"""Distance between nodes of the grid that the face is sampled on."""

SKIN_TRIANGLES, LIP_TRIANGLES = 15_000, 2_600
SHEET_M = 0.0012
"""How far the lips' colour lies over the skin."""

SKIN_RGB = (0.84, 0.74, 0.44)
LID_RGB = (0.66, 0.53, 0.29)
LEAST_M2 = 1e-11
"""Twice the area of triangles that are none: thinning leaves some in the middle."""

LIP_RGB = (0.52, 0.22, 0.16)
DARK_RGB = (0.045, 0.008, 0.012)
TONGUE_RGB = (0.50, 0.12, 0.12)
TEETH_RGB = (0.86, 0.84, 0.76)
BROW_RGB = (0.22, 0.16, 0.10)
IRIS_RGB = (0.05, 0.16, 0.36)

_CRATERS = (
    ((0.062, 0.304, 0.071), 0.022),
    ((0.122, 0.250, 0.040), 0.014),
    ((0.128, 0.200, 0.052), 0.017),
    ((0.098, 0.078, 0.064), 0.018),
    ((0.136, 0.140, 0.040), 0.012),
    ((0.000, 0.296, 0.086), 0.013),
)
"""Where craters are, and how wide."""


def moon_character(skeleton: Skeleton, *, step_m: float = STEP_M) -> Character:
    """Return the moon, facing +Z.

    Parameters
    ----------
    skeleton
        That of `actions_library.authoring.moon.skeleton.moon_rig`.
    step_m
        Coarser is quicker.
    """
    skin = _skin_field(step_m)
    lid_shapes = sided(
        {
            "blink": lids_moved(EYE, 1.04, 1.0),
            "eye_wide": lids_moved(EYE, -0.36, -0.5),
            "eye_squint": lids_moved(EYE, 0.34, 1.3),
        }
    )
    lids = with_shapes(lid_mesh(EYE, skeleton, "face", LID_RGB), lid_shapes)
    eyes = [
        with_shapes(mesh, {"pupils_wide": on_both(pupils_scaled(EYE, 1.45))})
        if mesh.name == "pupils"
        else mesh
        for mesh in eye_meshes(EYE, skeleton, "left_eye", IRIS_RGB)
    ]
    return Character(
        "moon",
        skeleton,
        (
            _with_lips("skin", skeleton, skin, SKIN_TRIANGLES, SKIN_RGB),
            _with_lips("lips", skeleton, _lip_field(skin), LIP_TRIANGLES, LIP_RGB),
            lids,
            *eyes,
            _brows(skeleton),
            *_inside(skeleton),
        ),
    )


def _skin_field(step_m: float) -> Field:
    x, y, z = CENTRE_M
    field = Field(((0.0, 0.0, -0.14), (0.18, 0.36, 0.17)), step_m)
    field.add(Ellipsoid(CENTRE_M, (0.150, 0.150, 0.112)), 0.0)
    field.add(Ellipsoid((0.0, 0.108, 0.074), (0.066, 0.040, 0.034)), 0.03)  # round the mouth
    field.add(Ellipsoid((0.083, 0.146, 0.072), (0.036, 0.033, 0.030)), 0.03)  # cheek
    field.add(Ellipsoid((0.0, 0.068, 0.080), (0.027, 0.017, 0.022)), 0.03)  # chin
    field.add(RoundCone((0.0, 0.205, 0.105), (0.0, 0.162, 0.128), 0.012, 0.019), 0.018)
    field.add(RoundCone((0.013, 0.156, 0.118), (0.013, 0.156, 0.118), 0.012, 0.012), 0.012)
    field.add(RoundCone((0.024, 0.254, 0.093), (0.074, 0.256, 0.080), 0.014, 0.009), 0.03)
    for (cx, cy, cz), radius in _CRATERS:
        away = np.array([cx - x, cy - y, 1.8 * (cz - z)])
        out = away / np.linalg.norm(away)
        at = np.array([cx, cy, cz]) + 0.62 * radius * out
        field.carve(RoundCone(tuple(at.tolist()), tuple(at.tolist()), radius, radius), 0.007)
    eye = EYE.centre
    field.carve(RoundCone(eye, eye, 1.07 * EYE.radius, 1.07 * EYE.radius), 0.006)
    for cone in lips(-0.0015):
        field.add(cone, 0.008)
    field.carve(MoonLipGap(), 0.002)
    return field


def _lip_field(skin: Field) -> Field:
    """Return the skin of both lips, apart as modelled, as a sheet that lies over the face's."""
    field = Field(((0.0, 0.07, 0.05), (0.07, 0.15, 0.15)), 0.6 * skin.step_m)
    for cone in lips(0.0010):
        field.add(cone, 0.002)
    nodes = np.meshgrid(
        *(
            field.step_m * (first + np.arange(size))
            for first, size in zip(field.first, field.values.shape, strict=True)
        ),
        indexing="ij",
    )
    over = skin.sample(np.stack(nodes, axis=-1).reshape(-1, 3)) - SHEET_M
    field.values = np.maximum(field.values, over.reshape(field.values.shape).astype(np.float32))
    return field


def _with_lips(
    name: str, skeleton: Skeleton, field: Field, triangles: int, rgb: tuple[float, float, float]
) -> Mesh:
    """Return the mesh of a field with lips, closed, and with the shapes that move it."""
    modelled, faces, _ = mirrored(*half_surface(field, triangles // 2, _magnified))
    a, b, c = np.moveaxis(modelled[faces], 1, 0)
    twice_m2 = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    faces = faces[twice_m2 > LEAST_M2]
    points, side = closed(modelled)
    mesh = solid_mesh(name, skeleton, [Solid("face", points, faces)], rgb)
    return with_shapes(mesh, {**mouth_motions(side), **skin_motions()})


def _magnified(points: FloatArray) -> FloatArray:
    """Return points with eyes and mouth larger: what is looked at needs more triangles."""
    seen = points.copy()
    places = ((EYE.centre, 0.045, 0.6), ((0.0, MOUTH_M[1], MOUTH_M[2]), 0.055, 1.0))
    for centre, reach_m, more in places:
        away = points - np.array(centre)
        close = np.exp(-((away / reach_m) ** 2).sum(axis=1, keepdims=True))
        seen = seen + more * close * away
    return seen


def _brows(skeleton: Skeleton) -> Mesh:
    """Return eyebrows that lie on the skin and go where it goes."""
    at = (
        (0.020, 0.254, 0.107),
        (0.046, 0.264, 0.102),
        (0.072, 0.262, 0.092),
        (0.094, 0.250, 0.078),
    )
    radius = (0.0075, 0.0085, 0.0070, 0.0035)
    rods = [
        capsule("face", at[k], at[k + 1], radius[k], radius[k + 1], rings=8, around=12)
        for k in range(3)
    ]
    mesh = solid_mesh("brows", skeleton, on_both_sides_of(rods), BROW_RGB)
    return with_shapes(mesh, skin_motions())


def _inside(skeleton: Skeleton) -> list[Mesh]:
    """Return what shows between the lips: the dark, teeth, a tongue."""
    y, z = MOUTH_M[1], MOUTH_M[2]

    def with_jaw(low: float, high: float) -> Motion:
        def motion(points: FloatArray) -> FloatArray:
            share = 1.0 - step(points[:, 1], low, high)
            return np.outer(share, 0.00092 * np.array(JAW_MM))

        return motion

    dark = [globe("face", (0.0, y, z - 0.030), (0.046, 0.017, 0.019), rings=16, around=32)]
    tongue = [globe("face", (0.0, y - 0.012, z - 0.024), (0.026, 0.007, 0.018), rings=12)]
    teeth = []
    for x in (0.0065, 0.0185, 0.0290):
        front = float(lip_front_m(np.array(x))) - 0.013
        teeth.append(capsule("face", (x, y + 0.002, front), (x, y + 0.010, front), 0.0060, 0.0060))
    return [
        with_shapes(
            solid_mesh("mouth", skeleton, dark, DARK_RGB),
            {"jaw_open": with_jaw(y - 0.012, y + 0.006)},
        ),
        with_shapes(
            solid_mesh("tongue", skeleton, tongue, TONGUE_RGB), {"jaw_open": with_jaw(1.0, 2.0)}
        ),
        solid_mesh("teeth", skeleton, on_both_sides_of(teeth), TEETH_RGB),
    ]
