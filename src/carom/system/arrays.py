"""A compiled scene: flat arrays, bodies and joints and contacts each a struct of arrays.

N bodies, J joints, C contacts. Index -1 stands for the ground. All arrays are contiguous, never
written to after compile, and shared by any number of runs; what a run writes is in `Work`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: kinds of joints in kernels
SPHERICAL, REVOLUTE, FIXED, PRISMATIC, DISTANCE, KNIFE_EDGE = range(6)
#: numbers of constraint rows, by kind
ROWS = (3, 5, 6, 5, 1, 1)


class State(NamedTuple):
    """Absolute coordinates of all bodies, in world axes."""

    x: np.ndarray  # (N, 3) mass centres [m]
    Q: np.ndarray  # (N, 4) unit quaternions, principal axes -> world
    v: np.ndarray  # (N, 3) velocities of the mass centres [m/s]
    w: np.ndarray  # (N, 3) angular velocities [rad/s]


class Bodies(NamedTuple):
    """Inertia of the bodies, in principal axes."""

    mass: np.ndarray  # (N,) [kg]
    inertia: np.ndarray  # (N, 3) principal moments [kg m^2]
    size: np.ndarray  # (N,) a length of each body: its shape, or the arms of its joints [m]
    isotropic: np.ndarray  # (N,) 1 where the three moments are equal
    isolated: np.ndarray  # (N,) 1 where no joint acts
    ballistic: np.ndarray  # (N,) 1 where no joint and no force but gravity acts
    gravity: np.ndarray  # (3,) [m/s^2]


class Joints(NamedTuple):
    """Bilateral constraints. Frames of a joint are columns (axis, second, third) of a 3x3 matrix."""

    kind: np.ndarray  # (J,) one of the codes above
    parent: np.ndarray  # (J,) body, or -1 for the ground
    child: np.ndarray  # (J,) body
    parent_anchor: np.ndarray  # (J, 3) in the parent's axes, from its centre
    child_anchor: np.ndarray  # (J, 3) in the child's axes, from its centre
    parent_frame: np.ndarray  # (J, 3, 3) in the parent's axes
    child_frame: np.ndarray  # (J, 3, 3) in the child's axes
    length: np.ndarray  # (J,) of a distance joint [m]
    rows: np.ndarray  # (J,) number of constraint rows


class Forces(NamedTuple):
    """Applied forces other than gravity."""

    spring_parent: np.ndarray  # (F,)
    spring_child: np.ndarray  # (F,)
    spring_parent_anchor: np.ndarray  # (F, 3)
    spring_child_anchor: np.ndarray  # (F, 3)
    spring_constants: np.ndarray  # (F, 3) stiffness [N/m], damping [N s/m], rest length [m]
    wrench_body: np.ndarray  # (K,)
    wrench_anchor: np.ndarray  # (K, 3) point of attack in the body's axes
    wrench: np.ndarray  # (K, 6) constant force [N] and torque [N m], world


class Contacts(NamedTuple):
    """Unilateral constraints: hull of vertices, swollen by a radius, against a half-space."""

    body: np.ndarray  # (C,)
    axes: np.ndarray  # (C, 3, 3) rows n, t1, t2 of the contact frame
    offset: np.ndarray  # (C,) n . point of the plane [m]
    radius: np.ndarray  # (C,) [m]
    start: np.ndarray  # (C+1,) range of vertices of each contact
    vertices: np.ndarray  # (sum, 3) in the body's axes [m]
    friction: np.ndarray  # (C,)
    restitution: np.ndarray  # (C,)
    law: np.ndarray  # (C,) 0 newton, 1 poisson, 2 stronge
    size: np.ndarray  # (C,) largest distance of the shape from the mass centre [m]
    width: np.ndarray  # (C,) width b of the boundary layer [m]
    penetration: np.ndarray  # (C,) penetration ratio delta


class FreeSolver(NamedTuple):
    """No joints: every body answers for itself."""

    count: int  # number of bodies


class TreeSolver(NamedTuple):
    """A forest of joints, solved by articulated-body elimination."""

    order: np.ndarray  # (N,) bodies, parents before children
    joint: np.ndarray  # (N,) joint that carries the body, -1 where it floats
    parent: np.ndarray  # (N,) parent body, -1 where the parent is the ground or none
    freedoms: np.ndarray  # (N,) of the joint; 6 for a floating body
    has_child: np.ndarray  # (N,) 1 where a floating body carries others
    scratch: np.ndarray  # (N, 132) written by each solve


class LoopSolver(NamedTuple):
    """Closed loops: block-sparse Cholesky factor of A M^-1 A^T, joints in an order of low fill."""

    order: np.ndarray  # (J,) joints in the order of elimination
    column: np.ndarray  # (J+1,) ranges of the blocks below the diagonal, by place in the order
    row: np.ndarray  # (B,) joint of each block below the diagonal
    update: np.ndarray  # (J+1,) ranges of the update triples
    triple: np.ndarray  # (U, 3) blocks i, j of a column and the target they change
    term: np.ndarray  # (P, 5) assembly: target block, joint i, side i, joint j, side j
    touched: np.ndarray  # (N,) 1 where a joint acts on the body
    rows: np.ndarray  # (J, 2, 6, 6) rows A, sides child and parent; written by each solve
    scaled: np.ndarray  # (J, 2, 6, 6) rows times M^-1
    block: np.ndarray  # (J+B, 6, 6) diagonal blocks, then the others
    pivot: np.ndarray  # (J, 6) reciprocal pivots, 0 = dropped
    diagonal: np.ndarray  # (J, 6) diagonal of A M^-1 A^T before elimination
    rhs: np.ndarray  # (J, 6)
    inverse: np.ndarray  # (N, 6) inverse inertia in world axes
    drop: float  # pivots below this part of the row's diagonal are dropped


class System(NamedTuple):
    """All that the kernels know about a scene."""

    bodies: Bodies
    joints: Joints
    forces: Forces
    contacts: Contacts
    solver: FreeSolver | TreeSolver | LoopSolver


class Held(NamedTuple):
    """Contacts that persist, and how (see `carom.hold`)."""

    mode: np.ndarray  # (C,) 0 open, 1 slipping, 2 sticking
    point: np.ndarray  # (C, 3) point of the core that carries the contact, body axes
    anchor: np.ndarray  # (C, 3) where a sticking point was when it stuck, world
    force: np.ndarray  # (C, 3) contact force of the last solve, contact axes [N]
    rest: np.ndarray  # (C,) 1 where the body does not move at all
    near: np.ndarray  # (C,) 1 where something happened at the last event: look before stepping
    leaving: np.ndarray  # (C,) 1 where the body lifts off without speed: it may touch at the start


class Work(NamedTuple):
    """What a run writes to: made once, never grown."""

    wrench: np.ndarray  # (N, 6)
    bias: np.ndarray  # (J, 6)
    delta: np.ndarray  # (N, 6)
    zero: np.ndarray  # (J, 6) stays zero
    reaction: np.ndarray  # (J, 6) wrench on the child at its anchor
    stage: State
    speed: np.ndarray  # (S, N, 6) velocities of the stages
    rate: np.ndarray  # (S, N, 6) accelerations of the stages
    attitude: np.ndarray  # (S, N, 4) attitudes of the stages
    W: np.ndarray  # (C, 3, 3) effective inverse mass of held contacts
    small: np.ndarray  # (3, 3)
    u: np.ndarray  # (3,)
    out: np.ndarray  # (32,) of the impact
    history: np.ndarray  # (0, 16) no history inside the loop
    trial: State
    middle: State
    multiplier: np.ndarray  # (J, 6)
    point: np.ndarray  # (3,) core point of the contact at hand, body axes
    bound: np.ndarray  # (N, 3) greatest linear, angular acceleration and spin of the last step
