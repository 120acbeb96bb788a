"""The layers of a multiple impact in fixed steps: leap-frog for depths, friction implicit (mathematics, §2.5).

Modes change at the ends of steps. The method has order two between changes. With many contacts it is cheaper
than to locate each change.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.impact.multiple import law
from carom.impact.multiple.adaptive import ENDED, TRAPPED, drift, wedged
from carom.impact.multiple.discs import friction
from carom.impact.multiple.events import ROUND_OFF
from carom.impact.multiple.layout import (
    DISC,
    DISC_C,
    DISC_T,
    DISCS,
    JACOBIAN,
    MASS,
    RADIUS,
    SCRATCH,
    D,
    P,
    U,
)
from carom.impact.multiple.motion import add_velocity, gather_discs, normal_forces, set_velocity

_TOLERANCE = 1e-10  # of the velocities that friction gives
_APART = 1e-10  # speeds of approach below this count as zero


@kernel
def traverse_fixed(k, work, n, p, max_events, max_steps):
    """Pass the layer with `n` steps per unit of time, which is e times shorter for unloading."""
    clock = work.clock[0]
    least = 1.0
    for i in range(k):
        least = min(least, max(0.05, work.contact[i].e))
    h = least / n
    m = gather_discs(k, work)
    first_events, first_steps = clock.events, clock.steps
    while True:
        before = clock.events
        if drift(k, work, _APART, p) == 1 or wedged(k, work, h, p):
            return ENDED
        if (
            clock.events - first_events > max_events
            or clock.steps - first_steps > max_steps
            or clock.steps > clock.left
        ):
            return TRAPPED
        if clock.events != before:
            m = gather_discs(k, work)
        _step(k, m, work, h, p)
        clock.steps += 1
        changed = _switch(k, work, p)
        if changed > 0:
            clock.events += changed
            m = gather_discs(k, work)


@unit
def pass_fixed(k, work, n, p, max_events, max_steps):
    """Traverse the layer; the clock gets the code."""
    work.clock[0].code = traverse_fixed(k, work, n, p, max_events, max_steps)


@kernel
def _step(k, m, work, h, p):
    d, u, impulse, force = work.vector[D], work.vector[U], work.vector[P], work.vector[SCRATCH]
    for i in range(k):
        d[i] -= 0.5 * h * u[3 * i]
    normal_forces(k, work, d, p, force)
    for i in range(3 * k):
        force[i] *= h
        impulse[i] += force[i]
    add_velocity(3 * k, work.matrix[MASS], force, u)
    if m > 0:
        slot, c, t = work.index[DISC], work.vector[DISC_C], work.vector[DISC_T]
        largest = 0.0
        for s in range(m):
            a = 3 * slot[s]
            work.vector[RADIUS, s] = work.contact[slot[s]].mu * force[a]
            c[2 * s], c[2 * s + 1] = u[a + 1], u[a + 2]
            largest = max(largest, abs(u[a + 1]), abs(u[a + 2]))
        friction(
            m, work.matrix[DISCS], work.matrix[JACOBIAN], work.vector, work.index,
            _TOLERANCE + 1e-14 * largest,
        )  # fmt: skip
        for s in range(m):
            i = slot[s]
            a = 3 * i
            x, y = t[2 * s], t[2 * s + 1]
            loss = -(x * u[a + 1] + y * u[a + 2])
            impulse[a + 1] += x
            impulse[a + 2] += y
            work.contact[i].loss += max(0.0, loss)
        set_velocity(k, work)
    for i in range(k):
        d[i] -= 0.5 * h * u[3 * i]


@kernel
def _switch(k, work, p):
    """Change the modes as the state at the end of a step requires; return the number of changes."""
    changed = 0
    for i in range(k):
        c, d = work.contact[i], work.vector[D, i]
        u_n, p_n = work.vector[U, 3 * i], work.vector[P, 3 * i]
        mode = c.mode
        if c.mode == law.OPEN:
            if d > c.d0 and u_n < 0.0:
                law.close(c)
        elif c.mode == law.LOAD:
            if u_n > ROUND_OFF:
                if d - c.d0 > ROUND_OFF:
                    law.unload(c, d, p_n)
                else:
                    law.release(c, d, p_n, p)
        elif not d > c.rest:
            law.release(c, d, p_n, p)
        elif d - c.d0 > c.most and u_n < 0.0:
            law.load_again(c, p_n)
        if c.mode != mode:
            changed += 1
    return changed
