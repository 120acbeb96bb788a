"""Scratch for the closed points of one group of bodies, taken together: made once for a run."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.coulomb.layout import ConeWork, cone_arrays
from carom.impact.corner.layout import (
    CornerResult,
    CornerScratch,
    CornerSettings,
    corner_arrays,
    new_corner_result,
)
from carom.system.arrays import POINT, STATE, System, table

#: most points that are solved for together
MOST = 64

#: a closed point: what touches, and where it stands in the list of held points
SEAT = [
    ("contact", "i8"),
    ("feature", "i8"),
    ("held", "i8"),  # place among the held points, -1 where it is open
    ("stays", "i8"),  # 1 where it is to be held
    ("point", "f8", 3),  # of the core, body axes
]


class Cluster(NamedTuple):
    """K points at most, of N bodies. Vectors (3K,) and matrices (3K, 3K) have rows n, t1, t2 a point."""

    seats: np.recarray  # (K,) SEAT
    points: np.recarray  # (K,) POINT in the state at hand, or in the middle of a step
    ends: np.recarray  # (K,) POINT at the end of a step
    W: np.ndarray
    c: np.ndarray  # velocities, or accelerations, without the unknown impulses
    u: np.ndarray
    p: np.ndarray  # impulses, or forces
    old: np.ndarray  # p of the last round
    L: np.ndarray  # (3K, 3K) factor
    mu: np.ndarray  # (K,)
    e: np.ndarray  # (K,)
    law: np.ndarray  # (K,)
    kappa: np.ndarray  # (K,)
    kind: np.ndarray  # (K,) of `carom.coulomb`
    heading: np.ndarray  # (K, 2)
    rows: np.ndarray  # (K,) rows of each point that the return to the surface uses
    stopped: np.ndarray  # (K,) 1 where slip has stopped within the step
    member: np.ndarray  # (N,) bodies of the group
    flight: np.recarray  # (N,) STATE at the end of the step without the contacts
    rounds: np.ndarray  # (2,) rounds of steps, steps
    cone: ConeWork
    corner: CornerScratch
    settings: CornerSettings
    result: CornerResult


def new_cluster(system: System, settings: CornerSettings) -> Cluster:
    """Return the scratch for the largest group of `system`."""
    n, contacts = system.bodies.size, system.contacts
    count = np.zeros(n + 1, dtype=np.int64)
    np.add.at(count, system.bodies.component[contacts.body], contacts.last - contacts.first)
    k = MOST if np.any(contacts.other >= 0) else max(1, min(MOST, int(count.max())))
    return Cluster(
        seats=table(SEAT, k),
        points=table(POINT, k),
        ends=table(POINT, k),
        W=np.zeros((3 * k, 3 * k)),
        c=np.zeros(3 * k),
        u=np.zeros(3 * k),
        p=np.zeros(3 * k),
        old=np.zeros(3 * k),
        L=np.zeros((3 * k, 3 * k)),
        mu=np.zeros(k),
        e=np.zeros(k),
        law=np.zeros(k, dtype=np.int64),
        kappa=np.zeros(k),
        kind=np.zeros(k, dtype=np.int64),
        heading=np.zeros((k, 2)),
        rows=np.zeros(k, dtype=np.int64),
        stopped=np.zeros(k, dtype=np.int64),
        member=np.zeros(n, dtype=np.int64),
        flight=table(STATE, n),
        rounds=np.zeros(64, dtype=np.int64),
        cone=cone_arrays(k),
        corner=corner_arrays(k),
        settings=settings,
        result=new_corner_result(k),
    )
