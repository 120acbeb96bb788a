"""Greatest force and duration of the impacts of a run, where the stiffness of the contact is stated."""

from __future__ import annotations

import numpy as np

from carom.impact.api import with_path
from carom.impact.force import duration, peak_force
from carom.scene.stiffness import ABSOLUTE, Hertz, Stiffness, curvature_of


def stiff_impacts(solution, rows, mu, e, law) -> tuple[np.ndarray, np.ndarray]:
    """Return the greatest normal force [N] and the duration [s] of the impacts (K,).

    They are NaN without a stiffness, or with a law that has no course. A point of a multiple impact has the
    force by the work of its own compression, and no duration.
    """
    pairs = solution.pairs
    peak, took = np.full((2, len(rows)), np.nan)
    numbers = rows.contact[rows.contact < len(pairs.body)]  # stops have no stiffness
    for number in np.unique(numbers).tolist():
        stiffness = stiffness_of(solution, number)
        if stiffness is None:
            continue
        k, n = stiffness.k, stiffness.exponent
        own = np.flatnonzero(rows.contact == number)
        own = own[[with_path(str(name)) for name in law[own]]]
        peak[own] = peak_force(rows.compression_work[own], k, n)
        for i in own[(rows.together[own] == 1) & np.isfinite(mu[own] + e[own])].tolist():
            took[i] = _duration(rows[i], float(mu[i]), float(e[i]), str(law[i]), (k, n))
    return peak, took


def stiffness_of(solution, number: int) -> Stiffness | None:
    """Return the stated stiffness of a pair, by its number; None where there is none, or no radius."""
    pairs, scene = solution.pairs, solution.scene
    if number >= len(pairs.body):
        return None
    stiffness = pairs.laws[pairs.law[number]].stiffness
    plane, other = pairs.plane[number], pairs.other[number]
    partner = scene.fixed[plane] if plane >= 0 else scene.bodies[other]
    if not isinstance(stiffness, ABSOLUTE):
        return None
    curvature = curvature_of(scene.bodies[pairs.body[number]], partner)
    if isinstance(stiffness, Hertz) and stiffness.radius is None and not curvature:
        return None  # of two materials, on shapes that have no radius
    return Stiffness(*stiffness._of(curvature))


def _duration(row, mu: float, e: float, law: str, stiffness: tuple[float, float]) -> float:
    """Return the duration of a single impact [s], NaN where it cannot be followed once more."""
    from carom.impact.api import resolve_impact

    W, u = np.array(row.W), np.array(row.before)
    stated = {"inverse_mass": W, "relative_velocity_before": u, "friction": mu}
    try:
        solved = resolve_impact(W, u, mu, e, law)
        impulses = float(solved.compression_impulse[0]), float(solved.impulse[0])
        works = float(solved.compression_work), float(solved.restitution_work)
        return duration(stated, impulses, works, *stiffness)
    except ValueError:
        return np.nan
