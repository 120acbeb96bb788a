"""The whole impact as one contact problem, used if the passage of the boundary layer fails.

Newton's law holds at each contact, 0 <= p_n _|_ u_n+ + e u_n- >= 0, with Coulomb's cones at the velocity after
(Moreau 1988). There is no path, so the order in which contacts load and slip is lost. If the result would raise
the energy, the problem is solved again with e = 0, which never raises it.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.layout import CONE, ENOUGH
from carom.friction.solve import solve_cones
from carom.friction.strategy import allow
from carom.impact.multiple.layout import CLEAN, FACTOR, SCRATCH, STACK, TRY

_GROWTH = 1e-9  # greatest growth of energy that is round-off, relative to sum |p u|
_MOST = 1e3  # greatest sound velocity after, relative to the greatest velocity before


@kernel
def unsound(k, u, scale, out):
    """Return whether a result is impossible: huge speeds, growing energy, or bodies that still approach."""
    top, gain, bound = 0.0, 0.0, 0.0
    for a in range(3 * k):
        top = max(top, abs(out.velocity[a]))
        gain += 0.5 * out.impulse[a] * (u[a] + out.velocity[a])
        bound += abs(out.impulse[a]) * scale
    least = 0.0
    for i in range(k):
        least = min(least, out.velocity[3 * i])
    sound = math.isfinite(gain) and top <= _MOST * scale and least >= -1e-3 * scale
    return not (sound and gain <= 1e-6 * bound)


@unit
def solve_at_once(contacts, workspace, out):
    """Write impulses and works of all contacts."""
    k, u, mu, e = contacts.k, contacts.u, contacts.friction, contacts.restitution
    work = workspace.work
    W, c, p = work.matrix[CLEAN], work.vector[SCRATCH], work.vector[TRY]
    heading, kind = work.matrix[FACTOR], work.index[STACK]
    for turn in range(2):
        for i in range(k):
            kind[i] = CONE
            heading[i, 0], heading[i, 1] = 0.0, 0.0
            for r in range(3):
                c[3 * i + r], p[3 * i + r] = u[3 * i + r], 0.0
            if turn == 0:
                c[3 * i] += e[i] * min(0.0, u[3 * i])
        workspace.cones.mismatch[ENOUGH] = 0.0
        allow(workspace.cones, k)
        solve_cones(k, W, c, mu, kind, heading, p, workspace.cones)
        energy, size = 0.0, 0.0
        for a in range(3 * k):
            after = u[a]
            for b in range(3 * k):
                after += W[a, b] * p[b]
            out.velocity[a] = after
            energy += 0.5 * p[a] * (u[a] + after)
            size += abs(p[a] * u[a])
        if energy <= _GROWTH * size:
            break
    for i in range(k):
        a = 3 * i
        for r in range(3):
            out.impulse[a + r] = p[a + r]
        part = 0.5 * p[a] * (u[a] + out.velocity[a])
        slip = p[a + 1] * (u[a + 1] + out.velocity[a + 1])
        slip += p[a + 2] * (u[a + 2] + out.velocity[a + 2])
        out.compression[i], out.restitution[i] = min(0.0, part), max(0.0, part)
        out.friction[i] = max(0.0, -0.5 * slip)
