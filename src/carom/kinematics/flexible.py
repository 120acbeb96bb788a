"""A place on a flexible body: its displacement by the modes, its velocity, and how a force acts on them.

Small deformations about mean axes: a point of the body is at x + R (r + Phi eta), and its velocity is

    v + w x R (r + Phi eta) + R Phi eta'.

The bodies after a flexible one stand for its modes, each for three: their positions are the coordinates eta,
their mass is that of the body, so that Phi has no unit. A force F at the point adds Phi^T R^T F to them.
Phi is a product of splines between the nodes of a grid (`carom.model.flexible`).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.rotation import rotate, rotate_back
from carom.model.parts_of_system import has_modes


@kernel
def basis(one, axis, r):
    """Return the first coefficient along an axis of the grid, how many count, and their weights."""
    n = one.count[axis]
    if n == 1:
        return 0, 1, (1.0, 0.0, 0.0, 0.0)
    s = (r - one.origin[axis]) / one.spacing[axis]
    if n == 2:
        return 0, 2, (1.0 - s, s, 0.0, 0.0)
    i = min(max(int(s), 0), n - 2)
    f = min(max(s - i, 0.0), 1.0)
    g = 1.0 - f
    ends = g * g * g / 6.0, f * f * f / 6.0
    two = 2.0 / 3.0 - f * f + 0.5 * f * f * f
    return i, 4, (ends[0], two, 1.0 - ends[0] - ends[1] - two, ends[1])


@kernel
def coefficients(one, axis):
    """Return the number of coefficients along an axis of the grid."""
    n = one.count[axis]
    return n if n <= 2 else n + 2


@unit(where=has_modes, otherwise=None)
def write_shapes(system, b, place):
    """Write Phi (3, n) at a place of body b, in its axes, to ``system.flexible.shapes``."""
    flexible = system.flexible
    one, phi, values = (
        flexible.bodies[system.bodies[b].flexible - 1],
        flexible.shapes,
        flexible.values,
    )
    for i in range(3):
        for m in range(one.modes):
            phi[i, m] = 0.0
    i0, ni, wx = basis(one, 0, place[0])
    j0, nj, wy = basis(one, 1, place[1])
    k0, nk, wz = basis(one, 2, place[2])
    ys, zs = coefficients(one, 1), coefficients(one, 2)
    for i in range(ni):
        for j in range(nj):
            for k in range(nk):
                weight = wx[i] * wy[j] * wz[k]
                at = one.first + (((i0 + i) * ys + j0 + j) * zs + k0 + k) * 3 * one.modes
                for a in range(3):
                    for m in range(one.modes):
                        phi[a, m] += weight * values[at + a * one.modes + m]


@kernel
def slopes(one, axis, r):
    """Return the derivatives of the weights of `basis` by the place along the axis."""
    n = one.count[axis]
    if n == 1:
        return 0.0, 0.0, 0.0, 0.0
    d = 1.0 / one.spacing[axis]
    if n == 2:
        return -d, d, 0.0, 0.0
    s = (r - one.origin[axis]) / one.spacing[axis]
    i = min(max(int(s), 0), n - 2)
    f = min(max(s - i, 0.0), 1.0)
    g = 1.0 - f
    ends = -0.5 * d * g * g, 0.5 * d * f * f
    two = d * (1.5 * f * f - 2.0 * f)
    return ends[0], two, -ends[0] - ends[1] - two, ends[1]


@kernel
def gradient(system, b, place, state, n):
    """Return the gradient of n . Phi eta at a place of body b; place, n and result in axes of the body."""
    flexible = system.flexible
    one, values = flexible.bodies[system.bodies[b].flexible - 1], flexible.values
    i0, ni, wx = basis(one, 0, place[0])
    j0, nj, wy = basis(one, 1, place[1])
    k0, nk, wz = basis(one, 2, place[2])
    sx, sy, sz = slopes(one, 0, place[0]), slopes(one, 1, place[1]), slopes(one, 2, place[2])
    ys, zs = coefficients(one, 1), coefficients(one, 2)
    gx, gy, gz = 0.0, 0.0, 0.0
    for i in range(ni):
        for j in range(nj):
            for k in range(nk):
                at = one.first + (((i0 + i) * ys + j0 + j) * zs + k0 + k) * 3 * one.modes
                h = 0.0
                for a in range(3):
                    for m in range(one.modes):
                        eta = state[b + 1 + m // 3].x[m % 3]
                        h += n[a] * values[at + a * one.modes + m] * eta
                gx += sx[i] * wy[j] * wz[k] * h
                gy += wx[i] * sy[j] * wz[k] * h
                gz += wx[i] * wy[j] * sz[k] * h
    return gx, gy, gz


@kernel
def in_world(system, b, state, d):
    """Return a vector in axes of the scene's body b, in the world."""
    axes, q = system.bodies[b].axes, state[b].Q
    r = rotate_back(axes, d)
    return rotate(q, r)


@kernel
def in_body(system, b, state, d):
    """Return a vector of the world in axes of the scene's body b."""
    axes, q = system.bodies[b].axes, state[b].Q
    r = rotate_back(q, d)
    return rotate(axes, r)


@kernel
def displacement(system, b, state):
    """Return Phi eta in the world, with the shapes of the last place."""
    phi, x, y, z = system.flexible.shapes, 0.0, 0.0, 0.0
    for m in range(3 * system.bodies[b].modes):
        s = state[b + 1 + m // 3].x[m % 3]
        x, y, z = x + phi[0, m] * s, y + phi[1, m] * s, z + phi[2, m] * s
    return in_world(system, b, state, (x, y, z))


@kernel
def ringing(system, b, state):
    """Return Phi eta' in the world, with the shapes of the last place."""
    phi, x, y, z = system.flexible.shapes, 0.0, 0.0, 0.0
    for m in range(3 * system.bodies[b].modes):
        s = state[b + 1 + m // 3].v[m % 3]
        x, y, z = x + phi[0, m] * s, y + phi[1, m] * s, z + phi[2, m] * s
    return in_world(system, b, state, (x, y, z))


@kernel
def side_moves(system, b, place, state):
    """Return the velocity of a place of body b by its modes, in the world."""
    if b < 0 or system.bodies[b].modes == 0:
        return 0.0, 0.0, 0.0
    write_shapes(system, b, place)
    return ringing(system, b, state)


@unit(where=has_modes, otherwise=(0.0, 0.0, 0.0))
def modal_velocity(system, point, state) -> tuple[float, float, float]:
    """Return the velocity of a point by the modes of both bodies, in the world."""
    a, b = side_moves(system, point.a, point.place_a, state), (0.0, 0.0, 0.0)
    if point.b >= 0:
        b = side_moves(system, point.b, point.place_b, state)
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def side_motion(system, b, place, state, work):
    """Return the motion of a place of body b by its modes that the last solve wrote, in the world."""
    if b < 0 or system.bodies[b].modes == 0:
        return 0.0, 0.0, 0.0
    write_shapes(system, b, place)
    phi, x, y, z = system.flexible.shapes, 0.0, 0.0, 0.0
    for m in range(3 * system.bodies[b].modes):
        s = work.body[b + 1 + m // 3].motion[m % 3]
        x, y, z = x + phi[0, m] * s, y + phi[1, m] * s, z + phi[2, m] * s
    return in_world(system, b, state, (x, y, z))


@unit(where=has_modes, otherwise=(0.0, 0.0, 0.0))
def modal_motion(system, point, state, work) -> tuple[float, float, float]:
    """Return the motion of a point by the modes that the last solve wrote, in the world."""
    a, b = side_motion(system, point.a, point.place_a, state, work), (0.0, 0.0, 0.0)
    if point.b >= 0:
        b = side_motion(system, point.b, point.place_b, state, work)
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def side_accelerates(system, b, place, state, stage):
    """Return R Phi eta'' + 2 w x R Phi eta' of a place of body b, in the world."""
    if b < 0 or system.bodies[b].modes == 0:
        return 0.0, 0.0, 0.0
    write_shapes(system, b, place)
    phi, x, y, z = system.flexible.shapes, 0.0, 0.0, 0.0
    for m in range(3 * system.bodies[b].modes):
        s = stage[b + 1 + m // 3].rate[m % 3]
        x, y, z = x + phi[0, m] * s, y + phi[1, m] * s, z + phi[2, m] * s
    a, u, w = in_world(system, b, state, (x, y, z)), ringing(system, b, state), state[b].w
    return (
        a[0] + 2.0 * (w[1] * u[2] - w[2] * u[1]),
        a[1] + 2.0 * (w[2] * u[0] - w[0] * u[2]),
        a[2] + 2.0 * (w[0] * u[1] - w[1] * u[0]),
    )


@unit(where=has_modes, otherwise=(0.0, 0.0, 0.0))
def modal_acceleration(system, point, state, stage) -> tuple[float, float, float]:
    """Return the acceleration of a point by the modes of both bodies, in the world."""
    a, b = side_accelerates(system, point.a, point.place_a, state, stage), (0.0, 0.0, 0.0)
    if point.b >= 0:
        b = side_accelerates(system, point.b, point.place_b, state, stage)
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def push_side(system, b, place, state, f, work):
    """Add Phi^T R^T F of a force on a place of body b to the wrenches of its modes."""
    if b < 0 or system.bodies[b].modes == 0:
        return
    write_shapes(system, b, place)
    phi, g = system.flexible.shapes, in_body(system, b, state, f)
    for m in range(3 * system.bodies[b].modes):
        s = phi[0, m] * g[0] + phi[1, m] * g[1] + phi[2, m] * g[2]
        work.body[b + 1 + m // 3].wrench[m % 3] += s


@unit(where=has_modes, otherwise=None)
def push_modes(system, point, state, f, work):
    """Add the force f at a point, and the opposite one, to the wrenches of the modes of both bodies."""
    push_side(system, point.a, point.place_a, state, f, work)
    if point.b >= 0:
        push_side(system, point.b, point.place_b, state, (-f[0], -f[1], -f[2]), work)


@kernel
def greatest_rate(system, b, state):
    """Return a bound of the speed of a place of body b by its modes [m/s]."""
    total = 0.0
    if b >= 0 and system.bodies[b].modes > 0:
        one = system.flexible.bodies[system.bodies[b].flexible - 1]
        for m in range(one.modes):
            total += system.flexible.most[one.first_most + m] * abs(state[b + 1 + m // 3].v[m % 3])
    return total


@kernel
def deflection(system, b, state):
    """Return a bound of the displacement of a place of body b by its modes [m]."""
    total = 0.0
    if b >= 0 and system.bodies[b].modes > 0:
        one = system.flexible.bodies[system.bodies[b].flexible - 1]
        for m in range(one.modes):
            total += system.flexible.most[one.first_most + m] * abs(state[b + 1 + m // 3].x[m % 3])
    return total


@unit(where=has_modes, otherwise=0.0)
def greatest_deflection(system, a, b, state) -> float:
    """Return a bound of the displacement of a place of either body of a contact by its modes [m]."""
    return deflection(system, a, state) + deflection(system, b, state)


@unit(where=has_modes, otherwise=0.0)
def greatest_ringing(system, a, b, state) -> float:
    """Return a bound of the relative speed of places of two bodies by their modes [m/s]."""
    return greatest_rate(system, a, state) + greatest_rate(system, b, state)


@unit(where=has_modes, otherwise=0.0)
def greatest_modal_acceleration(system, work, b, stages) -> float:
    """Return a bound of the acceleration of a place of body b by its modes, in the stages of a step [m/s^2]."""
    one, most = system.flexible.bodies[system.bodies[b].flexible - 1], 0.0
    for s in range(stages):
        total = 0.0
        for m in range(one.modes):
            rate = work.stages[s, b + 1 + m // 3].rate[m % 3]
            total += system.flexible.most[one.first_most + m] * abs(rate)
        most = max(most, total)
    return most
