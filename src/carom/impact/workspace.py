"""Workspace for the closed points of one group of bodies, made once for a run."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.friction.graph import Graph, new_graph
from carom.friction.layout import ContactProblem, ContactWork, new_contact_work, with_bodies
from carom.impact.multiple.layout import (
    CORNER_CONTACT,
    MultipleResult,
    MultipleSettings,
    new_multiple_result,
)
from carom.impact.multiple.workspace import MultipleWorkspace, new_multiple_workspace
from carom.model.arrays import STATE, System
from carom.model.contact_kinds import is_found, most_points
from carom.model.laws import PERSISTENT, law_of
from carom.model.workspace import POINT

#: greatest number of points of a group: with full matrices, and so that they are solved by bodies
MOST_DENSE, MOST_TOGETHER = 192, 2048
#: points of a body for which there is room in a large group: a brick in a wall has sixteen
POINTS_OF_BODY = 16
#: least number of points of a group that may be solved by its bodies
LEAST_POINTS = 24

#: a closed point: its contact, and its place in the list of active points
CLOSED_POINT = [
    ("contact", "i8"),
    ("feature", "i8"),
    ("active", "i8"),  # its place among the active points, -1 if it is not active
    ("stays", "i8"),  # 1 if its contact is to persist
    ("bounces", "f8"),  # time that its bounces would still take
    ("point", "f8", 3),  # point of the core, body axes
    ("rows", "i8"),  # number of rows that the return to the surface uses
    ("passes", "i8"),  # 1 if it has passed its stop in a stage, and keeps its friction (`stops`)
    # 1 if the active points have one of its place, 0 if `active` is another one of its pair
    ("listed", "i8"),
    ("presses", "i8"),  # 1 if it presses: its spring carries
    ("patch", "i8"),  # the first point of its patch
    ("weight", "f8"),  # stiffness of its spring, as a part of that of its patch
    ("spring", "f8"),  # compliance of its spring [1/kg]
    ("stick", "f8"),  # compliance of its stick before loads are known [1/kg]
    ("hold", "f8"),  # compliance of its stick [1/kg]
    # as in its POINT; MOTION_JOINT for all friction in joints, with `active` as its number
    ("motion", "i8"),
    # the entry whose normal force bounds its friction: of a torque its point, of a point itself; or CONSTANT
    ("parent", "i8"),
    ("pull", "f8"),  # its part of an adhesion [N]
    # of friction in a joint by load: number of the load, -1 for none; its value, and the coefficient
    ("load", "i8"),
    ("bears", "f8"),
    ("coefficient", "f8"),
]


#: what a force along a row does to its two bodies, and its equation (`carom.persistent.by_bodies`): `rate`
#: times the rates of its row and of the other of its disc, + `own` times their forces, + `bound` times that of
#: its leader. With a factor it is `inverse` times what is asked, + `follow` times its leader, - `lead`
ARM = [
    ("body", "i8", 2),  # their places in the group, -1 for none
    ("other", "i8"),  # the other row of its disc, or its own
    ("leader", "i8"),  # the row of the normal force that bounds it, or its own
    ("row", "f8", (2, 6)),
    ("motion", "f8", (2, 6)),  # by a unit force
    ("push", "f8", (2, 6)),  # of an unknown: by a unit force with what follows it
    ("lead", "f8", (2, 6)),
    ("rate", "f8", 2),
    ("own", "f8", 2),
    ("bound", "f8"),
    ("inverse", "f8", 2),
    ("follow", "f8"),
    ("force", "f8"),  # of a product or a solution
    ("alone", "f8"),  # that force without what follows its leader
    ("gives", "f8"),  # its rate in a product, or what is asked of it
]


class Equations(NamedTuple):
    """A linear system A x = r for the forces or impulses in some rows of the points of a group."""

    rows: np.ndarray  # (3K,) the row of each unknown
    chosen: np.ndarray  # (3K,) rows of those that are shared (`carom.persistent.sharing`)
    A: np.ndarray  # (3D, 3D)
    factor: np.ndarray  # (3D, 3D) of A, or of A and a compliance
    pivot: np.ndarray  # (3K,) rows exchanged in the factor
    x: np.ndarray  # (3K,)
    r: np.ndarray  # (3K,) right-hand side, then the error that x leaves
    before: np.ndarray  # (3K,) the unknowns before an iteration of Newton's method
    directions: np.ndarray  # (3D, 3K) corrections z of x, each before A z (`persistent.settle`)
    part: np.ndarray  # (3K,) the part of the correction by r in each of them
    arms: np.recarray  # (3K,) ARM
    tree: ContactWork  # factors of the motion of bodies: its links, bodies and blocks
    graph: Graph  # of these bodies
    bodies: np.ndarray  # (1,) their number, if equations are solved by bodies; 0 if W is known
    #: (2,) those of stages that fail in a closing step, and for impulses instead; work of factors (`springs`)
    iterations: np.ndarray


class Bodies(NamedTuple):
    """The bodies of a group."""

    member: np.ndarray  # (N,)
    place: np.ndarray  # (N,) place of a member among them
    base: np.recarray  # (N,) STATE of an implicit stage, without its own term
    free: np.recarray  # (N,) STATE with velocities of a stage without forces of points


class Group(NamedTuple):
    """The closed points of a group, up to K, with its bodies, contact problem and equations.

    Full matrices have room for D of these points; more are solved by bodies (`carom.persistent.by_bodies`).

    Vectors (3K,) have rows n, t1, t2 for each point.
    """

    closed: np.recarray  # (K,) CLOSED_POINT
    #: (4,) those that `contact.closed_points` has listed; those that found no room in a step; and between which
    #: numbers the active points of the group are (`persistent.points`)
    count: np.ndarray
    points: np.recarray  # (2, K) POINT: of the present state; of the end of a step
    own: np.ndarray  # (3K, 3) the part of W in each row that is of its own point
    u: np.ndarray  # (3K,) velocities [m/s]
    p: np.ndarray  # (3K,) impulses [N s] or forces [N]
    a: np.ndarray  # (3K,) accelerations with them [m/s^2]
    back: np.ndarray  # (3K,) errors of positions [m] or velocities, then impulses that remove them
    idle: np.ndarray  # (2, D, D) the projector to normal forces that move nothing, and its square
    #: (L, 1 + 3K, 9) vectors of loads: constant, and by unit forces (`persistent.joint_load`)
    loads: np.ndarray
    vectors: np.ndarray  # (9,) those of a load under all forces
    #: (5 + L, L) errors of loads, their last step, and the inverse of their derivative
    secant: np.ndarray
    bodies: Bodies
    equations: Equations
    problem: ContactProblem  # its W, c, mu, kind and heading; c are velocities or accelerations without p
    cone: ContactWork


class MultipleImpact(NamedTuple):
    """Workspace, settings and result of a multiple impact of up to K points."""

    workspace: MultipleWorkspace
    settings: MultipleSettings
    result: MultipleResult
    contact: np.recarray  # (K,) CORNER_CONTACT
    hertz: np.ndarray  # (K,) of a ball or an ellipsoid its stiffness by Hertz's law, else 0


def capacity(system: System, more: bool) -> int:
    """Return the greatest number of closed points in one group; with `more` contacts may be added."""
    most = min(MOST_TOGETHER, max(MOST_DENSE, POINTS_OF_BODY * system.bodies.size))
    if more:
        return most
    contacts, more_rows = system.contacts, len(system.relations.frictions)
    points = most_points(contacts)
    component = system.bodies["component"]
    between = (contacts["other"] >= 0) & (
        component[contacts["body"]] != component[contacts["other"]]
    )
    rows = 1 + (law_of(system, contacts, PERSISTENT)["turning"] > 0.0).sum(axis=1)
    if is_found(contacts).any() or between.any():
        return max(1, min(most, int((rows * points).sum()) + more_rows))
    count = np.bincount(component[contacts["body"]], rows * points)
    return max(1, min(most, int(count.max(initial=0.0)) + more_rows))


def new_group(system: System, more: bool = False) -> Group:
    """Return the workspace for the largest group of `system`; with `more` contacts may be added."""
    n, k = system.bodies.size, capacity(system, more)
    dense = min(k, MOST_DENSE)
    u, p, a, back = np.zeros((4, 3 * k))
    problem = ContactProblem(
        W=np.zeros((3 * dense, 3 * dense)), c=np.zeros(3 * k), mu=np.zeros(k), kind=np.zeros(k, dtype=np.int64),
        heading=np.zeros((k, 2)),
    )  # fmt: skip
    by_load = int((system.relations.frictions["load"] >= 0).sum())
    loads, secant = np.zeros((by_load, 1 + 3 * k, 9)), np.zeros((5 + by_load, by_load))
    bodies = Bodies(
        member=np.zeros(n, dtype=np.int64), place=np.zeros(n, dtype=np.int64),
        base=table(STATE, n), free=table(STATE, n),
    )  # fmt: skip
    return Group(
        closed=table(CLOSED_POINT, k), count=np.zeros(4, dtype=np.int64), points=table(POINT, 2, k),
        own=np.zeros((3 * k, 3)), u=u, p=p, a=a, back=back, idle=np.zeros((2, dense, dense)), loads=loads,
        vectors=np.zeros(9), secant=secant, bodies=bodies,
        equations=new_equations(k, n), problem=problem, cone=new_contact_work(dense),
    )  # fmt: skip


def new_equations(points: int, bodies: int) -> Equations:
    """Return a system for points of some bodies; its three matrices take .8 MB for 60 points."""
    n, large = 3 * points, points >= LEAST_POINTS
    rows, chosen, pivot = (np.zeros(n, dtype=np.int64) for _ in range(3))
    dense = min(n, 3 * MOST_DENSE)
    A, factor = (np.zeros((dense, dense)) for _ in range(2))
    directions = np.zeros((dense, n))
    x, r, before, part = (np.zeros(n) for _ in range(4))
    tree, graph = new_tree(points if large else 0, bodies if large else 0)
    return Equations(
        rows=rows, chosen=chosen, A=A, factor=factor, pivot=pivot, x=x, r=r, before=before,
        directions=directions, part=part, arms=table(ARM, n), tree=tree, graph=graph,
        bodies=np.zeros(1, dtype=np.int64), iterations=np.zeros(2, dtype=np.int64),
    )  # fmt: skip


def new_tree(points: int, bodies: int) -> tuple[ContactWork, Graph]:
    """Return the blocks of bodies and their graph; without room for them a group has full matrices."""
    if points == 0:
        return no_tree()
    room = 4 * points, 128 * points
    return with_bodies(new_contact_work(1), points, bodies, room), new_graph(bodies, points, 0)


@cache
def no_tree() -> tuple[ContactWork, Graph]:
    """Return the same for a group of a few points: nothing is written to it."""
    return with_bodies(new_contact_work(1), 0, 0, (0, 0)), new_graph(0, 0, 0)


@cache
def no_multiple(settings: MultipleSettings) -> MultipleImpact:
    """Return the workspace of a run before its first impact of several points: nothing is written to it."""
    return new_multiple(1, settings)


def new_multiple(k: int, settings: MultipleSettings) -> MultipleImpact:
    """Return the workspace of impacts of `k` points."""
    return MultipleImpact(
        workspace=new_multiple_workspace(k), settings=settings, result=new_multiple_result(k),
        contact=table(CORNER_CONTACT, k), hertz=np.zeros(k),
    )  # fmt: skip
