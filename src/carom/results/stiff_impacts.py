"""Greatest force and duration of the impacts of a run, where the stiffness of the contact is stated."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.impact.api import with_path
from carom.impact.force import duration, peak_force
from carom.scene.stiffness import (
    ABSOLUTE,
    HERTZ,
    Hertz,
    curvature_of,
    curvatures_of,
    is_point_contact,
)


def stiff_impacts(solution, rows, arm, laws) -> tuple[np.ndarray, np.ndarray]:
    """Return the greatest normal force [N] and the duration [s] of the impacts (K,).

    `arm` (K,) converts lengths of stops of angles, for which forces are torques; `laws` are the columns of
    friction, restitution and law of impact. Both are NaN without a stiffness, or with a law without a course. A
    point of a multiple impact has the force by the work of its own compression, and no duration.
    """
    peak, took = np.full((2, len(rows)), np.nan)
    mu, e, law = laws
    for number in np.unique(rows.contact).tolist():
        own = np.flatnonzero(rows.contact == number)
        own = own[[with_path(str(name)) for name in law[own]]]
        stated = stiffness_of(solution, number, rows[own])
        if stated is None:
            continue
        k, n = stated
        peak[own] = peak_force(rows.compression_work[own], k, n)
        k = np.broadcast_to(k, len(own))
        alone = (rows.together[own] == 1) & np.isfinite(mu[own] + e[own])
        for i, one in zip(own[alone].tolist(), k[alone].tolist()):
            W, u = np.array(rows[i].W) / arm[i] ** 2, np.array(rows[i].before) / arm[i]
            took[i] = _duration((W, u, float(mu[i]), float(e[i]), str(law[i])), (one, n))
    return peak, took


def stiffness_of(solution, number: int, rows) -> tuple[float | np.ndarray, float] | None:
    """Return the stated stiffness of a pair in its impacts (a number, or one for each), and its exponent.

    None where none is stated, or the shapes have no radius.
    """
    pairs, scene = solution.pairs, solution.scene
    if number >= len(pairs.body):
        stop = scene.stops[number - len(pairs.body)].stiffness
        return None if stop is None else stop._of(None)
    stiffness = pairs.laws[pairs.law[number]].stiffness
    plane, other = pairs.plane[number], pairs.other[number]
    partner = scene.fixed[plane] if plane >= 0 else scene.bodies[other]
    body = scene.bodies[pairs.body[number]]
    if not isinstance(stiffness, ABSOLUTE):
        return None
    curvature = curvature_of(body, partner)
    if isinstance(stiffness, Hertz) and stiffness.radius is None and not curvature:
        if not is_point_contact(body, partner):
            return None  # of two materials, on shapes that have no radius
        root = _roots_of_radii(solution, (body, partner), rows)
        return 4.0 / 3.0 * stiffness.modulus * root, HERTZ
    return stiffness._of(curvature)


def _roots_of_radii(solution, pair, rows) -> np.ndarray:
    """Return R^(1/2) F^(-3/2) of the point of each impact of a pair, by the curvatures of both shapes there."""
    from carom.impact.hertz import root_of_radius

    found, times = [], np.array(rows.time)
    Q = solution.evaluate(times, side="left")[1] if len(times) else np.zeros((0, 0, 4))
    for normal, turned in zip(np.array(rows.normal), Q):
        # tangents, and the sum of the curvatures of both along them
        across = np.linalg.svd(normal[None])[2][1:]
        total = np.zeros((2, 2))
        for part in pair:
            if not hasattr(part, "normal"):
                own = turned[part.index] if part in solution.scene.bodies else part.orientation
                R = quaternion.matrix(own)
                total += curvatures_of(part.shape, R.T @ across.T, R.T @ normal)
        low, high = np.linalg.eigvalsh(total)
        found.append(root_of_radius(float(high), float(low)))
    return np.array(found)


def _duration(stated: tuple, stiffness: tuple[float, float]) -> float:
    """Return the duration of a single impact [s], NaN where it cannot be followed once more.

    `stated` are W, the velocity before, friction, restitution and law.
    """
    from carom.impact.api import resolve_impact

    names = "inverse_mass", "relative_velocity_before", "friction"
    try:
        solved = resolve_impact(*stated)
        impulses = float(solved.compression_impulse[0]), float(solved.impulse[0])
        works = float(solved.compression_work), float(solved.restitution_work)
        return duration(dict(zip(names, stated)), impulses, works, *stiffness)
    except ValueError:
        return np.nan
