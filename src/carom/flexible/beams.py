"""Modes of straight beams in closed form: bending in two planes (Euler and Bernoulli), stretch and twist.

With s along the beam of length L, the deflection w, and b L the roots of the equation of the ends:

| ends | equation | shape |
| --- | --- | --- |
| free, clamped | cos bL cosh bL = 1 | cosh bs +- cos bs - q (sinh bs +- sin bs) |
| clamped-free | cos bL cosh bL = -1 | cosh bs - cos bs - q (sinh bs - sin bs) |
| clamped-pinned | tan bL = tanh bL | the same |
| pinned | sin bL = 0 | sin bs |

w_k^2 = E I b^4 / (rho A). A section stays plane and perpendicular: a place (x, y, z) moves by
(u - y v' - z w', v - z t, w + y t), with the stretch u and the twist t. (Blevins, Formulas for Natural
Frequency and Mode Shape, tables 8-1, 8-16, 8-19.)
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import partial
from typing import NamedTuple

import numpy as np

from carom import arguments, checks
from carom.flexible.modes import Modes
from carom.flexible.sections import MOST_MODES, SECTIONS, material

#: ends of a beam: first number of half waves of bending, and of stretch and twist; which of these are held
ENDS = ("free", "clamped", "pinned", "clamped-free", "clamped-pinned")
KINDS = ("bend", "stretch", "twist")
NEWTON = 30  # steps to a root, which converge in five


class Bending(NamedTuple):
    """Bending shapes w(s) = a e^(-b s) + c e^(-b (L - s)) + p cos b s + q sin b s, stable for high modes."""

    b: np.ndarray  # (n,) [1/m]
    a: np.ndarray
    c: np.ndarray
    p: np.ndarray
    q: np.ndarray

    def at(self, s: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
        """Return w and dw/ds (k, n) at places s (k,)."""
        left, right = np.exp(-np.outer(s, self.b)), np.exp(-np.outer(length - s, self.b))
        cos, sin = np.cos(np.outer(s, self.b)), np.sin(np.outer(s, self.b))
        w = self.a * left + self.c * right + self.p * cos + self.q * sin
        slope = self.b * (-self.a * left + self.c * right - self.p * sin + self.q * cos)
        return w, slope

    def integral(self, length: float) -> np.ndarray:
        """Return the integrals (n,) of w over the beam."""
        gone, x = -np.expm1(-self.b * length), self.b * length
        return ((self.a + self.c) * gone + self.p * np.sin(x) + self.q * (1.0 - np.cos(x))) / self.b


@arguments.known
def beam(
    length: float,
    section,
    density: float,
    young: float,
    poisson: float = 0.3,
    ends: str = "free",
    modes: int = 8,
    kinds: Iterable[str] = KINDS,
    damping: float = 0.0,
) -> Modes:
    """Return the modes of a straight beam along the x axis of its body, from -length/2 to length/2.

    Parameters
    ----------
    length : float
        [m]
    section : Circle, Tube or Rectangle
        Cross-section (`carom.flexible`), constant along the beam.
    density : float
        [kg/m^3]
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio, above -1 and at most .5, for the shear modulus of twist. Default .3.
    ends : str
        "free" (default), "clamped" (both), "pinned" (both), "clamped-free" (clamped at -length/2) or
        "clamped-pinned". Ends that are clamped or pinned do not stretch or twist either.
    modes : int
        How many: those of the lowest frequencies of all `kinds`. Default 8.
    kinds : sequence of str
        Among "bend" (in both planes), "stretch" and "twist". Default: all.
    damping : float
        Damping ratio of all modes. Default 0.

    Returns
    -------
    Modes
        With the mass and the inertia of the rigid beam. Rotation of sections has no inertia in bending, and
        shear no compliance: good for half waves that are long against the section.

    Raises
    ------
    ValueError
        If an argument is outside its range.

    Examples
    --------
    The lowest frequency of a free steel rod, 4.7300^2 / (2 pi L^2) sqrt(E I / (rho A)):

    >>> rod = carom.flexible.beam(1.0, carom.flexible.Circle(0.01), density=7800, young=210e9, modes=4)
    >>> print(rod.frequencies.round(3))
    [ 92.381  92.381 254.652 254.652]
    """
    length = checks.length("length", length)
    checks.instance("section", section, SECTIONS)
    density, young = material(density, young)
    poisson = checks.number("poisson", poisson, above=-1, most=0.5)
    ends, count = (
        checks.choice("ends", ends, ENDS),
        checks.integer("modes", modes, least=1, most=MOST_MODES),
    )
    chosen = tuple(
        checks.choice("kinds", kind, KINDS) for kind in checks.listed("kinds", kinds, "kinds")
    )
    if not chosen:
        raise ValueError(f"kinds must have at least one of {KINDS}, got none")
    area, (about_y, about_z) = section.area, section.second_moments
    mass, parts = density * area * length, []
    bend = bending(ends, length, count)
    if "bend" in chosen:
        for axis, moment in (
            (2, about_y),
            (1, about_z),
        ):  # deflection along z turns sections about y
            w = bend.b**2 * math.sqrt(young * moment / (density * area))
            parts += [("bend", axis, k, one) for k, one in enumerate(w)]
    k = waves(ends, count) / length
    for kind, speed in (
        ("stretch", math.sqrt(young / density)),
        ("twist", math.sqrt(
            young / (2.0 * (1.0 + poisson)) * section.twist_constant / (density * (about_y + about_z))
        )),
    ):  # fmt: skip
        if kind in chosen:
            parts += [(kind, 0, i, speed * one) for i, one in enumerate(k)]
    parts = sorted(parts, key=lambda one: (one[3], one[0], one[1]))[:count]

    # ∫ w^2 ds = L for bending shapes but sin, L/2 for waves: unit modal masses
    bent = math.sqrt((2.0 if ends == "pinned" else 1.0) / mass)
    stretched, twisted = math.sqrt(2.0 / mass), math.sqrt(2.0 * area / (mass * (about_y + about_z)))
    shapes = partial(_shapes, parts, bend, k, (bent, stretched, twisted), (ends, length))
    weight = np.zeros((3, len(parts)))
    if ends != "free":
        line = density * area
        for m, (kind, axis, i, _) in enumerate(parts):
            if kind == "bend":
                weight[axis, m] = line * bent * bend.integral(length)[i]
            elif kind == "stretch":
                weight[0, m] = line * stretched * (1.0 - math.cos(k[i] * length)) / k[i]
    whole = mass * length**2 / 12.0
    per_area = density * length
    return Modes(
        np.array([one[3] for one in parts]) / (2.0 * math.pi), damping, mass, shapes,
        inertia=(per_area * (about_y + about_z), whole + per_area * about_y, whole + per_area * about_z),
        supported=ends != "free", participation=weight,
    )  # fmt: skip


def _shapes(parts, bend: Bending, k: np.ndarray, scale, beam, points: np.ndarray) -> np.ndarray:
    """Return the displacements (P, 3, n) at points (P, 3)."""
    (bent, stretched, twisted), (ends, length) = scale, beam
    wave = np.cos if ends == "free" else np.sin
    x, y, z = points.T
    s, out = x + 0.5 * length, np.zeros((len(points), 3, len(parts)))
    w, slope = bend.at(s, length)
    for m, (kind, axis, i, _) in enumerate(parts):
        if kind == "bend":
            out[:, axis, m] = bent * w[:, i]
            out[:, 0, m] = -bent * (y if axis == 1 else z) * slope[:, i]
        elif kind == "stretch":
            out[:, 0, m] = stretched * wave(k[i] * s)
        else:
            turn = twisted * wave(k[i] * s)
            out[:, 1, m], out[:, 2, m] = -z * turn, y * turn
    return out


def waves(ends: str, count: int) -> np.ndarray:
    """Return k L of stretch and twist: n pi, or (n - 1/2) pi with one end free."""
    n = np.arange(1, count + 1)
    return np.pi * (n - 0.5 if ends == "clamped-free" else n)


def bending(ends: str, length: float, count: int) -> Bending:
    """Return the first bending shapes between some ends."""
    n = np.arange(1, count + 1)
    if ends == "pinned":
        zero = np.zeros(count)
        return Bending(n * np.pi / length, zero, zero, zero, np.ones(count))
    x = np.pi * (n + {"clamped-free": -0.5, "clamped-pinned": 0.25}.get(ends, 0.5))
    sign = {"clamped-free": 1.0, "clamped-pinned": 0.0}.get(ends, -1.0)
    for _ in range(NEWTON):  # cos x + sign / cosh x = 0; sin x - tanh x cos x = 0
        tanh, sech = np.tanh(x), 2.0 * np.exp(-x) / (1.0 + np.exp(-2.0 * x))
        if sign == 0.0:
            step = (np.sin(x) - tanh * np.cos(x)) / (
                np.cos(x) + tanh * np.sin(x) - np.cos(x) * sech**2
            )
        else:
            step = (np.cos(x) + sign * sech) / (-np.sin(x) - sign * tanh * sech)
        x = x - step
    small, cos, sin = np.exp(-x), np.cos(x), np.sin(x)
    # q = (cosh -+ cos)/(sinh -+ sin), and (1 - q) e^x without a difference of great numbers
    if ends == "clamped-free":
        bottom = 0.5 * (1.0 + small**2) + small * cos
        q, rest = (0.5 * (1.0 - small**2) - small * sin) / bottom, (small + cos + sin) / bottom
    else:
        bottom = 0.5 * (1.0 - small**2) - small * sin
        q, rest = (0.5 * (1.0 + small**2) - small * cos) / bottom, (-small + cos - sin) / bottom
    side = 1.0 if ends == "free" else -1.0
    return Bending(x / length, 0.5 * (1.0 + q), 0.5 * rest, side * np.ones(count), -side * q)
