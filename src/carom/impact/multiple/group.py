"""Contacts that act on each other, in scaled variables: as one contact, through their layers, or at once."""

from __future__ import annotations

from carom._compiled.decorators import by_reference, kernel
from carom._compiled.units import unit
from carom.impact import layout as one
from carom.impact.multiple import layout as o
from carom.impact.multiple.classes import couple, parts_others
from carom.impact.multiple.layer import start
from carom.impact.multiple.moreau import solve_group
from carom.impact.multiple.restitution import any_targets, energetic, iterate_restitution, run
from carom.impact.multiple.series import into_lanes
from carom.impact.multiple.slip_law import by_law
from carom.impact.multiple.steps import ENDED
from carom.impact.multiple.tangential import return_slips
from carom.impact.resolve import resolve
from carom.impact.resolve_by_slip import SlipFriction, resolve_by_slip
from carom.impact.tangential import return_slip
from carom.impact.thresholds import COARSE_TOLERANCE
from carom.law import impact_laws
from carom.law.friction import depends_on_slip


@kernel
def strike_group(g, contacts, still, by_newton, settings, workspace):
    """Resolve the classes of group `g`; write impulses and works of their contacts.

    With `by_newton` they are one contact problem, without the passage of the layer.
    """
    work, out = workspace.work, workspace.blow.result
    summary = out.summary[0]
    n = _gather(g, contacts, still, summary.classes, work)
    if n == 0 or (n == 1 and not by_newton and _exactly(contacts, still, work, out) == one.OK):
        return
    mass, speed, rate = _fill(n, contacts, still, settings.exponent, work)
    if not (mass > 0.0 and rate > 0.0):
        return
    plastic = summary.plastic_change
    summary.plastic_change = 0.0
    by_slip = False
    for a in range(n):
        by_slip = by_slip or by_law(work.contact[a])
    passage = by_reference(
        o.Passage(
            settings.rtol, settings.exponent, settings.max_events, settings.max_steps,
            settings.max_rounds, by_slip, speed, contacts.laws,
        )
    )  # fmt: skip
    if by_newton:
        at_once(n, work, passage, summary)
    else:
        pass_group(n, work, passage, summary)
    return_slips(n, work, passage)
    energy, index = speed * speed / mass, work.index
    for i in range(contacts.k):
        for a in range(n):
            if index[o.CLASS, i] == index[o.MEMBER, a]:
                c, share = work.contact[a], 1.0 / index[o.CLASS_SIZE, index[o.MEMBER, a]]
                for r in range(3):
                    out.impulse[3 * i + r] = work.vector[o.NOW_P, 3 * a + r] * share * speed / mass
                out.compression[i] = -max(0.0, c.absorbed) * share * energy
                out.restitution[i] = max(0.0, c.returned) * share * energy
                out.friction[i] = max(0.0, c.loss) * share * energy
                out.wedged[i] = c.wedged
    summary.plastic_change = plastic + energy * summary.plastic_change


@kernel
def _gather(g, contacts, still, classes, work):
    """List the classes of group `g` and write W between them; return their number, 0 if none strikes."""
    index, n, strikes = work.index, 0, False
    for q in range(classes):
        if index[o.GROUP, q] == g:
            index[o.MEMBER, n] = q
            n += 1
            strikes = strikes or contacts.u[3 * index[o.FIRST_MEMBER, q]] < -still
    if not strikes:
        return 0
    for a in range(n):
        for b in range(n):
            couple(contacts, index, a, b, work.matrix[o.MASS])
    return n


@kernel
def _fill(n, contacts, still, exponent, work):
    """Scale the group and write its contacts; return the scales of W and u, and the scale of the rate."""
    u, mu, kappa = contacts.u, contacts.friction, contacts.stiffness
    index, W = work.index, work.matrix[o.MASS]
    mass, speed, most, stiff = 0.0, 0.0, 0.0, 0.0
    for a in range(n):
        i = index[o.FIRST_MEMBER, index[o.MEMBER, a]]
        mass = max(mass, W[3 * a, 3 * a])
        speed = max(speed, -u[3 * i])
        for r in range(3 if mu[i] > 0.0 else 1):
            most = max(most, abs(u[3 * i + r]))
        stiff = max(stiff, kappa[i] * index[o.CLASS_SIZE, index[o.MEMBER, a]] * W[3 * a, 3 * a])
    if not (mass > 0.0 and stiff > 0.0):
        return 0.0, 0.0, 0.0
    speed = max(speed, 1e-3 * most)
    for a in range(3 * n):
        row = W[a]
        for b in range(3 * n):
            row[b] /= mass
    for a in range(n):
        q = index[o.MEMBER, a]
        i = index[o.FIRST_MEMBER, q]
        c = work.contact[a]
        c.mu, c.restitution, c.law = mu[i], contacts.restitution[i], contacts.law[i]
        c.by_slip = 1 if mu[i] > 0.0 and depends_on_slip(contacts.laws, c.law) else 0
        c.e, c.members = c.restitution, index[o.CLASS_SIZE, q]
        c.root = (kappa[i] * index[o.CLASS_SIZE, q] * mass / stiff) ** (1.0 / exponent)
        c.grip = mu[i] * (W[3 * a + 1, 3 * a + 1] + W[3 * a + 2, 3 * a + 2])
        for r in range(3):
            work.vector[o.U0, 3 * a + r] = u[3 * i + r] / speed if r == 0 or mu[i] > 0.0 else 0.0
        if abs(u[3 * i]) <= still:
            work.vector[o.U0, 3 * a] = 0.0
        c.approach = max(0.0, -work.vector[o.U0, 3 * a])
    return mass, speed, stiff


@kernel
def _exactly(contacts, still, work, out):
    """Resolve a group of one class as one contact; return OK or NOT_RESOLVED.

    If its forces separate other contacts, or it is one impact of a sequence, it returns no more energy than it
    has absorbed, like each of several contacts. If it separates others and e = 0, the result is NOT_RESOLVED:
    all of them are one plastic event.
    """
    index, W, before = work.index, work.matrix[o.SINGLE], work.vector[o.SINGLE_U]
    q = index[o.MEMBER, 0]
    i = index[o.FIRST_MEMBER, q]
    mu, e, law = contacts.friction[i], contacts.restitution[i], contacts.law[i]
    parts = parts_others(contacts.k, contacts.W, i, index)
    if parts and not e > 0.0:
        return o.NOT_RESOLVED
    for r in range(3):
        before[r] = contacts.u[3 * i + r] if r == 0 or mu > 0.0 else 0.0
        for s in range(3):
            W[r, s] = work.matrix[o.MASS, r, s]
    single, summary = work.single, out.summary[0]
    single[one.STILL] = still
    several = parts or contacts.others > 0
    slip = by_reference(SlipFriction(mu, law, contacts.laws))
    code = resolve_single(work, slip, e, contacts.laws.table[law].impact_law)
    if several and code == one.OK and single[one.WORK_R] > -single[one.WORK_C]:
        code = resolve_single(work, slip, 1.0, impact_laws.STRONGE)
        summary.marks |= o.CAPPED
    if code != one.OK:
        return o.NOT_RESOLVED
    e_t = contacts.laws.table[law].tangential_restitution
    if e_t != 0.0:
        return_slip(W, before, mu, e_t, single)
    share = 1.0 / index[o.CLASS_SIZE, q]
    for j in range(contacts.k):
        if index[o.CLASS, j] == q:
            for r in range(3):
                out.impulse[3 * j + r] = single[one.IMPULSE + r] * share
            out.compression[j] = single[one.WORK_C] * share
            out.restitution[j] = single[one.WORK_R] * share
            out.friction[j] = single[one.FRICTION_LOSS] * share
            out.wedged[j] = 1 if int(single[one.PHASES]) & one.WEDGED != 0 else 0
    if not several:
        summary.marks |= o.EXACT
    summary.steps += int(single[one.STEPS])
    return one.OK


@kernel
def all_plastic(k, work):
    """Return whether e = 0 at all contacts."""
    for i in range(k):
        if work.contact[i].restitution > 0.0:
            return False
    return True


@kernel
def pass_group(k, work, settings, result):
    """Resolve the group of `k` contacts in `work`; row U0 has the velocities before, row P gets the impulses.

    If `left` of the clock is below 0 at the end, the group was stopped, because it took too many steps.
    """
    energetic(k, work, settings)
    start(k, work)
    if all_plastic(k, work):
        at_once(k, work, settings, result)
        return
    into_lanes(k, work)
    iterates = any_targets(k, work, settings)
    rtol = max(settings.rtol, COARSE_TOLERANCE) if iterates else settings.rtol
    ended = run(k, work, settings, rtol)
    if iterates and ended == ENDED:
        ended = iterate_restitution(k, work, settings, result)
    result.steps += work.clock[0].steps
    result.events += work.clock[0].events
    work.clock[0].left -= work.clock[0].steps
    if ended != ENDED and work.clock[0].left >= 0:
        at_once(k, work, settings, result)


@kernel
def at_once(k, work, passage, result):
    """Resolve the group as one contact problem."""
    marks, change = solve_group(k, work, passage)
    result.plastic_change += change
    result.marks |= marks


@unit
def resolve_single(work, slip, e, impact_law) -> int:
    """Resolve the impact of one contact; return its code."""
    W, u = work.matrix[o.SINGLE], work.vector[o.SINGLE_U]
    if slip.bound > 0.0 and depends_on_slip(slip.laws, slip.law):
        return resolve_by_slip(W, u, slip, e, impact_law, work.single)
    return resolve(W, u, slip.bound, e, impact_law, work.single)
