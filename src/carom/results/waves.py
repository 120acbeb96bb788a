"""Whether a wave passes a body while an impact lasts: the condition of Hertz's law for an impact.

A wave needs 2 L/c, c = (E/rho)^(1/2), to pass a body of the length L and to return. Hertz's law is that of
bodies at rest, so an impact has to last for some of these times.
"""

from __future__ import annotations

import math

import numpy as np

from carom.results.names import contact_name
from carom.scene.stiffness import Hertz, curvature_of
from carom.status import Remark

#: greatest part of an impact that a wave may need, through a body and back: it has to pass at least twice, or
#: the body cannot be taken as one at rest, and vibrates too
WAVE_SHARE = 0.5
#: time of compression times the speed of approach over the greatest depth, the integral of (1 - x^(5/2))^(-1/2)
#: from 0 to 1: 0.4 B(0.4, 0.5)
COMPRESSION_TIME = 1.4716375530


def remarks(rows, run) -> tuple[Remark, ...]:
    """Return a sentence for each pair with Hertz's law whose impacts are as short as a wave through a body."""
    pairs, scene, said = run.pairs, run.scene, []
    for number in sorted({c for c in rows["contact"].tolist() if c < len(pairs.body)}):
        stiffness = pairs.laws[pairs.law[number]].stiffness
        if not isinstance(stiffness, Hertz):
            continue
        plane, other = pairs.plane[number], pairs.other[number]
        body = scene.bodies[pairs.body[number]]
        partner = scene.fixed[plane] if plane >= 0 else scene.bodies[other]
        shortest = _shortest(rows[rows["contact"] == number], stiffness, (body, partner))
        young = stiffness.young if isinstance(stiffness.young, tuple) else (stiffness.young,) * 2
        waves = [(_wave(one, E), one) for one, E in zip((body, partner), young)]
        slow, one = max(waves, key=lambda wave: wave[0])
        if slow > WAVE_SHARE * shortest:
            said.append(
                Remark(
                    f"The shortest impact of contact {contact_name(scene, pairs, number)!r} lasts "
                    f"{shortest:.2g} s by Hertz's law, and a wave needs {slow:.2g} s to pass {one.name!r} and "
                    "to return (2 L/c). Its force and duration are estimates: the body vibrates too."
                )
            )
    return tuple(said)


def _shortest(rows, stiffness: Hertz, pair) -> float:
    """Return the least duration of the impacts of a pair, as if each were central [s]."""
    u, m = -rows["before"][:, 0], rows["W"][:, 0, 0]
    struck = (u > 0.0) & (m > 0.0)
    curvature = curvature_of(*pair) or sum(_mean_curvature(one) for one in pair)
    if not struck.any() or (stiffness.radius is None and not curvature > 0.0):
        return math.inf
    k, _ = stiffness._of(curvature)
    u, m, took = u[struck], 1.0 / m[struck], -rows["compression_work"][struck]
    gave = rows["restitution_work"][struck]
    e = np.sqrt(np.divide(gave, took, out=np.zeros_like(gave), where=took > 0.0))
    return float(np.min((1.0 + e) * COMPRESSION_TIME * (1.25 * m * u**2 / k) ** 0.4 / u))


def _mean_curvature(part) -> float:
    """Return the curvature of a ball of the volume of a part; 0 for a plane."""
    shape = getattr(part, "shape", None)
    volume = getattr(shape, "volume", 0.0)
    return (4.0 / 3.0 * math.pi / volume) ** (1.0 / 3.0) if volume > 0.0 else 0.0


def _wave(part, young: float) -> float:
    """Return 2 L/c of a body [s]; 0 where its density is not known."""
    shape, mass = getattr(part, "shape", None), getattr(part, "mass", None)
    volume = getattr(shape, "volume", 0.0)
    if shape is None or mass is None or not volume > 0.0:
        return 0.0
    return 4.0 * shape.size * math.sqrt(mass / volume / young)
