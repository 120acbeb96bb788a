"""Accelerations and reactions of any mechanism at rest or in motion: NumPy, from the joints' geometry.

An independent account. Each joint is a list of functions of the poses that stay zero (knife edge:
of poses and velocities); their Jacobians are central differences over displacements (dx, exp(dr) R)
of each body, their second time derivatives at constant velocities (v, w world) are differences along
that motion. Then one dense system

    [ M  -A^T ] [ a   ]   [ m g + loads, -w x I w ]
    [ A    0  ] [ lam ] = [ -d2 phi/dt2           ]

by least squares with rows scaled by (A M^-1 A^T)_rr^(1/2): of all multipliers the one of least norm,
each weighed by that diagonal.
"""

import numpy as np
from scipy.linalg import block_diag
from scipy.spatial.transform import Rotation

DISPLACE, ALONG = 1e-5, 2e-3  # steps of the differences


def rotations(scene):
    return [Rotation.from_quat(np.roll(b.orientation, -1)).as_matrix() for b in scene.bodies]


def _frame(axis):
    """Two directions across an axis."""
    across = np.linalg.svd(np.asarray(axis)[None])[2][1:]
    return across[0], across[1]


def first_axis(definition):
    names = ("axis", "normal", "direction")
    return next(getattr(definition, n) for n in names if hasattr(definition, n))


def constraints(joint):
    """Return phi(x, R) of a joint: a function of (centres, matrices) with value (rows,)."""
    p, c, d = joint.parent, joint.child, joint.definition

    def local(body, world):  # a point fixed in a body
        world = np.asarray(world, float)
        if body.index < 0:
            return lambda x, R: world
        R0 = Rotation.from_quat(np.roll(body.orientation, -1)).as_matrix()
        inside = R0.T @ (world - body.position)
        return lambda x, R: x[body.index] + R[body.index] @ inside

    def fixed(body, world):  # a direction fixed in a body
        world = np.asarray(world, float)
        if body.index < 0:
            return lambda x, R: world
        inside = Rotation.from_quat(np.roll(body.orientation, -1)).as_matrix().T @ world
        return lambda x, R: R[body.index] @ inside

    if joint.kind == "Distance":
        a, b = local(p, d.anchor_parent), local(c, d.anchor_child)
        return lambda x, R: np.array([np.linalg.norm(b(x, R) - a(x, R)) - d.length])
    anchor = c.position if d.anchor is None else d.anchor
    a, b = local(p, anchor), local(c, anchor)
    turns, more = [], []
    if joint.kind in ("Revolute", "Cylindrical", "Screw", "Planar"):
        e, (f, g) = fixed(c, first_axis(d)), (fixed(p, k) for k in _frame(first_axis(d)))
        turns = [(f, e), (g, e)]
    elif joint.kind in ("Fixed", "Prismatic"):
        e = np.eye(3)
        turns = [(fixed(p, e[k]), fixed(c, e[(k + 1) % 3])) for k in range(3)]
    elif joint.kind == "Universal":
        turns = [(fixed(p, d.axis_parent), fixed(c, d.axis_child))]
    if joint.kind in ("Prismatic", "Cylindrical", "Screw", "PointOnLine", "Planar", "PointOnPlane"):
        in_plane = joint.kind.startswith("P") and joint.kind.endswith(("ar", "Plane"))
        across = [fixed(p, k) for k in ([first_axis(d)] if in_plane else _frame(first_axis(d)))]
        gaps = [lambda x, R, k=k: k(x, R) @ (b(x, R) - a(x, R)) for k in across]
    else:
        gaps = [lambda x, R, k=k: (b(x, R) - a(x, R))[k] for k in range(3)]
    if joint.kind == "Screw":
        line, (f, g) = fixed(p, d.axis), (fixed(p, k) for k in _frame(d.axis))
        start = fixed(c, _frame(d.axis)[0])
        sense = np.sign(np.linalg.det([d.axis, *_frame(d.axis)]))

        def thread(x, R):  # near the start: less than half a turn
            u = start(x, R)
            turn = sense * np.arctan2(g(x, R) @ u, f(x, R) @ u)
            return line(x, R) @ (b(x, R) - a(x, R)) - d.pitch / (2 * np.pi) * turn

        more = [thread]
    parts = [*gaps, *more, *(lambda x, R, f=f, g=g: f(x, R) @ g(x, R) for f, g in turns)]
    return lambda x, R: np.array([part(x, R) for part in parts])


def move(x, R, xi):
    """Displace all bodies by xi (N, 6): x + xi_x, exp(xi_r) R."""
    turned = Rotation.from_rotvec(xi[:, 3:]).as_matrix() @ R
    return x + xi[:, :3], turned


def jacobian(phi, x, R):
    count, columns = len(x), []
    for k in range(6 * count):
        xi = np.zeros((count, 6))
        xi.flat[k] = DISPLACE
        columns.append((phi(*move(x, R, xi)) - phi(*move(x, R, -xi))) / (2.0 * DISPLACE))
    return np.array(columns).T


def curvature(phi, x, R, u):
    """Second derivative of phi along constant velocities u (N, 6); differences of order 4."""
    h = ALONG
    f = [phi(*move(x, R, k * h * u)) for k in (-2, -1, 0, 1, 2)]
    return (-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / (12.0 * h * h)


def solve(scene, loads=None):
    """Return accelerations (N, 6), wrenches of each joint on child and parent (J, 2, 6) about their
    mass centres, A (rows, 6N), and the largest |A u|: all in the state at the start."""
    x, R = np.array([b.position for b in scene.bodies]), np.array(rotations(scene))
    u = np.array([[*b.velocity, *b.angular_velocity] for b in scene.bodies])
    inertia = [r @ b.inertia @ r.T for r, b in zip(R, scene.bodies)]
    M = block_diag(*(block_diag(b.mass * np.eye(3), J) for b, J in zip(scene.bodies, inertia)))
    force = np.zeros((len(x), 6)) if loads is None else np.array(loads, float)
    for k, (b, J) in enumerate(zip(scene.bodies, inertia)):
        force[k, :3] += b.mass * scene.gravity
        force[k, 3:] -= np.cross(u[k, 3:], J @ u[k, 3:])
    functions = [constraints(j) for j in scene.joints]
    blocks = [jacobian(f, x, R) for f in functions]
    A = np.vstack(blocks)
    bias = np.concatenate([curvature(f, x, R, u) for f in functions])
    free = np.linalg.solve(M, force.ravel())
    S = A @ np.linalg.solve(M, A.T)
    scale = np.sqrt(np.diag(S))
    lam = np.linalg.pinv(S / scale / scale[:, None], rcond=1e-9) @ ((-bias - A @ free) / scale)
    lam /= scale
    a = (free + np.linalg.solve(M, A.T @ lam)).reshape(-1, 6)
    wrenches, row = np.zeros((len(blocks), 2, 6)), 0
    for k, (block, joint) in enumerate(zip(blocks, scene.joints)):
        all_bodies = (block.T @ lam[row : row + len(block)]).reshape(-1, 6)
        wrenches[k, 0] = all_bodies[joint.child.index]
        if joint.parent.index >= 0:
            wrenches[k, 1] = all_bodies[joint.parent.index]
        row += len(block)
    return a, wrenches, A, np.max(np.abs(A @ u.ravel()))
