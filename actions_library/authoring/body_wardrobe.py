"""What the shipped humanoid wears: shirt, trousers, shoes and hair.

Every piece is a solid of its own. Clothes are the body's field grown by some millimetres, loosened
by wider shapes and cut where they end; what of them lies inside the body is never seen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.body_field import (
    Ellipsoid,
    Field,
    HalfSpace,
    Loft,
    RoundCone,
)
from actions_library.authoring.body_shape import (
    ANKLE,
    DOWN,
    FORWARD,
    HIP,
    KNEE,
    SHOULDER,
    UP,
    BodyFields,
    as_point,
    between,
)
from actions_library.authoring.hand_shape import DOWN_45

SOLE_STEP_M = 0.002
"""What is thin has a finer grid of its own."""

HEM_M = 0.040
"""Reach of the rounding where a piece ends."""

Color = tuple[float, float, float]

HAIR_RGB: Color = (0.055, 0.028, 0.016)


@dataclass(frozen=True)
class Garment:
    """A solid that is worn.

    Attributes
    ----------
    name : of its mesh.
    field : its left half's distance.
    triangle_count : about how many triangles both halves have.
    color_rgb : linear.
    on_head : moves with the head alone; else as the skin below it.
    """

    name: str
    field: Field
    triangle_count: int
    color_rgb: Color
    on_head: bool = False


def wardrobe(body: BodyFields) -> list[Garment]:
    """Return all that the figure wears, made to measure."""
    return [
        Garment("shirt", _shirt(body), 7000, (0.030, 0.200, 0.245)),
        Garment("trousers", _trousers(body), 4400, (0.040, 0.045, 0.062)),
        Garment("shoes", _shoes(body), 2400, (0.52, 0.110, 0.055)),
        Garment("soles", _soles(), 2000, (0.78, 0.76, 0.72)),
        Garment("hair", _hair(body), 2600, HAIR_RGB, on_head=True),
    ]


def _shirt(body: BodyFields) -> Field:
    """Return a T-shirt that falls straight from the chest."""
    loose = [
        (0.890, 0.118, 0.126, 0.174, 0.174, 0.000, 0.0),
        (0.960, 0.116, 0.120, 0.172, 0.172, 0.000, 0.0),
        (1.020, 0.115, 0.111, 0.166, 0.166, 0.000, 0.0),
        (1.100, 0.116, 0.104, 0.159, 0.159, 0.000, 0.0),
        (1.180, 0.119, 0.108, 0.160, 0.160, 0.000, 0.0),
        (1.260, 0.121, 0.114, 0.164, 0.164, 0.000, 0.0),
        (1.320, 0.118, 0.116, 0.160, 0.160, -0.002, 0.0),
        (1.370, 0.100, 0.110, 0.140, 0.140, -0.006, 0.0),
    ]
    shirt = body.trunk.grown(0.008)
    shirt.add(Loft((0.0, 0.0, 0.0), UP, FORWARD, loose, (0.02, 0.05), 2.3), 0.03)
    over_trousers = body.trunk.grown(0.018)
    over_trousers.keep(HalfSpace((0.0, 1.02, 0.0), UP), 0.10)
    shirt.merge(over_trousers, 0.02)
    shirt.keep(HalfSpace((0.0, 0.905, 0.0), DOWN), HEM_M)
    shirt.keep(HalfSpace((0.0, 1.510, 0.0), UP), HEM_M)
    shirt.carve(RoundCone((0.0, 1.495, -0.005), (0.0, 1.640, 0.020), 0.078, 0.110), HEM_M)
    sleeve = body.arm.grown(0.009)
    wide = [
        (0.02, 0.058, 0.058, 0.058, 0.056, 0.0, 0.0),
        (0.20, 0.062, 0.062, 0.058, 0.060, 0.0, 0.0),
    ]
    sleeve.add(Loft(SHOULDER, DOWN_45, FORWARD, wide, (0.04, 0.02), mirrored=True), 0.02)
    cuff = np.array(SHOULDER) + 0.165 * np.array(DOWN_45)
    sleeve.keep(HalfSpace(as_point(cuff), DOWN_45), HEM_M)
    whole = Field(((0.0, 0.86, -0.21), (0.40, 1.56, 0.20)), shirt.step_m)
    whole.merge(shirt, 0.0)
    whole.merge(sleeve, 0.060)
    return whole


def _trousers(body: BodyFields) -> Field:
    """Return trousers with a little room below the knee."""
    loose_leg = [
        (0.00, 0.086, 0.090, 0.074, 0.080, 0.0, 0.0),
        (0.20, 0.084, 0.086, 0.078, 0.076, 0.0, 0.0),
        (0.413, 0.064, 0.066, 0.062, 0.060, 0.0, 0.0),
    ]
    loose_shin = [
        (0.00, 0.064, 0.066, 0.062, 0.060, 0.0, 0.0),
        (0.15, 0.058, 0.072, 0.062, 0.060, 0.0, 0.0),
        (0.30, 0.054, 0.060, 0.054, 0.052, 0.0, 0.0),
        (0.42, 0.052, 0.058, 0.052, 0.049, 0.0, 0.0),
    ]
    legs = body.leg.grown(0.008)
    legs.add(Loft(HIP, between(HIP, KNEE), FORWARD, loose_leg, (0.03, 0.02)), 0.02)
    legs.add(Loft(KNEE, between(KNEE, ANKLE), FORWARD, loose_shin, (0.02, 0.02)), 0.02)
    legs.keep(HalfSpace((0.005, 0.0, 0.0), (-1.0, 0.0, 0.0)), 0.010)
    legs.merge(body.whole, 0.02, 0.009)
    legs.keep(HalfSpace((0.0, 0.090, 0.0), DOWN), HEM_M)
    legs.keep(HalfSpace((0.0, 1.020, 0.0), UP), HEM_M)
    return legs


def _shoes(body: BodyFields) -> Field:
    """Return the left shoe: sole, upper and a rim below the ankle."""
    rows = [
        (0.000, 0.040, 0.030, 0.032, 0.032, 0.028, 0.000),
        (0.030, 0.052, 0.036, 0.040, 0.038, 0.034, 0.000),
        (0.080, 0.060, 0.036, 0.042, 0.039, 0.034, 0.001),
        (0.125, 0.052, 0.032, 0.044, 0.041, 0.030, 0.002),
        (0.165, 0.042, 0.028, 0.049, 0.047, 0.026, 0.003),
        (0.205, 0.034, 0.024, 0.051, 0.049, 0.022, 0.003),
        (0.245, 0.028, 0.020, 0.046, 0.044, 0.018, 0.001),
        (0.262, 0.022, 0.017, 0.038, 0.036, 0.016, -0.002),
    ]
    heel, forward = (0.094, 0.0, -0.080), (0.03, 0.0, 1.0)
    shoe = Field(((0.02, -0.03, -0.16), (0.20, 0.16, 0.24)), body.leg.step_m)
    shoe.merge(body.leg, 0.0, 0.007)
    shoe.add(Loft(heel, forward, UP, rows, (0.018, 0.020), 2.5, mirrored=True), 0.02)
    shoe.keep(HalfSpace((0.0, 0.098, -0.020), (0.0, 1.0, -0.15)), HEM_M)
    shoe.keep(HalfSpace((0.0, 0.004, 0.0), DOWN), 0.008)
    return shoe


def _soles() -> Field:
    """Return the left shoe's sole."""
    rows = [
        (0.000, 0.026, 0.040, 0.039, 0.0),
        (0.030, 0.026, 0.048, 0.045, 0.0),
        (0.080, 0.026, 0.048, 0.044, 0.001),
        (0.125, 0.026, 0.051, 0.047, 0.002),
        (0.165, 0.026, 0.056, 0.054, 0.003),
        (0.205, 0.026, 0.058, 0.056, 0.003),
        (0.245, 0.026, 0.053, 0.051, 0.001),
        (0.262, 0.026, 0.045, 0.043, -0.002),
    ]
    slab = [(at, up, 0.02, out, into, 0.0, shift) for at, up, out, into, shift in rows]
    heel, forward = (0.094, 0.0, -0.080), (0.03, 0.0, 1.0)
    sole = Field(((0.02, -0.03, -0.16), (0.20, 0.06, 0.24)), SOLE_STEP_M)
    sole.add(Loft(heel, forward, UP, slab, (0.026, 0.028), 3.0, mirrored=True), 0.0)
    sole.keep(HalfSpace((0.0, 0.0, 0.0), DOWN), 0.010)
    return sole


def _hair(body: BodyFields) -> Field:
    """Return short hair, combed back, fuller above the brow."""
    hair = body.head.grown(0.010)
    hair.add(Ellipsoid((0.0, 1.690, -0.014), (0.080, 0.066, 0.092)), 0.03)
    hair.add(RoundCone((0.008, 1.722, 0.066), (0.040, 1.722, 0.048), 0.024, 0.020), 0.03)
    # The face stays free: below the hairline, before the ears.
    hair.carve(Ellipsoid((0.0, 1.600, 0.118), (0.085, 0.104, 0.082)), 0.012)
    hair.carve(Ellipsoid((0.095, 1.596, 0.006), (0.045, 0.052, 0.038)), 0.012)
    hair.keep(HalfSpace((0.0, 1.572, -0.08), (0.0, -1.0, 0.35)), HEM_M)
    return hair
