"""The forces of a multiple impact in time, for stated stiffnesses of its contacts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom import checks
from carom.impact.force import force_at
from carom.impact.thresholds import COURSE_ERROR, FIRST_FORCE
from carom.scene.stiffness import ABSOLUTE, Stiffness


@dataclass(frozen=True, eq=False)
class ImpactForces:
    """The forces of k contacts in an impact over time. Vectors in contact axes: normal, tangent 1, tangent 2.

    Parameters
    ----------
    t : ndarray, shape (T,)
        Times since the first touch [s].
    normal_force, friction_force : ndarray, shapes (T, k) and (T, k, 2)
        Forces [N]. Where contacts are redundant (a face), the shares of friction are not determined, but their
        sums.
    depth : ndarray, shape (T, k)
        Depths of the contacts [m]; below 0 where they are apart.
    velocity, impulse : ndarray, shape (T, k, 3)
        Relative velocities [m/s], and impulses so far [N s].
    peak_force : ndarray, shape (k,)
        Greatest normal force of each contact [N].
    contact_time : ndarray, shape (k, 2)
        First and last time at which each contact has a thousandth of its greatest force [s]; NaN where it has
        none.
    duration : float
        Time from the first touch to the end of all forces [s].
    impacts : tuple of int
        Of a run the indices of the contacts in `Solution.impacts`, else empty.
    """

    t: np.ndarray
    normal_force: np.ndarray
    friction_force: np.ndarray
    depth: np.ndarray
    velocity: np.ndarray
    impulse: np.ndarray
    peak_force: np.ndarray
    contact_time: np.ndarray
    duration: float
    impacts: tuple[int, ...] = ()

    def evaluate(self, t) -> np.ndarray:
        """Return the normal forces (..., k) at times within the impact, and 0 before and after it.

        Parameters
        ----------
        t : array_like
            Times since the first touch [s].
        """
        times = checks.real_array("t", t, "(...,)")
        found = force_at(times, self.t, self.impulse[..., 0], self.normal_force)
        inside = (times >= 0.0) & (times <= self.duration)
        return np.where(inside[..., None], np.maximum(found, 0.0), 0.0)


def stated_stiffness(name: str, given, k: int) -> tuple[np.ndarray, float] | None:
    """Return stiffnesses (k,) in newton and their exponent; None if those given are relative numbers."""
    several = given if isinstance(given, (list, tuple)) else [given] * k
    if not any(isinstance(one, ABSOLUTE) for one in several):
        return None
    if len(several) != k or not all(isinstance(one, ABSOLUTE) for one in several):
        raise ValueError(
            f"{name} must be numbers, or one Stiffness or Hertz, or {k} of them, got {checks.shown(given)}"
        )
    laws = [one._of(None) for one in several]
    if len({n for _, n in laws}) > 1:
        raise ValueError(
            f"{name} must have one exponent, because contacts that strike together share it, got "
            f"{checks.shown([n for _, n in laws])}"
        )
    return np.array([k for k, _ in laws]), laws[0][1]


def forces_in_time(stated: dict[str, Any], solved, stiffness: tuple[np.ndarray, float]):
    """Return the forces of a solved impact.

    Parameters
    ----------
    stated : what was given: W, velocity, laws, settings
    solved : CornerImpact
    stiffness : [N/m^p] of each contact, and the exponent p
    """
    from carom.impact.multiple.trace import CONTACT_COLUMNS, course

    W, u, laws, settings = (stated[name] for name in ("W", "velocity", "laws", "settings"))
    k, (stiff, p) = len(u), stiffness
    if solved.at_once or solved.plastic_change != 0.0 or not stated["course"]:
        raise ValueError(
            "the impact must have a course in time: one contact problem, a plastic event, and blows one after "
            "another have none"
        )
    same = np.ptp(stiff / stated["kappa"]) <= COURSE_ERROR * np.max(stiff / stated["kappa"])
    if not same or settings.exponent != p:
        raise ValueError(
            "stiffness must have the exponent and the ratios with which the impact was solved: give it to "
            "resolve_impacts"
        )
    took, gave = -solved.compression_work, solved.restitution_work
    e = np.sqrt(np.divide(gave, took, out=np.zeros(k), where=took > 0.0))
    rows = course(W, u, (laws, laws.table["friction"].copy()), e, stiff, settings)
    off = math.inf
    if rows is not None:
        last = rows[-1, 1:].reshape(k, CONTACT_COLUMNS)
        off = max(
            np.abs(solved.impulse - last[:, 7:10])[:, 0].max() / solved.impulse[:, 0].max(),
            np.abs(solved.velocity_after - last[:, 4:7]).max() / np.abs(u).max(),
        )
    if rows is None or not off <= COURSE_ERROR:
        raise ValueError(
            "the course of the impact could not be followed once more, so its forces are not known"
        )
    return made(rows, k)


def made(rows: np.ndarray, k: int, impacts: tuple[int, ...] = ()) -> ImpactForces:
    """Return the forces of k contacts, from the rows of their course."""
    from carom.impact.multiple.trace import CONTACT_COLUMNS

    keep = np.append(np.diff(rows[:, 0]) > 0.0, True)  # of several states at one time, the last
    t, state = rows[keep, 0], rows[keep, 1:].reshape(-1, k, CONTACT_COLUMNS)
    N = state[..., 0]
    spans = np.full((k, 2), np.nan)
    for i in range(k):
        presses = np.flatnonzero(N[:, i] > FIRST_FORCE * N[:, i].max())
        if len(presses):
            spans[i] = t[presses[[0, -1]]]
    return ImpactForces(
        t=t, normal_force=N, friction_force=state[..., 1:3], depth=state[..., 3],
        velocity=state[..., 4:7], impulse=state[..., 7:10], peak_force=N.max(axis=0), contact_time=spans,
        duration=float(t[-1]), impacts=impacts,
    )  # fmt: skip


def of_corner(solved, stiffness: Stiffness | None) -> ImpactForces:
    """Return the forces of a `CornerImpact`."""
    stated = solved._stated
    given = stated["stiffness"] if stiffness is None else stiffness
    absolute = None if given is None else stated_stiffness("stiffness", given, len(solved.impulse))
    if absolute is None:
        raise TypeError(
            "stiffness must be a Stiffness or a Hertz, or one for each contact, got "
            f"{checks.shown(given)}"
        )
    return forces_in_time(stated, solved, absolute)
