"""One impact with friction by the final slip, the law of Moreau: one contact problem, without a path.

    u+ = u- + W P,    0 <= P_n _|_ u_n+ + e u_n- >= 0,    |P_t| <= mu P_n,    P_t = -mu P_n u_t+/|u_t+| in slip,

which is that of `carom.friction` with u_n- (1 + e) in the place of u_n-. A coefficient that depends on the slip
is that of the slip after, found by bisection (mathematics page, §1.10).

The works of the normal force are those of a spring whose unloading gives back e of the impulse and e^2 of the
work of loading, and friction gets the rest of the change of energy, -P_t.(u_t- + u_t+)/2. This may be a gain:
only P_t.u_t+ <= 0 is certain.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.one_contact import solve_one
from carom.geometry.thresholds import REMAINDER
from carom.impact import layout as o
from carom.law.friction import friction_at

BISECTIONS = 120


@kernel
def by_final_slip(m, u, mu, e, units, out):
    """Solve one impact in scaled variables: W as its upper triangle; return a code.

    If W is singular friction may wedge the pair so that no velocity has this e: then e = 0.
    """
    found, p, p1, p2 = solve_one(m, ((1.0 + e) * u[0], u[1], u[2]), mu)
    phases = 0
    if not (found and 0.0 < p < math.inf):  # friction wedges the pair: no velocity has this e
        found, p, p1, p2 = solve_one(m, u, mu)
        phases = o.WEDGED
        if not (found and 0.0 < p < math.inf):
            return o.NO_END
    after = _after(m, u, (p, p1, p2))
    slip, size = math.sqrt(after[1] ** 2 + after[2] ** 2), abs(u[0]) + abs(u[1]) + abs(u[2])
    if slip > REMAINDER * size:
        phases |= o.PHASE_SLIP
    else:
        after = (after[0], 0.0, 0.0)
        if mu > 0.0:
            phases |= o.PHASE_STICK
    _write(out, units, u, after, (p, p1, p2))
    out[o.PHASES] = phases
    return o.OK


@kernel
def _after(m, u, P):
    """Return u + W P."""
    return (
        u[0] + m[0] * P[0] + m[1] * P[1] + m[2] * P[2],
        u[1] + m[1] * P[0] + m[3] * P[1] + m[4] * P[2],
        u[2] + m[2] * P[0] + m[4] * P[1] + m[5] * P[2],
    )


@kernel
def _write(out, units, u, after, P):
    """Write velocities, impulses and works, in the units of the caller."""
    v, one = units[0], units[0] / units[1]
    work, loaded = v * one, u[0] / (u[0] - max(0.0, after[0]))
    for i in range(3):
        out[o.VELOCITY + i] = after[i] * v
        out[o.IMPULSE + i] = P[i] * one
        out[o.COMPRESSION + i] = loaded * P[i] * one
    normal = works(u[0], after[0], P[0])
    loss = 0.0 - 0.5 * (P[1] * (u[1] + after[1]) + P[2] * (u[2] + after[2]))
    out[o.WORK_C], out[o.WORK_R] = normal[0] * work, normal[1] * work
    out[o.FRICTION_LOSS] = loss * work
    out[o.ENERGY_CHANGE] = (normal[0] + normal[1] - loss) * work
    out[o.P_C] = loaded * P[0] * one
    out[o.STEPS], out[o.SLIP_END_P], out[o.SLIP_END_UN] = 1.0, -1.0, 0.0
    out[o.DURATION], out[o.X_MIN], out[o.KNOTS] = 0.0, 0.0, 0.0


@kernel
def works(before, after, impulse):
    """Return the works of the normal force in loading and unloading, from u_n- and u_n+ and its impulse.

    Their sum is P_n (u_n- + u_n+)/2, and their ratio -e^2, with e = u_n+/-u_n-.
    """
    total = 0.5 * impulse * (before + after)
    if not before < 0.0:
        return min(0.0, total), max(0.0, total)
    ends = max(0.0, after)
    back = 0.5 * impulse * ends * (ends / (ends - before))
    return total - back, back


@unit
def by_final_slip_of_law(m, u, friction, e, units, out) -> int:
    """Solve one impact by a law of friction, `SlipFriction`: its mu is that at the slip after, by bisection.

    What the bound of stick holds sticks.
    """
    low, high = 0.0, 2.0
    code = by_final_slip(m, u, friction.bound, e, units, out)
    if code != o.OK or int(out[o.PHASES]) & o.PHASE_STICK != 0:
        return code
    while _slip(out) > high * units[0] and high < 1e6:
        high *= 2.0
    for _ in range(BISECTIONS):
        slip = 0.5 * (low + high)
        mu = friction_at(friction.laws, friction.law, slip * units[0])
        code = by_final_slip(m, u, mu, e, units, out)
        if code != o.OK or not low < slip < high:
            return code
        if _slip(out) > slip * units[0]:
            low = slip
        else:
            high = slip
    return code


@kernel
def _slip(out):
    """Return the slip after."""
    return math.sqrt(out[o.VELOCITY + 1] ** 2 + out[o.VELOCITY + 2] ** 2)
