"""The outline of an involute gear.

With the base circle r_b, the place of an involute at the roll angle u is at the radius r_b sqrt(1 + u^2), and
has turned by inv = u - atan(u) from where it begins. A tooth that has the thickness s on the pitch circle r,
where u is tan(phi) with the pressure angle phi, spans at roll u the angle s/(2 r) + inv(tan(phi)) - inv(u) to
both sides of its middle. Below the base circle its sides are radial.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom.scene.curve_table import ACCURACY, MOST_PIECES, PiecewiseCurve, between
from carom.scene.outline import TURN, Outline, joined, straight

LEAST_ROLL = 0.05  # rad: where an involute begins, whose curvature is infinite on the base circle
EVEN = 1e-10  # largest difference of |dx/ds| from 1


class Gear(NamedTuple):
    """Sizes of a gear [m]."""

    teeth: int
    pitch: float  #: radius
    base: float
    tip: float
    root: float
    thick: float  #: of a tooth on the pitch circle

    def half(self, roll: float | np.ndarray) -> float | np.ndarray:
        """Return half the angle that a tooth spans at a roll angle."""
        at_pitch = math.sqrt(max((self.pitch / self.base) ** 2 - 1.0, 0.0))
        return 0.5 * self.thick / self.pitch + _inv(at_pitch) - _inv(roll)

    def roll(self, radius: float) -> float:
        """Return the roll angle at a radius."""
        return math.sqrt(max((radius / self.base) ** 2 - 1.0, 0.0))


def _inv(roll):
    return roll - np.arctan(roll)


def gear(
    teeth: int, module: float, pressure_angle: float, backlash: float, shift: float, heights: tuple
) -> Gear:
    """Return the sizes of a gear; refuse one whose teeth are pointed or fill the gaps."""
    pitch, (addendum, dedendum) = 0.5 * module * teeth, heights
    base = pitch * math.cos(pressure_angle)
    thick = module * (0.5 * math.pi + 2.0 * shift * math.tan(pressure_angle)) - 0.5 * backlash
    tip, root = pitch + module * (addendum + shift), pitch - module * (dedendum - shift)
    made = Gear(teeth, pitch, base, tip, root, thick)
    if not root > 0.0:
        raise ValueError(
            f"dedendum must leave a radius above 0, got {dedendum:g} for {teeth} teeth"
        )
    low, high = made.half(max(made.roll(root), LEAST_ROLL)), made.half(made.roll(tip))
    if not (tip > base and made.roll(tip) > LEAST_ROLL and high > 0.0):
        raise ValueError(
            f"addendum must leave teeth with a top, got {addendum:g} with a shift of {shift:g} for {teeth} "
            "teeth"
        )
    if not low < math.pi / teeth:
        raise ValueError(
            f"teeth must leave gaps between them, got {teeth} of the thickness {thick:g} m (shift {shift:g})"
        )
    return made


def outline_of(sizes: Gear) -> Outline:
    """Return the outline of a gear, with the middle of a tooth on the axis x."""
    parts = _tooth(sizes)
    turns = 2.0 * math.pi / sizes.teeth * np.arange(sizes.teeth)
    return joined([_turned(part, turn) for turn in turns.tolist() for part in parts], corners=True)


def _tooth(g: Gear) -> list[PiecewiseCurve]:
    """Return the parts of a tooth, and of the gap behind it, counter-clockwise."""
    first, last = max(g.roll(g.root), LEAST_ROLL), g.roll(g.tip)
    begin, top, gap = float(g.half(first)), float(g.half(last)), math.pi / g.teeth
    low = g.base * math.sqrt(1.0 + first * first)

    def radial(start: float, end: float, angle: float) -> list[PiecewiseCurve]:
        if first > LEAST_ROLL:  # the flank goes down to the root
            return []
        e = np.array([math.cos(angle), math.sin(angle)])
        return [straight(start * e, end * e, abs(end - start))]

    def rise(u: np.ndarray) -> np.ndarray:
        return _involute(g.base, -float(g.half(0.0)), u)

    def fall(v: np.ndarray) -> np.ndarray:
        return rise(-v) * [[1.0, -1.0]] * [[1.0], [-1.0], [1.0]]  # mirrored, the other way

    rolls = np.array([first, last])
    return [
        *radial(g.root, low, -begin),
        _pieces(rise, rolls, lambda u: 0.5 * g.base * u * u, graded=True),
        _pieces(lambda u: _circle(g.tip, u), np.array([-top, top]), lambda u: g.tip * u),
        _pieces(fall, -rolls[::-1], lambda v: -0.5 * g.base * v * v, graded=True),
        *radial(low, g.root, begin),
        _pieces(
            lambda u: _circle(g.root, u), np.array([begin, 2.0 * gap - begin]), lambda u: g.root * u
        ),
    ]


def _circle(radius: float, angle: np.ndarray) -> np.ndarray:
    """Return place, direction and curvature vector (K, 3, 2) of a circle at angles."""
    e = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.stack([radius * e, e[:, ::-1] * [-1.0, 1.0], -e / radius], axis=1)


def _involute(base: float, start: float, u: np.ndarray) -> np.ndarray:
    """Return place, direction and curvature vector (K, 3, 2) of an involute at roll angles: s = base u^2/2."""
    t = np.stack([np.cos(start + u), np.sin(start + u)], axis=-1)
    n, u = t[:, ::-1] * [-1.0, 1.0], u[:, None]
    return np.stack([base * (t - u * n), t, n / (base * u)], axis=1)


def _pieces(ends, span: np.ndarray, length, graded: bool = False) -> PiecewiseCurve:
    """Return a curve in as few pieces as are accurate, from its `ends` and arc length at a parameter.

    Pieces of an involute are shorter towards the base circle, where its curvature grows as 1/u.
    """
    a, b = span.tolist()
    count = max(1, math.ceil(abs(b - a) / TURN))
    while True:
        u = np.geomspace(a, b, count + 1) if graded else np.linspace(a, b, count + 1)
        s = length(u) - length(u[0])
        made = PiecewiseCurve(s, between(s, ends(u)))
        tried = (u[:-1, None] + np.diff(u)[:, None] * [0.25, 0.5, 0.75]).ravel()
        place, slope, _ = made._at(length(tried) - length(u[0]))
        exact = ends(tried)[:, 0]
        off = np.max(np.abs(place - exact)) / (ACCURACY * np.max(np.abs(exact)))
        uneven = np.max(np.abs(np.linalg.norm(slope, axis=1) - 1.0)) / EVEN
        if max(off, uneven) <= 1.0 or count >= MOST_PIECES:
            return made
        count += max(1, count // 4)


def _turned(part: PiecewiseCurve, angle: float) -> PiecewiseCurve:
    """Return a part turned about the axis, in the plane."""
    c, s = math.cos(angle), math.sin(angle)
    return PiecewiseCurve(part.knots, part.coefficients[:, :, :2] @ np.array([[c, s], [-s, c]]))
