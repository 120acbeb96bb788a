"""A compiled scene, and what a run writes to: one structured array for each noun.

N bodies, J joints, C contacts. Index -1 stands for the ground. Kernels read ``bodies[b].mass``; Python
sees the same arrays as columns, ``bodies.mass``.

Records, not a tuple of one array per field: Numba hands each array to each function as seven values
and types and optimises all of them again at every level of the call tree. (Measured: 110 arrays took 125 s
to compile and 8.5 microseconds a step; docs/development/decisions.md.)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.contact.pairs.layout import Hulls, NoHulls, PairWork

#: kinds of joints in kernels
SPHERICAL, REVOLUTE, FIXED, PRISMATIC, DISTANCE, KNIFE_EDGE = range(6)
CYLINDRICAL, UNIVERSAL, PLANAR, POINT_ON_LINE, POINT_ON_PLANE, SCREW = range(6, 12)
#: numbers of constraint rows, by kind
ROWS = (3, 5, 6, 5, 1, 1, 4, 4, 3, 2, 1, 5)
#: the child's anchor moves along the first direction of the parent's frame
ALONG = (PRISMATIC, CYLINDRICAL, POINT_ON_LINE, SCREW)
#: it moves in the plane across it
WITHIN = (PLANAR, POINT_ON_PLANE)
SLIDING = ALONG + WITHIN
#: the child turns about the first direction alone
TURNING = (REVOLUTE, CYLINDRICAL, PLANAR, SCREW)
#: it turns freely
BALL = (SPHERICAL, POINT_ON_LINE, POINT_ON_PLANE)
#: it does not turn
RIGID = (FIXED, PRISMATIC)

#: absolute coordinates, world axes; Q takes principal axes of inertia to the world
STATE = [("x", "f8", 3), ("Q", "f8", 4), ("v", "f8", 3), ("w", "f8", 3)]

BODY = [
    ("mass", "f8"),
    ("inertia", "f8", 3),  # principal moments
    ("extent", "f8"),  # a length of the body: its shape, or the arms of its joints
    ("isotropic", "i8"),  # 1 where the three moments are equal
    ("isolated", "i8"),  # 1 where no joint acts
    ("ballistic", "i8"),  # 1 where no joint and no force but gravity acts
    ("component", "i8"),  # its own number, or N for all that have joints
    ("number", "i8"),  # among all bodies of the scene
    ("ball", "f8"),  # radius of the ball around its centre that holds its shapes
]

JOINT = [
    ("kind", "i8"),
    ("parent", "i8"),
    ("child", "i8"),
    ("rows", "i8"),  # number of constraint rows
    ("parent_anchor", "f8", 3),  # in the parent's axes, from its centre
    ("child_anchor", "f8", 3),
    ("parent_frame", "f8", (3, 3)),  # columns: axis, second, third direction, in the parent's axes
    ("child_frame", "f8", (3, 3)),
    ("length", "f8"),  # of a distance; way of a screw, a radian
]

SPRING = [
    ("parent", "i8"),
    ("child", "i8"),
    ("parent_anchor", "f8", 3),
    ("child_anchor", "f8", 3),
    ("stiffness", "f8"),
    ("damping", "f8"),
    ("rest_length", "f8"),
]

#: a force and torque on a point of a body, constant in the axes of a body or of the world
LOAD = [
    ("body", "i8"),
    ("frame", "i8"),  # the body whose axes the vectors are in, -1 for the world
    ("anchor", "f8", 3),
    ("force", "f8", 3),
    ("torque", "f8", 3),
]

#: an elastic mount: springs and dampers along and about three axes of the parent
BUSHING = [
    ("parent", "i8"),
    ("child", "i8"),
    ("parent_anchor", "f8", 3),
    ("child_anchor", "f8", 3),
    ("parent_frame", "f8", 4),  # from the axes of the mount to those of the body
    ("child_frame", "f8", 4),
    ("stiffness", "f8", 3),
    ("damping", "f8", 3),
    ("turn_stiffness", "f8", 3),
    ("turn_damping", "f8", 3),
]

#: hull of vertices, swollen by a radius, against a half-space; or two solids, the other perhaps a half-space
CONTACT = [
    ("number", "i8"),  # among all contacts of the scene
    ("body", "i8"),
    ("other", "i8"),  # -1 for a half-space
    (
        "touches",
        "i8",
    ),  # 1 where the kernels of pairs find the points, 0 where they are the vertices
    ("part", "i8"),  # 1 where a body has several pieces
    ("first", "i8"),  # range of the vertices of the body
    ("last", "i8"),
    ("other_first", "i8"),  # of the other body
    ("other_last", "i8"),
    ("solid", "i8"),  # where the kernels of pairs find the points: the two solids
    ("other_solid", "i8"),
    ("law", "i8"),  # 0 newton, 1 poisson, 2 stronge
    ("axes", "f8", (3, 3)),  # of a half-space: rows n, t1, t2
    ("offset", "f8"),  # n . point of the plane
    ("radius", "f8"),  # of both, where they are two solids
    ("friction", "f8"),
    ("friction_held", "f8"),
    ("turning", "f8", 2),  # rolling and pivoting friction [m]
    ("restitution", "f8"),
    ("stiffness", "f8"),  # of its boundary layer, relative to the others
    ("extent", "f8"),  # largest distance of the shape from the mass centre
    ("other_extent", "f8"),
    ("core", "f8"),  # largest distance of a core point, without the ball that swells it
    ("still", "f8"),  # speed that is round-off of what gravity gives over the body's size
    ("width", "f8"),  # b of the boundary layer
    ("penetration", "f8"),  # delta
]

#: place of a body in a forest of joints
LINK = [
    ("order", "i8"),  # the body at this place of the walk, parents before children
    ("joint", "i8"),  # joint that carries the body, -1 where it floats
    ("parent", "i8"),  # parent body, -1 where that is the ground or none
    ("freedoms", "i8"),  # of the joint; 6 for a floating body
    ("has_child", "i8"),
]

#: what the solve for closed loops writes, for each joint
ROW = [
    ("A", "f8", (2, 6, 6)),  # rows, sides child and parent
    ("Y", "f8", (2, 6, 6)),  # rows times M^-1
    ("pivot", "f8", 6),  # reciprocal pivots, 0 = dropped
    ("weight", "f8", 6),  # diagonal of A M^-1 A^T before elimination
    ("rhs", "f8", 6),  # right-hand side, then multipliers
]

#: a contact between looks
BRINK = [
    ("seen", "i8"),  # scratch: while a group is gathered; 1 + first held point, in a heap
    ("near", "i8"),  # 1 where something happened at the last event: look before stepping
    ("jams", "i8"),  # 1 where a held point of it jams: an impact without collision is due
    ("leaving", "i8"),  # 1 where the body lifts off without speed: it may touch at the start
    ("blows", "i8"),  # impacts in this step
    ("step", "i8"),  # the last in which the two were near each other, plus 1
]

#: a point that is held, over time (see `carom.hold`)
HELD = [
    ("contact", "i8"),
    ("feature", "i8"),  # what touches, the same as long as it does: number of the vertex
    ("body", "i8"),  # of the contact
    ("other", "i8"),
    ("touches", "i8"),
    ("mode", "i8"),  # 0 open, 1 slipping, 2 sticking
    ("next", "i8"),  # mode after the step on trial
    ("settles", "i8"),  # 1 where that step puts the body to rest
    ("several", "i8"),  # 1 where it shares its bodies with other held points
    ("rest", "i8"),  # 1 where the body does not move at all
    ("jams", "i8"),  # 1 where it slips and no finite force keeps it closed
    ("point", "f8", 3),  # point of the core that carries the contact, body axes
    ("anchor", "f8", 3),  # where it is in the world since it sticks
    ("force", "f8", 3),  # of the last solve, contact axes
    ("heading", "f8", 2),  # direction of slip at the start of the step, or in which it starts
    ("speed", "f8"),  # of slip at the start of the step
    ("stop", "f8"),  # time in which slip will stop under the last forces, where several are held
    ("lift", "f8"),  # of one of several: how far from opening at the end of a step, below 0: open
    ("grip", "f8"),  # the same of slip
    ("due", "i8"),  # 1 where the event that is looked for may be its own too
    ("turn_stop", "f8", 2),  # the same of rolling and of pivoting
    ("torque", "f8", 3),  # of rolling and pivoting friction, contact axes
    ("W", "f8", (3, 3)),  # effective inverse mass of the last solve
]

#: a point of contact as it is in one state
POINT = [
    ("a", "i8"),  # body on the side that the normal points to
    ("b", "i8"),  # the other, -1 for the ground
    ("arm_a", "f8", 3),  # from the mass centre, world axes
    ("arm_b", "f8", 3),
    (
        "core",
        "f8",
        3,
    ),  # from the mass centre of a: the part of the arm that turns with it; 0 if it rolls on
    ("axes", "f8", (3, 3)),  # rows n, t1, t2
    ("gap", "f8"),
    ("turns", "i8"),  # 0; or its rows are of relative rotation: 1 rolling (t1, t2), 2 pivoting (t1)
    ("length", "f8"),  # that makes a speed of an angular velocity
]

BODY_WORK = [
    ("wrench", "f8", 6),  # what a solve takes: force and torque, or impulse
    ("motion", "f8", 6),  # what a solve gives: linear, angular
    ("bound", "f8", 3),  # greatest linear, angular acceleration and spin of the last step
    ("miss", "f8", 3),  # two estimates of the error of a step [m], and what they are measured by
    ("inverse", "f8", 6),  # inverse inertia, world axes
    ("group", "i8"),  # bodies with the same number move each other: joined, or held to each other
    ("holds", "i8"),  # of the body that its group is named after: held points of the group
    ("status", "i8"),  # FREE, ONE, RESTS or SEVERAL held points
    ("push", "f8", 6),  # change of momentum (linear, angular about the centre) in a step
    ("spin", "f8", 3),  # angular velocity for which the invariants of free flight below hold
    ("momentum", "f8", 3),  # spatial angular momentum
    ("energy", "f8"),  # twice the energy of rotation
    ("whole_until", "i8"),  # steps up to this are taken whole
    ("whole_for", "i8"),  # for so many steps, when that was last found
    ("home", "f8", 3),  # centre at the start of the step
    ("room", "f8"),  # how far from it the centre may go in this step
]

JOINT_WORK = [
    ("bias", "f8", 6),  # relative motion that a solve shall give: angular, linear
    ("reaction", "f8", 6),  # wrench on the child at its anchor: force, torque
    ("multiplier", "f8", 6),  # impulses of the rows in the three-field step
    ("target", "f8", 6),
]

#: one stage of a Runge-Kutta step, for one body
STAGE = [("speed", "f8", 6), ("rate", "f8", 6), ("attitude", "f8", 4)]

#: what a step of joined, loaded or held bodies gives back
RESULT = [
    ("applied", "f8"),
    ("friction", "f8"),
    ("code", "i8"),
    ("power", "f8"),  # of loads, and of friction, with the last accelerations
    ("drag", "f8"),
    ("residual", "f8"),  # greatest of the groups held at several points
    ("fallen", "i8"),  # steps of a symplectic method that the explicit one has taken
]

#: search for an event inside a step
SEARCH = [
    ("active", "i8"),
    ("kind", "i8"),
    ("contact", "i8"),
    ("side", "i8"),  # which end of the bracket moved last
    ("low", "f8"),
    ("high", "f8"),
    ("f_low", "f8"),
    ("f_high", "f8"),
    ("t", "f8"),  # last trial
    ("f", "f8"),
    ("rate", "f8"),
    ("d1", "f8"),  # direction of slip at the start
    ("d2", "f8"),
    ("width", "f8"),
    ("tolerance", "f8"),
    ("eager", "i8"),  # 0 where events of several points are left to the end of the step
    ("pending", "i8"),  # an action that waits for its unit to be compiled
    ("horizon", "f8"),
]

#: what a body does: FREE flight, held at ONE point, RESTS, held at SEVERAL points
FREE, ONE, RESTS, SEVERAL = range(4)

#: an impact in the making
HIT = [
    ("W", "f8", (3, 3)),
    ("u", "f8", 3),
    ("friction", "f8"),
    ("point", "f8", 3),
    ("out", "f8", 32),
    ("restitution", "f8"),
    ("closed", "i8"),
    ("code", "i8"),
]


def table(fields: list, *shape: int) -> np.recarray:
    """Return a zero array of records with the given fields."""
    return np.zeros(shape, dtype=np.dtype(fields, align=True)).view(np.recarray)


class FreeSolver(NamedTuple):
    """No joints: every body answers for itself."""

    address: int  # of the compiled solve


class TreeSolver(NamedTuple):
    """A forest of joints, solved by articulated-body elimination."""

    address: int
    links: np.recarray  # (N,) LINK
    scratch: np.ndarray  # (N, 124) written by each solve


class LoopSolver(NamedTuple):
    """Closed loops: block-sparse Cholesky factor of A M^-1 A^T, joints in an order of low fill."""

    address: int
    order: np.ndarray  # (J,) joints in the order of elimination
    column: np.ndarray  # (J+1,) ranges of the blocks below the diagonal, by place in the order
    row: np.ndarray  # (B,) joint of each block below the diagonal
    update: np.ndarray  # (J+1,) ranges of the update triples
    triple: np.ndarray  # (U, 3) blocks i, j of a column and the target they change
    term: np.ndarray  # (P, 5) assembly: target block, joint i, side i, joint j, side j
    rows: np.recarray  # (J,) ROW
    block: np.ndarray  # (J+B, 6, 6) diagonal blocks, then the others
    drop: float  # pivots below this part of the row's diagonal are dropped


class System(NamedTuple):
    """All that the kernels know about a scene. Never written to after compile, but the solver's scratch."""

    bodies: np.recarray  # (N,) BODY
    gravity: np.ndarray  # (3,)
    joints: np.recarray  # (J,) JOINT
    springs: np.recarray  # SPRING
    loads: np.recarray  # LOAD
    bushings: np.recarray  # BUSHING
    contacts: np.recarray  # (C,) CONTACT
    vertices: np.ndarray  # (V, 3) of all contacts, body axes
    solids: np.recarray  # SOLID of `carom.contact.pairs`, of bodies that may touch each other
    hulls: Hulls | NoHulls
    touch_at: int  # address of what finds the points of two solids
    plane_at: int  # of a solid and a half-space
    acceleration_at: int  # of what works out all accelerations, 0 while nobody asks
    solver: FreeSolver | TreeSolver | LoopSolver


class Held(NamedTuple):
    """What is held, and what may be: the first `count[0]` of `points` are in use."""

    points: np.recarray  # (P,) HELD
    brinks: np.recarray  # (C,) BRINK
    carries: np.ndarray  # (V,) 1 for vertices that carry a held contact
    count: np.ndarray  # (1,)


class Work(NamedTuple):
    """Scratch of one run: made once, never grown."""

    body: np.recarray  # (N,) BODY_WORK
    joint: np.recarray  # (J,) JOINT_WORK
    stages: np.recarray  # (S, N) STAGE
    stage: np.recarray  # (N,) STATE
    trial: np.recarray  # (N,) STATE
    middle: np.recarray  # (N,) STATE
    point: np.recarray  # (1,) POINT, the one that strikes, or is looked at
    pair: PairWork
    touches: np.recarray  # (8,) TOUCH_POINT of the last pair
    solid_pose: np.ndarray  # (2, 7) of its solids
    solid_rate: np.ndarray  # (2, 3) velocities at its point, before and after
    hit: np.recarray  # (1,) HIT
    result: np.recarray  # (1,) RESULT
    search: np.recarray  # (1,) SEARCH
    history: np.ndarray  # (0, 16) no history inside the loop
