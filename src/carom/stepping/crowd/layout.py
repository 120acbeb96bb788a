"""Workspace of a step of a crowd: made for the first step, and enlarged for a step with more points."""

from __future__ import annotations

from functools import cache, partial
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.friction import layout as friction
from carom.friction.graph import Graph, new_graph
from carom.model.arrays import STATE
from carom.model.memory import ACTIVE_POINT
from carom.model.workspace import POINT
from carom.stepping.crowd.mixing import Mixing, new_mixing

#: a point that may touch in the step
SPOT = [
    ("contact", "i8"),
    ("feature", "i8"),
    ("point", "f8", 3),  # point of the first body, in its axes
    ("motion", "i8"),  # as in its POINT
    ("parent", "i8"),  # for rolling and pivoting: the spot whose normal impulse bounds the torque
    ("place", "i8"),  # its place among the active points after the step, -1 if it is not active
    ("active", "i8"),  # its place among the active points before, -1 if it is not active
    ("gap", "f8"),  # gap at the start
    ("left", "f8"),  # gap at the end, without contacts
    ("before", "f8", 3),  # velocity at the start, with the rows of the middle of the step
    # its part from rows that turn, for an active point of several bodies; otherwise 0
    ("drift", "f8", 3),
    ("bound", "f8"),  # least normal velocity after the step
    ("after", "f8", 3),  # velocity with restitution
    ("impulse", "f8", 3),
    ("strikes", "i8"),  # 1 for an impact, 0 for a persistent or far point
]


MOST_TIED = 64  # bodies with joints in the elimination: with more there are only sweeps

#: initial room per body for points that may touch
SPOTS = 8


class Crowd(NamedTuple):
    """Up to K points of N bodies, and up to P active points. Vectors have rows n, t1, t2 for each point."""

    closed: np.recarray  # (K,) SPOT
    count: np.ndarray  # (1,) those in use, while they are listed
    points: np.recarray  # (2, K) POINT: in the middle of the step; at its end
    c: np.ndarray  # (3K,) velocities without impulses minus their bounds
    p: np.ndarray  # (3K,) impulses
    lift: np.ndarray  # (K,) scaled multipliers of the return to the surfaces
    bouncing: np.ndarray  # (3K,) impulses with full restitution
    problem: friction.ContactWork
    mixing: Mixing
    graph: Graph
    flight: np.recarray  # (N,) STATE at the end of the step without contacts
    flight_middle: np.recarray  # (N,) STATE halfway there, for loaded bodies
    middle: np.recarray  # (N,) STATE halfway on a path
    pose: (
        np.recarray
    )  # (N,) STATE halfway to the end without contacts, at which `points[0]` are placed
    pressed: np.recarray  # (N,) STATE at the end of the step, before bodies are moved apart
    active: np.recarray  # (P,) ACTIVE_POINT after the step
    follows: np.ndarray  # (P,) next active point of the same contact, -1 after the last
    parent: np.ndarray  # (N,) in the union-find of bodies in contact
    speed: np.ndarray  # (2, N) greatest speed in such a set, at the start and at the end


def new_crowd(bodies: int, active: int, points: int, joined: int = 0) -> Crowd:
    """Return the workspace for `points` points that may touch, and `active` active points.

    Each impulse on one of the `joined` bodies, which have joints, may move all others of them.
    """
    # 500 spheres in a box need half of this; if it is not enough, there are only sweeps
    tied = min(joined, MOST_TIED)
    pairs, updates = 4 * points + tied * tied, 128 * points + tied**3
    others = points * max(0, joined - 1)
    whole = partial(np.zeros, dtype=np.int64)
    problem = friction.with_bodies(friction.new_contact_work(0), points, bodies, (pairs, updates))
    problem = problem._replace(
        kind=friction.BY_BODIES, contact=table(friction.CONTACT, points), path=table(friction.PATH, points),
        other=table(friction.OTHER, others), vector=np.zeros((friction.VECTORS, 3 * points)),
    )  # fmt: skip
    graph = new_graph(bodies, points, others)
    flight, flight_middle, middle, pose, pressed = table(STATE, 5, bodies)
    return Crowd(
        closed=table(SPOT, points), count=whole(1), points=table(POINT, 2, points),
        c=np.zeros(3 * points),
        p=np.zeros(3 * points), lift=np.zeros(points), bouncing=np.zeros(3 * points),
        problem=problem, mixing=new_mixing(points), graph=graph, flight=flight,
        flight_middle=flight_middle, middle=middle, pose=pose, pressed=pressed,
        active=table(ACTIVE_POINT, active), follows=whole(active), parent=whole(bodies),
        speed=np.zeros((2, bodies)),
    )  # fmt: skip


@cache
def no_crowd() -> Crowd:
    """Return the workspace of a run without a crowd: nothing is written to it."""
    return new_crowd(1, 1, 1)  # fewer spots than `SPOTS`


def roomier_crowd(crowd: Crowd) -> Crowd:
    """Return the workspace for twice as many points."""
    points = len(crowd.closed)
    joined = 1 + len(crowd.problem.other) // points
    return new_crowd(len(crowd.flight), len(crowd.active), 2 * points, joined)
