"""A rope round a guide on which it rubs: Euler's and Eytelwein's law T_2 <= T_1 exp(mu phi) as Coulomb's.

With the tensions T_1 = T + F/2 before the guide and T_2 = T - F/2 behind it, T pulls along the whole length of
the rope, and F along its slip s on the guide, half the difference of what is behind and before it. The law is

    |F| <= 2 tanh(mu phi/2) T,    F against s',

so with the row u_t = a s', a = 2 tanh(mu phi/2)/mu, and the force F/a along it, the rope is a contact with the
coefficient mu, whose normal row is the rate of its slack. The angle phi on the guide follows the strands.

On several guides, between which nothing moves but the rope, it has one slip, and mu phi is the sum of theirs.
The angles of the first and of the last follow the strands outside.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.kinematics.coordinates.strand import angle_of, turning_of


@kernel
def arc(system, wrap, state):
    """Return the angle phi that lies on the guide [rad], 0 where the rope has left it.

    Of several guides it is the sum of mu phi over the mu of the first.
    """
    first, last = wrap.arc[0], wrap.arc[1]
    for k in range(2):
        if wrap.strand[k] >= 0:
            c = system.relations.coordinates[wrap.strand[k]]
            turned = wrap.way[k] * (angle_of(system, c, wrap.angle[k], state) - wrap.angle[k])
            if wrap.guide[k] == 0:
                first += turned
            else:
                last += turned
    return max(first, 0.0) + wrap.between + wrap.share[1] * max(last, 0.0)


@kernel
def grip(system, wrap, state):
    """Return a = 2 tanh(mu phi/2)/mu."""
    return 2.0 * math.tanh(0.5 * wrap.friction * arc(system, wrap, state)) / wrap.friction


@kernel
def grip_rate(system, wrap, state):
    """Return da/dt = phi'/cosh(mu phi/2)^2."""
    rate = 0.0
    for k in range(2):
        if wrap.strand[k] >= 0:
            c = system.relations.coordinates[wrap.strand[k]]
            rate += wrap.share[wrap.guide[k]] * wrap.way[k] * turning_of(c, state)
    return rate / math.cosh(0.5 * wrap.friction * arc(system, wrap, state)) ** 2
