"""Workspace of a step of a crowd: made for the first one, and made larger for one with more points."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.friction.layout import (
    BY_BODIES,
    CONTACT,
    ISLAND_BODY,
    LINK,
    OTHER,
    PLACE,
    VECTORS,
    ContactWork,
    new_contact_work,
)
from carom.model.arrays import STATE
from carom.model.workspace import ACTIVE_POINT, POINT
from carom.stepping.crowd.graph import WORD
from carom.stepping.crowd.mixing import Mixing, new_mixing

#: a point that may touch in the step
SPOT = [
    ("contact", "i8"),
    ("feature", "i8"),
    ("point", "f8", 3),  # of the first body, its axes
    ("turns", "i8"),  # of its POINT
    ("parent", "i8"),  # of rolling and pivoting: the spot whose normal impulse bounds the torque
    ("place", "i8"),  # among the active points after the step, -1 where it is none
    ("active", "i8"),  # its place among the active points, -1 where it is open
    ("gap", "f8"),  # at the start
    ("left", "f8"),  # at the end, without contacts
    ("before", "f8", 3),  # velocity at the start, by the rows of the middle of the step
    (
        "drift",
        "f8",
        3,
    ),  # the part of it that is due to rows that turn, of an active point of several bodies; else 0
    ("bound", "f8"),  # least normal velocity after
    ("after", "f8", 3),  # velocity with restitution
    ("impulse", "f8", 3),
    ("strikes", "i8"),  # 1 for an impact, 0 for what stays, or is far
]


class Graph(NamedTuple):
    """What finding an order of elimination needs (`carom.stepping.crowd.graph`)."""

    count: np.ndarray  # (4,) bodies, points, updates (-1: no room), pairs
    body: np.ndarray  # (K, 3) bodies of each point, and the last of its others
    other: np.ndarray  # (R,) bodies that impulses move by way of joints
    near: np.ndarray  # (N, words) neighbours, a bit each
    degree: np.ndarray  # (N,) how many, -1 once eliminated
    rank: np.ndarray  # (N,) place in the order


MOST_TIED = 64  # bodies with joints that are eliminated: of more there are sweeps only

#: of a body, to begin with: points that may touch
SPOTS = 8


class Crowd(NamedTuple):
    """K points at most, of N bodies; P points are held at most. Vectors have rows n, t1, t2 a point."""

    spots: np.recarray  # (K,) SPOT
    points: np.recarray  # (2, K) POINT: in the middle of the step; at its end
    c: np.ndarray  # (3K,) velocities without impulses, less their bounds
    p: np.ndarray  # (3K,) impulses
    lift: np.ndarray  # (K,) scaled multipliers of the way back to the surfaces
    bouncing: np.ndarray  # (3K,) impulses with all of their restitution
    problem: ContactWork
    mixing: Mixing
    graph: Graph
    flight: np.recarray  # (N,) STATE at the end of the step without contacts
    active: np.recarray  # (P,) ACTIVE_POINT, as it will be
    follows: np.ndarray  # (P,) next active point of the same contact, -1 after the last
    parent: np.ndarray  # (N,) of the union-find of what touches
    speed: np.ndarray  # (2, N) greatest speed of such a set, at the start and at the end


def new_crowd(bodies: int, active: int, points: int, joined: int = 0) -> Crowd:
    """Return the workspace for `points` points that may touch, and `active` that may be held.

    Each impulse on one of the `joined` bodies, those with joints, may move all others of them.
    """
    # what 500 spheres in a box need is half of this; where it is not enough there are sweeps only
    tied = min(joined, MOST_TIED)
    pairs, updates = 4 * points + tied * tied, 128 * points + tied**3
    others = points * max(0, joined - 1)
    problem = new_contact_work(0)._replace(
        kind=BY_BODIES,
        contact=table(CONTACT, points),
        link=table(LINK, points),
        other=table(OTHER, others),
        vector=np.zeros((VECTORS, 3 * points)),
        body=table(ISLAND_BODY, bodies),
        place=table(PLACE, bodies),
        later=np.zeros(pairs, dtype=np.int64),
        target=np.zeros((updates, 3), dtype=np.int64),
        block=np.zeros((bodies + 2 * pairs, 6, 6)),
    )
    return Crowd(
        spots=table(SPOT, points),
        points=table(POINT, 2, points),
        c=np.zeros(3 * points),
        p=np.zeros(3 * points),
        lift=np.zeros(points),
        bouncing=np.zeros(3 * points),
        problem=problem,
        mixing=new_mixing(points),
        graph=Graph(
            count=np.zeros(4, dtype=np.int64),
            body=np.zeros((points, 3), dtype=np.int64),
            other=np.zeros(others, dtype=np.int64),
            near=np.zeros((bodies, bodies // WORD + 1), dtype=np.int64),
            degree=np.zeros(bodies, dtype=np.int64),
            rank=np.zeros(bodies, dtype=np.int64),
        ),
        flight=table(STATE, bodies),
        active=table(ACTIVE_POINT, active),
        follows=np.zeros(active, dtype=np.int64),
        parent=np.zeros(bodies, dtype=np.int64),
        speed=np.zeros((2, bodies)),
    )


@cache
def no_crowd() -> Crowd:
    """Return the workspace of a run without a crowd: nothing is written to it."""
    return new_crowd(1, 1, 1)  # fewer spots than `SPOTS`


def roomier_crowd(crowd: Crowd) -> Crowd:
    """Return the workspace for twice as many points, with what is compiled for it."""
    points = len(crowd.spots)
    joined = 1 + len(crowd.problem.other) // points
    return new_crowd(len(crowd.flight), len(crowd.active), 2 * points, joined)
