"""A compiled scene: one structured array for each kind of part. A run writes into `carom.model.workspace`.

N bodies, J joints, C contacts. Index -1 stands for the ground. Kernels read ``bodies[b].mass``; Python
sees the same arrays as columns, ``bodies.mass``.

The arrays contain records. With one array per field instead, Numba passes each array to each function as seven
values, and types and optimises all of them again at every level of the call tree. (Measured: 110 arrays took
125 s to compile and 8.5 microseconds a step; docs/development/decisions.md.)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.collision.layout import Hulls
from carom.collision.level_layout import Levels
from carom.model.chart import Chart
from carom.model.forces import Forces
from carom.model.laws import Laws
from carom.model.memory import Memory
from carom.scene import joints
from carom.scene.force_definition import ENDS

#: kinds of joints in kernels; those on curves come last
KIND = {
    definition: number
    for number, definition in enumerate(sorted(joints.JOINTS, key=lambda one: one.guide == "curve"))
}
REVOLUTE, PRISMATIC = KIND[joints.Revolute], KIND[joints.Prismatic]
DISTANCE, KNIFE_EDGE = KIND[joints.Distance], KIND[joints.KnifeEdge]
UNIVERSAL, SCREW = KIND[joints.Universal], KIND[joints.Screw]
SPHERICAL = KIND[joints.Spherical]
ROLLING_SPHERE, ROLLING_DISC = KIND[joints.RollingSphere], KIND[joints.RollingDisc]
#: kinds in the table of joints whose rows are numbers of their own: a point of the child on a curve of the
#: parent, and a curve of the child on a point of the parent; a relation of coordinates of joints; rows of the
#: user's own; a spring and damper as a row, for the implicit step; inertia along a coordinate as a row;
#: constraints of a system in the user's coordinates
POINT_ON_CURVE, CURVE_ON_POINT = KIND[joints.PointOnCurve], KIND[joints.CurveOnPoint]
ON_CURVE = (POINT_ON_CURVE, CURVE_ON_POINT)
RELATION, USER_ROWS, STIFF, INERTIA, CHART_CONSTRAINT = range(len(KIND), len(KIND) + 5)
OWN_ROWS = min(ON_CURVE)  # the first of these kinds
#: coordinates that only stops limit: the word for each, and its file in `carom.kinematics.coordinates`
LIMITED = {
    "rotation": "ball",
    "swing": "ball",
    "twist": "ball",
    "length": "length",
    "strand": "strand",
    "bush": "bush",
    "gap": "gap",
}
OF_LIMIT = {word: number for number, word in enumerate(LIMITED, len(KIND) + 5)}
SWING, TWIST = OF_LIMIT["swing"], OF_LIMIT["twist"]
COMBINATION = len(KIND) + 5 + len(LIMITED)  # sum of factors times coordinates of joints
ABSENT = COMBINATION + 1  # an element that a switch has taken away: it has no rows


def _kinds(chosen) -> tuple[int, ...]:
    return tuple(number for definition, number in KIND.items() if chosen(definition))


#: joints whose child's anchor moves along the first direction of the parent's frame
ALONG = _kinds(lambda joint: joint.guide == "line")
#: it moves in the plane perpendicular to this direction
WITHIN = _kinds(lambda joint: joint.guide == "plane")
SLIDING = (*ALONG, *WITHIN, POINT_ON_CURVE)
#: the child rolls on a plane of the parent
ROLLING = (ROLLING_SPHERE, ROLLING_DISC)
#: the child turns about the first direction alone
TURNING = _kinds(lambda joint: joint.turn == "axis")
#: the child turns freely
BALL = _kinds(lambda joint: joint.turn == "ball")
#: the child does not turn
RIGID = _kinds(lambda joint: joint.turn == "rigid")
#: joints that cannot carry their child in a tree
LOOSE = _kinds(lambda joint: not joint.in_trees)
#: joints that can do so from parent to child only: the line or plane belongs to the parent
ONE_WAY = _kinds(lambda joint: joint.turn == "ball" and joint.guide != "point")

#: absolute coordinates, world axes; Q takes principal axes of inertia to the world
STATE = [("x", "f8", 3), ("Q", "f8", 4), ("v", "f8", 3), ("w", "f8", 3)]

BODY = [
    ("mass", "f8"),
    ("inertia", "f8", 3),  # principal moments
    ("extent", "f8"),  # a length of the body: its shape, or the arms of its joints
    ("isotropic", "i8"),  # 1 if the three moments are equal
    ("isolated", "i8"),  # 1 if no joint acts
    ("ballistic", "i8"),  # 1 if no joint acts, and no force except gravity
    ("component", "i8"),  # its own number, or N for all bodies with joints
    ("number", "i8"),  # among all bodies of the scene
    ("axes", "f8", 4),  # quaternion from the principal axes to those of the scene
    ("ball", "f8"),  # radius of the ball around its centre that contains its shapes
    ("arm", "f8", 3),  # bound of the distance of its points from each principal axis
    # of a body with modes: how many bodies after it stand for them (three modes each), and 1 + its place in
    # `Flexible.bodies`; else 0
    ("modes", "i8"),
    ("flexible", "i8"),
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
    ("length", "f8"),  # distance; displacement of a screw per radian; radius of a rolling body
    ("number", "i8"),  # of a relation, or of rows of the user's, in `Relations`
    ("index", "i8"),  # of a coordinate, in `Relations` and `Memory`
    ("begin", "f8"),  # value of a coordinate at the start, from which its turns are counted
]

#: a coordinate of a joint: an angle about (kind REVOLUTE), or a displacement along (PRISMATIC), the first axis
#: of the parent's frame, arc length along a curve (ON_CURVE), or one that stops limit (OF_LIMIT); either
#: side may be the ground. A COMBINATION of them has the terms of the relation `number`
COORDINATE = JOINT

#: the curve of a coordinate with its pieces
CURVE = [
    ("first", "i8"),  # range of its pieces
    ("last", "i8"),
    ("low", "f8"),  # its ends, as values of the coordinate
    ("high", "f8"),
    ("period", "f8"),  # its length if it is closed, else 0
    ("sharpest", "f8"),  # largest curvature
    (
        "side",
        "f8",
        3,
    ),  # towards the free side of a rail that can be left, in axes of its body; else 0
]

#: a piece of a curve: a polynomial of degree 5 in s - start, in axes of the body of the curve
CURVE_PIECE = [("start", "f8"), ("c", "f8", (6, 3)), ("normal", "f8", 3)]  # normal: about across it

#: a prescribed motion f(t)
PRESCRIBED = [
    ("constant", "f8"),  # f = constant + rate t
    ("rate", "f8"),
    ("address", "i8"),  # or f is a function of the user's: t -> (f, f', f'')
    ("piece", "i8"),  # or f is a range of pieces of a polynomial
    ("last_piece", "i8"),
]

#: a relation: sum of factor times coordinate = f(t)
RELATION_ROW = [
    ("first", "i8"),  # range of its terms
    ("last", "i8"),
    *PRESCRIBED,
    ("scale", "f8"),  # of its error: 1 for angles, a length for displacements
]

TERM = [
    ("coordinate", "i8"),
    ("factor", "f8"),
    ("child_side", "i8"),  # sides of the solver, -1 for the ground
    ("parent_side", "i8"),
]

#: a rope round guides on which it rubs (`carom.kinematics.wrap`): the first and the last, or one alone
WRAP = [
    # coordinates of the strands before and behind them, -1 for one that nothing moves
    ("strand", "i8", 2),
    ("angle", "f8", 2),  # of these at the start
    ("way", "f8", 2),  # how each changes the angle on its guide: 1 or -1
    ("guide", "i8", 2),  # which guide that is
    ("arc", "f8", 2),  # angle on each guide at the start; 0 for a last one that is the first
    ("share", "f8", 2),  # its friction, of that of the first
    (
        "between",
        "f8",
    ),  # angles on the guides between these, times their friction, of that of the first
    ("friction", "f8"),  # of the first
]

#: rows of the user's: a(q, t) v = b(q, t), as a function (t, poses) -> (rows, 6 bodies + 1)
USER_ROW = [
    ("address", "i8"),
    ("position_address", "i8"),  # of phi(q, t) = 0; 0 if the rows are nonholonomic
    ("first", "i8"),  # range of its sides, one for each body
    ("last", "i8"),
]

#: a spring and damper, a row in the implicit step: along a coordinate, or between two points
STIFF_SPRING = [
    ("element", "i8"),  # its place in the table of joints
    ("coordinate", "i8"),  # -1: between two points
    *ENDS,
    ("stiffness", "f8"),
    ("damping", "f8"),
    ("rest", "f8"),
    ("child_side", "i8"),
    ("parent_side", "i8"),
]

#: what bounds the dry friction of a joint: with a load its own reaction (`persistent.joint_load`)
LOAD = [
    ("load", "i8"),  # number of its load; -1 if its bound does not depend on a load
    ("joint", "i8"),  # whose reaction is the load, among all elements
    ("flipped", "i8"),  # 1 if parent and child of this joint were exchanged
    ("length", "f8"),  # distance of two bearings [m], 0 for one
    ("torsion", "f8"),  # load by a moment about the axis [1/m]
    ("shoulder", "f8"),  # load of two bearings by a force along the axis
    ("thread", "f8"),  # sine of the lead of a thread, 0 for none; 1 over its cosine
    ("steep", "f8"),
]

#: dry friction along a coordinate of a joint: |force| <= bound, against its rate, or against that beside the
#: rate of a drive
FRICTION = [
    ("coordinate", "i8"),
    # by number: its friction is a force [N] or a moment [N m]; by load a coefficient
    ("law", "i8"),
    ("drives", "i8"),  # 1 if it is a drive with a limit, whose rate is that of a motion
    ("arm", "f8"),  # by load, of an angle: distance [m] at which surfaces slide; else 1
    *LOAD,
    *PRESCRIBED,
]

#: inertia along a coordinate of a joint
ROTOR = [
    ("coordinate", "i8"),
    ("inertia", "f8"),
]

#: a hull of vertices, enlarged by a radius, and a half-space; or two solids, one of them perhaps a half-space
CONTACT = [
    ("number", "i8"),  # among all contacts of the scene
    ("body", "i8"),
    ("other", "i8"),  # -1 for a half-space or a static body
    ("static", "i8"),  # 1 if the other solid is static: its pose is one in the world
    ("centre", "f8", 3),  # of the static solid
    ("kind", "i8"),  # of `carom.model.contact_kinds`
    ("part", "i8"),  # 1 if a body has several pieces
    ("first", "i8"),  # range of the vertices of the body
    ("last", "i8"),
    ("other_first", "i8"),  # of the other body
    ("other_last", "i8"),
    ("solid", "i8"),  # the two solids, if points are found from them; coordinate of a stop
    ("other_solid", "i8"),
    # (of a stop: 1 + the number of its wrap, 0 if it is no rope that rubs)
    # 1 + the number of the level surface that the row stands for (`contact.kinds.level_surfaces`), 0 for others
    ("surface", "i8"),
    # range of its faces; of the other solid, range of its surfaces in `Levels.own`; the same of the first solid
    ("first_level", "i8"),
    ("last_level", "i8"),
    ("first_mine", "i8"),
    ("last_mine", "i8"),
    ("law", "i8", 2),  # in impacts and in persistent contact, by number (`carom.model.laws`)
    ("ball_like", "i8"),  # 1 if one of the two is a ball or an ellipsoid
    # of a half-space: rows n, t1, t2; of curved ground: rows that are turned to those of a point
    ("axes", "f8", (3, 3)),
    ("offset", "f8"),  # n . point of the plane; for a stop, side times its position
    # of a stop, gap = side q - offset: above 0 for a lower, below 0 for an upper stop; |side| is 1, or a length
    # for an angle
    ("side", "f8"),
    ("radius", "f8"),  # sum of both radii for two solids
    # of anisotropic friction: to what its axis is fixed (`BODY_AXES`, ...), 0 for none, the axis there, and mu
    # across it over that along it, of which the law has the geometric mean
    ("axis_of", "i8"),
    ("friction_axis", "f8", 3),
    ("across", "f8"),
    ("extent", "f8"),  # largest distance of the shape from the mass centre
    ("other_extent", "f8"),
    ("core", "f8"),  # largest distance of a core point, without the ball that enlarges it
    ("still", "f8"),  # speed that counts as zero: round-off of a fall by the body's size
    ("width", "f8"),  # b of the boundary layer
    ("penetration", "f8"),  # delta
    ("bends", "i8"),  # 1 if one of the two is a body with modes
    # a surface that moves in itself: 0 none, 1 as `field` says, 2 + its place in `MovingSurfaces`
    ("moves", "i8"),
    # its velocity at the origin of the world and its angular velocity, and their rates
    ("field", "f8", (4, 3)),
]

#: a surface whose motion is a function of time: of the user's, t -> (value, rate) of velocity and of spin
MOVING = [
    ("velocity_address", "i8"),  # 0: `velocity`
    ("spin_address", "i8"),  # 0: `rate`
    ("velocity", "f8", 3),
    ("rate", "f8"),
    ("axis", "f8", 3),  # of its spin, through this point
    ("point", "f8", 3),
]


#: place of a body in a forest of joints
LINK = [
    ("order", "i8"),  # the body at this place of the walk, parents before children
    ("joint", "i8"),  # joint that carries the body, -1 for a floating body
    ("parent", "i8"),  # parent body, -1 for the ground or none
    ("freedoms", "i8"),  # of the joint; 6 for a floating body
    ("has_child", "i8"),
]

#: results of the solve for closed loops, for each joint
ROW = [
    ("first", "i8"),  # range of its sides; of a joint the child, and the parent if it is a body
    ("last", "i8"),
    ("ignored", "i8"),  # 1 if its rows are ignored
    ("compliance", "f8", 6),  # added to the diagonal of A M^-1 A^T
    ("pivot", "f8", 6),  # reciprocal pivots, 0 = dropped
    ("weight", "f8", 6),  # diagonal of A M^-1 A^T before elimination
    ("rhs", "f8", 6),  # right-hand side, then multipliers
]

#: the rows of one element of the solve for closed loops, for one body
SIDE = [
    ("element", "i8"),
    ("body", "i8"),
    ("A", "f8", (6, 6)),
    ("Y", "f8", (6, 6)),  # A M^-1
]

#: `axis_of`: to what the axis of anisotropic friction is fixed
BODY_AXES, OTHER_AXES, WORLD_AXES = 1, 2, 3


#: workspace of a forest, for each body: numbers before the freedoms, and for each freedom
#: (`carom.dynamics.tree`)
HEAD, WIDTH = 52, 14


#: kinds of back ends: each body by itself; articulated-body elimination; sparse Cholesky factor; dense
#: metric of coordinates of the user's own
NO_JOINTS, FOREST, LOOPS, METRIC = range(4)


class Solver(NamedTuple):
    """Arrays of the constrained solve; those that its kind does not need are empty."""

    kind: int  # NO_JOINTS, FOREST, LOOPS or METRIC
    # forest: articulated-body elimination (`carom.dynamics.tree`)
    links: np.recarray  # (N,) LINK
    rotor: np.ndarray  # (N, most freedoms) inertia along each freedom of the joint of a link
    workspace: np.ndarray  # (N, HEAD + WIDTH times the most freedoms) written by each solve
    # closed loops: block-sparse Cholesky factor of A M^-1 A^T, joints in an order of low fill
    order: np.ndarray  # (J,) joints in the order of elimination
    column: np.ndarray  # (J+1,) ranges of the blocks below the diagonal, by place in the order
    row: np.ndarray  # (B,) joint of each block below the diagonal
    update: np.ndarray  # (J+1,) ranges of the update triples
    triple: np.ndarray  # (U, 3) blocks i, j of a column and the target they change
    term: np.ndarray  # (P, 3) assembly: target block, sides i and j of two elements
    rows: np.recarray  # (J,) ROW
    sides: np.recarray  # (S,) SIDE
    block: np.ndarray  # (J+B, 6, 6) diagonal blocks, then the others
    drop: float  # pivots below this part of the row's diagonal are dropped
    pose: np.ndarray  # (N, 7) of the last factor; (0, 7) if rows depend on more than the pose
    #: (1,) number of redundant rows away from singular positions; -1: not known yet
    usual: np.ndarray
    # workspace of `carom.dynamics.light_bodies`, empty for similar masses: high and low parts
    fine: np.ndarray  # (2, J+B, 6, 6) blocks
    digits: np.ndarray  # (J, 4, 6) 1/pivots, multipliers
    scaled: np.ndarray  # (N, 3, 6) scaled motions, and attitudes


class Relations(NamedTuple):
    """Coordinates of joints, relations between them, and rows of the user's own."""

    there: int  # 1 if there is more than coordinates whose turns are counted
    counted: int  # the first coordinates: all angles, and places on closed curves
    coordinates: np.recarray  # COORDINATE
    relations: np.recarray  # RELATION_ROW
    terms: np.recarray  # TERM
    user: np.recarray  # USER_ROW
    pieces: np.recarray  # PIECE
    stiff: np.recarray  # STIFF_SPRING
    frictions: np.recarray  # (F,) FRICTION
    rotors: np.recarray  # ROTOR
    curves: np.recarray  # CURVE
    curve_pieces: np.recarray  # CURVE_PIECE
    wraps: np.recarray  # WRAP
    named: np.ndarray  # bodies of the user's functions
    memory: Memory


class MovingSurfaces(NamedTuple):
    """Surfaces that move in themselves as functions of time."""

    rows: np.recarray  # MOVING
    read: np.ndarray  # (1,) argument of a function that reads time alone
    write: np.ndarray  # (8,) velocity and acceleration, rate of spin and its rate


#: displacements of a body by its modes, as splines between the nodes of a grid in its axes
FLEXIBLE = [
    ("origin", "f8", 3),  # first node
    ("spacing", "f8", 3),
    ("count", "i8", 3),  # of nodes: 1 (constant), 2 (linear), or at least 4 (cubic)
    (
        "first",
        "i8",
    ),  # of its coefficients in `Flexible.values`: (nodes or nodes + 2, ..., 3, modes)
    ("modes", "i8"),  # three for each body that stands for them
    ("first_most", "i8"),  # of the greatest displacements by its modes, in `Flexible.most`
    ("fastest", "f8"),  # its highest frequency [rad/s]
]


class Flexible(NamedTuple):
    """The shapes of the modes of bodies that have some."""

    bodies: np.recarray  # FLEXIBLE
    values: np.ndarray  # coefficients
    most: np.ndarray  # greatest displacement for the coordinate 1, of each mode
    shapes: np.ndarray  # (3, most modes) workspace: displacements by the modes at one place


class System(NamedTuple):
    """All that the kernels know about a scene. Once compiled, only the workspaces in it change."""

    bodies: np.recarray  # (N,) BODY
    gravity: np.ndarray  # (3,)
    joints: np.recarray  # (J,) JOINT of the scene, then relations and rows of the user's
    relations: Relations
    forces: Forces
    contacts: np.recarray  # (C,) CONTACT
    laws: Laws
    vertices: np.ndarray  # (V, 3) of all contacts, body axes
    solids: np.recarray  # SOLID of `carom.collision`, of bodies that may touch each other
    hulls: Hulls
    levels: Levels  # faces of solids of one body, or of static ones, in one plane
    moving: MovingSurfaces
    solver: Solver
    chart: Chart
    flexible: Flexible
