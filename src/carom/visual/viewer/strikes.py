"""Impacts and persistent contacts for viewers: arrows in the world, and the course of each impact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.impact.api import with_path
from carom.results.joint_impulses import world_impulses

LISTED = 1000  # impacts in the list: the strongest
OPENED = 200  # impacts whose inside is kept: the strongest
SPLINE_STEPS = 24  # spline steps through a layer
MOST_ARROWS = 100_000  # arrows of persistent contacts, of all times together


class Strikes(NamedTuple):
    """The K' impacts that are shown, in the order of time."""

    number: np.ndarray  #: (K',) which of `Solution.impacts`
    arrow: np.ndarray  #: (K', 3) impulse on the body, world axes [N s]; 0 of stops
    contact: list[str]  #: (K',) names
    #: (K',) whether it is an impact at the stop of an angle, in [rad/s] and [N m s]
    turning: np.ndarray


class PersistentForces(NamedTuple):
    """Forces of persistent contacts at S times: time s has the rows from `first[s]` up to `first[s + 1]`."""

    time: np.ndarray  #: (S,) [s]
    first: np.ndarray  #: (S + 1,)
    point: np.ndarray  #: (M, 3) world [m]
    force: np.ndarray  #: (M, 3) on the body, world axes [N]


class Inside(NamedTuple):
    """One impact in the time of its layer, at I instants."""

    time: np.ndarray  #: (I,) since entry [s]
    velocity: np.ndarray  #: (I, 3) contact axes [m/s]
    force: np.ndarray  #: (I, 3) contact axes [N]
    phases: tuple[str, ...]


def strikes_of(solution, listed: int = LISTED) -> Strikes:
    """Return the impacts to show."""
    impacts, scene = solution.impacts, solution.scene
    chosen = np.sort(_strongest(impacts)[:listed])
    stops = len(solution.pairs.body)
    names = impacts.name[chosen].tolist()
    turning = [c >= stops and _turns(scene.stops[c - stops]) for c in impacts.contact[chosen]]
    arrow = world_impulses(solution)[chosen]
    return Strikes(chosen, arrow, names, np.array(turning, dtype=bool))


def persistent_forces(solution, times: np.ndarray, rows: int = MOST_ARROWS) -> PersistentForces:
    """Return the forces of persistent contacts at the saved times among `times`, or fewer of them."""
    table = solution.forces
    saved = np.unique(np.searchsorted(solution.t, times, side="right") - 1)
    first, last = (np.searchsorted(table.saved, saved, side=side) for side in ("left", "right"))
    every = max(1, -(-int(np.sum(last - first)) // rows))
    saved, first, last = saved[::every], first[::every], last[::every]
    chosen = np.concatenate([np.arange(a, b) for a, b in zip(first, last)] or [[]]).astype(int)
    starts = np.concatenate([[0], np.cumsum(last - first)])
    return PersistentForces(solution.t[saved], starts, table.point[chosen], table.vector[chosen])


def inside_of(solution, k: int) -> Inside | None:
    """Return the course of impact `k` in its layer; None if it is part of a multiple impact, or has none."""
    if solution.impacts.together[k] > 1 or not with_path(str(solution.impacts.law[k])):
        return None
    history = solution.impact_history(k, steps=SPLINE_STEPS)
    force = np.column_stack([history.normal_force, history.friction_force])
    return Inside(history.t, history.velocity, force, history.phases)


def insides_of(solution, strikes: Strikes, opened: int = OPENED) -> dict[int, Inside]:
    """Return the insides of the strongest impacts, by number."""
    chosen = _strongest(solution.impacts)[:opened]
    found = {int(k): inside_of(solution, int(k)) for k in np.intersect1d(chosen, strikes.number)}
    return {k: inside for k, inside in found.items() if inside is not None}


def _strongest(impacts) -> np.ndarray:
    return np.argsort(-np.linalg.norm(impacts.impulse, axis=1), kind="stable")


def _turns(stop) -> bool:
    return stop.turns
