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
from carom.impact.thresholds import APPROACH_PART, COARSE_TOLERANCE
from carom.law import impact_laws
from carom.law.friction import depends_on_slip


@kernel
def strike_group(g, by_newton, settings, laws, workspace):
    """Resolve the classes of group `g`; write impulses and works of their contacts.

    With `by_newton` they are one contact problem, without the passage of the layer.
    """
    work, blow = workspace.work, workspace.blow
    out = blow.result
    summary = out.summary[0]
    n = _gather(g, summary.classes, blow, work.W)
    if n == 0 or (n == 1 and not by_newton and _exactly(laws, blow, work) == one.OK):
        return
    mass, speed, rate = _fill(n, laws, settings.exponent, blow, work)
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
            settings.max_rounds, by_slip, summary.marks & o.FINAL_SLIP != 0, speed, laws,
        )
    )  # fmt: skip
    if by_newton:
        at_once(n, work, passage, summary)
    else:
        pass_group(n, work, passage, summary)
    return_slips(n, work, passage)
    energy, impulse = speed * speed / mass, work.now.impulse
    for i in range(blow.impact[0].k):
        for a in range(n):
            if blow.contacts.contact[i].of_class == blow.members[a]:
                c, share = work.contact[a], 1.0 / blow.classes[blow.members[a]].members
                for r in range(3):
                    out.impulse[3 * i + r] = impulse[3 * a + r] * share * speed / mass
                out.compression[i] = -max(0.0, c.absorbed) * share * energy
                out.restitution[i] = max(0.0, c.returned) * share * energy
                out.friction[i] = max(0.0, c.loss) * share * energy
                out.wedged[i] = c.wedged
    summary.plastic_change = plastic + energy * summary.plastic_change


@kernel
def _gather(g, classes, blow, W):
    """List the classes of group `g` and write W between them; return their number, 0 if none strikes."""
    n, strikes = 0, False
    for q in range(classes):
        if blow.classes[q].group == g:
            blow.members[n] = q
            n += 1
            strikes = strikes or blow.contacts.u[3 * blow.classes[q].first] < -blow.impact[0].still
    if not strikes:
        return 0
    for a in range(n):
        for b in range(n):
            couple(blow, a, b, W)
    return n


@kernel
def _fill(n, laws, exponent, blow, work):
    """Scale the group and write its contacts; return the scales of W and u, and the scale of the rate."""
    u, contact, classes, members = (
        blow.contacts.u, blow.contacts.contact, blow.classes, blow.members,
    )  # fmt: skip
    W, before, still = work.W, work.before, blow.impact[0].still
    mass, speed, most, stiff = 0.0, 0.0, 0.0, 0.0
    for a in range(n):
        all_of, i = classes[members[a]], classes[members[a]].first
        mass = max(mass, W[3 * a, 3 * a])
        speed = max(speed, -u[3 * i])
        for r in range(3 if contact[i].acting > 0.0 else 1):
            most = max(most, abs(u[3 * i + r]))
        stiff = max(stiff, contact[i].stiffness * all_of.members * W[3 * a, 3 * a])
    if not (mass > 0.0 and stiff > 0.0):
        return 0.0, 0.0, 0.0
    speed = max(speed, APPROACH_PART * most)
    for a in range(3 * n):
        row = W[a]
        for b in range(3 * n):
            row[b] /= mass
    for a in range(n):
        all_of, i = classes[members[a]], classes[members[a]].first
        c, given = work.contact[a], contact[i]
        mu = given.acting
        c.mu, c.restitution, c.law = mu, given.restitution, given.law
        c.by_slip = 1 if mu > 0.0 and depends_on_slip(laws, c.law) else 0
        c.e = c.restitution
        c.root = (given.stiffness * all_of.members * mass / stiff) ** (1.0 / exponent)
        c.grip = mu * (W[3 * a + 1, 3 * a + 1] + W[3 * a + 2, 3 * a + 2])
        for r in range(3):
            before[3 * a + r] = u[3 * i + r] / speed if r == 0 or mu > 0.0 else 0.0
        if abs(u[3 * i]) <= still:
            before[3 * a] = 0.0
        c.approach = max(0.0, -before[3 * a])
    return mass, speed, stiff


@kernel
def _exactly(laws, blow, work):
    """Resolve a group of one class as one contact; return OK or NOT_RESOLVED.

    If its forces separate other contacts, or it is one impact of a sequence, it returns no more energy than it
    has absorbed, like each of several contacts. If it separates others and e = 0, the result is NOT_RESOLVED:
    all of them are one plastic event.
    """
    W, before, single, out = work.single.W, work.single.u, work.single.out, blow.result
    q, contact = blow.members[0], blow.contacts.contact
    i = blow.classes[q].first
    mu, e, law = contact[i].acting, contact[i].restitution, contact[i].law
    parts = parts_others(blow, i)
    if parts and not e > 0.0:
        return o.NOT_RESOLVED
    for r in range(3):
        before[r] = blow.contacts.u[3 * i + r] if r == 0 or mu > 0.0 else 0.0
        for s in range(3):
            W[r, s] = work.W[r, s]
    summary = out.summary[0]
    single[one.STILL] = blow.impact[0].still
    several = parts or blow.impact[0].others > 0
    slip = by_reference(SlipFriction(mu, law, laws))
    code = resolve_single(work.single, slip, e, laws.table[law].impact_law)
    if several and code == one.OK and single[one.WORK_R] > -single[one.WORK_C]:
        code = resolve_single(work.single, slip, 1.0, impact_laws.STRONGE)
        summary.marks |= o.CAPPED
    if code != one.OK:
        return o.NOT_RESOLVED
    e_t = laws.table[law].tangential_restitution
    if e_t != 0.0:
        return_slip(W, before, mu, e_t, single)
    share = 1.0 / blow.classes[q].members
    for j in range(blow.impact[0].k):
        if contact[j].of_class == q:
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
    """Resolve the group of `k` contacts in `work`, from the velocities `before`.

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
def resolve_single(given, slip, e, impact_law) -> int:
    """Resolve a `SingleImpact`; return its code."""
    if slip.bound > 0.0 and depends_on_slip(slip.laws, slip.law):
        return resolve_by_slip(given.W, given.u, slip, e, impact_law, given.out)
    return resolve(given.W, given.u, slip.bound, e, impact_law, given.out)
