"""The one constrained solve, whatever the back end: forces, impulses and displacements alike."""

from __future__ import annotations

from numba.core import types
from numba.extending import overload

from carom.geometry.rotation import rotate, rotate_back
from carom.jit import kernel
from carom.motion.loops import factor, solve_factored
from carom.motion.rows import direction
from carom.motion.tree import solve_tree
from carom.system.arrays import FreeSolver, LoopSolver, TreeSolver


@kernel
def solve_free(system, x, Q, wrench, bias, out, reaction):
    """Without joints: out = M^-1 wrench."""
    inertia = system.bodies.inertia
    mass = system.bodies.mass
    for b in range(mass.size):
        write_free(mass[b], inertia[b], Q[b], wrench[b], out[b])


@kernel
def write_free(mass, inertia, Q, wrench, out):
    """Write M^-1 wrench of one body."""
    from_world = rotate_back(Q[0], Q[1], Q[2], Q[3], wrench[3], wrench[4], wrench[5])
    a = from_world[0] / inertia[0], from_world[1] / inertia[1], from_world[2] / inertia[2]
    t = rotate(Q[0], Q[1], Q[2], Q[3], a[0], a[1], a[2])
    for k in range(3):
        out[k] = wrench[k] / mass
        out[3 + k] = t[k]


@kernel
def solve_loops(system, x, Q, wrench, bias, out, reaction):
    """With closed loops: factor in this position and solve; the wrench of each joint from its rows."""
    factor(system, x, Q, 0.0)
    solve_factored(system, x, Q, wrench, bias, out)
    joint_wrenches(system, x, Q, system.solver.rhs, reaction)


@kernel
def joint_wrenches(system, x, Q, multiplier, reaction):
    """Write the wrench on the child at its anchor: sum of multiplier times direction."""
    joints = system.joints
    for j in range(joints.kind.size):
        for k in range(6):
            reaction[j, k] = 0.0
        for r in range(joints.rows[j]):
            d = direction(joints, j, r, x, Q)
            for k in range(3):
                reaction[j, k] += multiplier[j, r] * d[3 + k]
                reaction[j, 3 + k] += multiplier[j, r] * d[k]


_BACK_ENDS = {FreeSolver: solve_free, TreeSolver: solve_tree, LoopSolver: solve_loops}


def solve(system, x, Q, wrench, bias, out, reaction):
    """Write the motion of all bodies under `wrench` and joint `bias` into `out (N, 6)`.

    See `carom.motion.tree` for the meaning. Compiled code takes the back end from the type of
    `system.solver`, so that a run contains only the one it needs.
    """
    _BACK_ENDS[type(system.solver)](system, x, Q, wrench, bias, out, reaction)


def solver_type(system):
    """Return the class of `system.solver` from Numba's type of the system."""
    if isinstance(system, types.BaseNamedTuple):
        index = system.fields.index("solver")
        return system.types[index].instance_class
    return None


@overload(solve)
def _solve(system, x, Q, wrench, bias, out, reaction):
    back_end = _BACK_ENDS[solver_type(system)]
    return lambda system, x, Q, wrench, bias, out, reaction: back_end(
        system, x, Q, wrench, bias, out, reaction
    )
