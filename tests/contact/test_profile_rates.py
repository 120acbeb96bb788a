"""Rates of the rows of a profile: closed form against the points found before and after."""

import math

import numpy as np
import pytest

import carom
from contact.row_rates import Motion, Touching

TURNS = [0.25 * math.pi * k for k in range(8)]
CURVES = {
    "smooth": carom.Profile(lambda a: 0.5 * (1 + 0.25 * math.cos(3 * a) + 0.1 * math.sin(a)), 0.2),
    "corners": carom.Profile(
        [(r * math.cos(a), r * math.sin(a)) for a in TURNS for r in (0.4, 0.5)], 0.3, corners="all"
    ),
}
HEXAGON = [
    (0.2 * math.cos(k * math.pi / 3), 0.2 * math.sin(k * math.pi / 3), z)
    for k in range(6)
    for z in (-0.2, 0.2)
]
PARTNERS = {
    "sphere": carom.Sphere(0.15),
    "cylinder": carom.Cylinder(0.15, 0.1),
    "capsule": carom.Capsule(0.1, 0.3),
    "box": carom.Box(0.3, 0.4, 0.2),
    "rounded box": carom.Box(0.3, 0.4, 0.2, radius=0.03),
    "prism": carom.Convex(HEXAGON),
}


@pytest.mark.few(4)
@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("partner", PARTNERS)
def test_closed_form_is_the_rate_of_the_points(curve, partner):
    # Motions in the plane of the curve, apart by up to a half of the size, either of the two as the first; a
    # ball also beyond the thickness, where it meets the rim or a flat side.
    rng, checked = np.random.default_rng(len(curve) + len(partner)), 0
    for k in range(4):
        place, turn = 0.9 * rng.normal(size=2), rng.uniform(0, 6, 2)
        place *= rng.uniform(0.85, 1.0) / np.linalg.norm(place)
        high = (0.0, 0.05, 0.2, 0.25)[k] if partner == "sphere" else 0.0
        attitudes = [(math.cos(a / 2), 0, 0, math.sin(a / 2)) for a in turn]
        motions = [
            Motion(
                x, np.array(q), np.array([*rng.normal(size=2), 0]), np.array([0, 0, rng.normal()])
            )
            for x, q in zip((np.array([*place, high]), np.zeros(3)), attitudes)
        ]
        pair = [(PARTNERS[partner], motions[0]), (CURVES[curve], motions[1])][:: 1 - 2 * (k % 2)]
        (a, here), (b, there) = pair
        for rate in Touching(a, b, here, there, 0.05).rates():
            assert rate.doubt < 1e-8 * rate.scale
            assert np.linalg.norm(rate.exact - rate.difference) < 1e-6 * rate.scale, rate
            checked += 1
    assert checked >= 4
