"""The constrained solve with any back end, for forces, impulses and displacements."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.element_operations import write_reaction
from carom.dynamics.light_bodies import factor_light, solve_light
from carom.dynamics.loops import factor, solve_factored
from carom.dynamics.metric import solve_metric
from carom.dynamics.tree import solve_tree
from carom.geometry.rotation import rotate, rotate_back
from carom.kinematics.pose import keep_poses, same_pose
from carom.model.arrays import FOREST, METRIC, NO_JOINTS


@unit
def solve_free(system, state, biased, near, work):
    """Solve without joints: motion = M^-1 wrench."""
    for b in range(system.bodies.shape[0]):
        free_body(system.bodies[b], state[b].Q, work.body[b])


@kernel
def free_body(body, q, work):
    """Write M^-1 wrench of one body into its work record: Newton's law (paper, Eq. (1))."""
    wrench, motion, J = work.wrench, work.motion, body.inertia
    a = rotate_back(q, wrench[3:])
    t = rotate(q, (a[0] / J[0], a[1] / J[1], a[2] / J[2]))
    for k in range(3):
        motion[k] = wrench[k] / body.mass
        motion[3 + k] = t[k]


@unit
def solve_loops(system, state, biased, near, work):
    """Solve with closed loops: factor in this position, solve, and write the wrench of each joint."""
    if not near and not same_pose(system.solver.pose, state):
        factor(system, state, 0.0, work)
        keep_poses(state, system.solver.pose)
    solve_factored(system, state, biased, work)
    joint_wrenches(system, state, work)


@unit
def solve_spread(system, state, biased, near, work):
    """Solve with closed loops as `solve_loops` does, for masses that differ by many orders."""
    if not near and not same_pose(system.solver.pose, state):
        factor_light(system, state, work)
        keep_poses(state, system.solver.pose)
    solve_light(system, state, biased, work)
    joint_wrenches(system, state, work)


@kernel
def joint_wrenches(system, state, work):
    """Write the wrench of each joint by the multipliers of the last solve."""
    for j in range(system.joints.shape[0]):
        write_reaction(system.joints[j], state, system.solver.rows[j].rhs, work.joint[j].reaction)


@inlined
def _solve(system, state, biased, near, work):
    """Solve by the back end of the system; closed loops with 31 digits if light bodies need them."""
    if system.solver.kind == NO_JOINTS:
        solve_free(system, state, biased, near, work)
    elif system.solver.kind == FOREST:
        solve_tree(system, state, biased, near, work)
    elif system.solver.kind == METRIC:
        solve_metric(system, state, biased, near, work)
    elif system.solver.scaled.shape[0] > 0:
        solve_spread(system, state, biased, near, work)
    else:
        solve_loops(system, state, biased, near, work)


@inlined
def solve(system, state, biased, work):
    """Write the motion of all bodies under their wrenches, all in `work.body`.

    With `biased`, the forbidden relative motion of each joint equals its bias in `work.joint`, otherwise zero
    (`carom.dynamics.tree`).
    """
    _solve(system, state, biased, False, work)


@inlined
def solve_near(system, state, work):
    """Write biased motions as `solve` does, with the factor of the last position, for a correction nearby."""
    _solve(system, state, True, True, work)
