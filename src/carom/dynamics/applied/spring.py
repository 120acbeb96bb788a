"""Springs and dampers between two points: linear, or by a characteristic curve.

tension = k (d - rest) + c d',  or  F(d) + c d',        U = integral of the part without c
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.curve import curve
from carom.dynamics.elements.stiff import line_of
from carom.geometry.pieces import find_piece
from carom.kinematics.joints import arm
from carom.kinematics.wrench import add_force, point, point_velocity


@kernel
def tension(system, spring, length):
    """Return the tension of a spring, by its curve if it has one."""
    if spring.last_piece > spring.piece:
        return curve(system.relations.pieces, spring.piece, spring.last_piece, length)[0]
    return spring.stiffness * (length - spring.rest_length)


@kernel
def add(system, spring, state, power, work):
    """Add the force of a spring to both ends; return `power` with its damper's, tension, length, its rate."""
    p, c = spring.parent, spring.child
    ax, ay, az, px, py, pz = point(state, p, spring.parent_anchor)
    bx, by, bz, qx, qy, qz = point(state, c, spring.child_anchor)
    dx, dy, dz = qx - px, qy - py, qz - pz
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    s = 1.0 / length if length > 0.0 else 0.0
    dx, dy, dz = s * dx, s * dy, s * dz
    ux, uy, uz = point_velocity(state, c, bx, by, bz)
    sx, sy, sz = point_velocity(state, p, ax, ay, az)
    rate = dx * (ux - sx) + dy * (uy - sy) + dz * (uz - sz)
    drag = spring.damping * rate
    f = tension(system, spring, length) + drag
    add_force(work, c, (bx, by, bz), (-f * dx, -f * dy, -f * dz))
    add_force(work, p, (ax, ay, az), (f * dx, f * dy, f * dz))
    return power - drag * rate, f, length, rate


@kernel
def acts_at(system, spring, state):
    """Return the arm of the child to its anchor."""
    return arm(state, spring.child, spring.child_anchor)


@kernel
def integral(pieces, first, last, t):
    """Return the integral of a curve from its first point to t."""
    here, total = find_piece(pieces, first, last, t), 0.0
    for i in range(first, here + 1):
        piece = pieces[i]
        s = (t if i == here else piece.end) - piece.start
        f = 0.0
        for k in range(5, -1, -1):
            f = f * s + piece.c[k] / (k + 1.0)
        total += f * s
    return total


@kernel
def energy(system, s, state, t):
    """Return the energy of a spring [J]."""
    _, _, _, px, py, pz = point(state, s.parent, s.parent_anchor)
    _, _, _, qx, qy, qz = point(state, s.child, s.child_anchor)
    dx, dy, dz = qx - px, qy - py, qz - pz
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    if s.last_piece > s.piece:
        return integral(system.relations.pieces, s.piece, s.last_piece, length)
    return 0.5 * s.stiffness * (length - s.rest_length) ** 2


@kernel
def unit_force(system, one, n, state, work):
    """Add the wrenches of a unit force, which pushes the ends apart."""
    ex, ey, ez, _, ax, ay, az, bx, by, bz = line_of(one, state)
    add_force(work, one.child, (bx, by, bz), (ex, ey, ez))
    add_force(work, one.parent, (ax, ay, az), (-ex, -ey, -ez))
    return 0.0, 0.0
