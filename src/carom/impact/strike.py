"""An impact within a run: pre-impact velocity, effective mass, boundary layer, new velocities, record."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, inlined, kernel
from carom._compiled.units import unit
from carom.contact.closed_points import concerns, gather_closed
from carom.contact.gap import round_off, slow
from carom.contact.groups import label_groups
from carom.contact.operations import strike_point
from carom.dynamics.contact_impulse import add_velocity, spread
from carom.dynamics.delassus import inverse_masses, velocities
from carom.dynamics.forces import potential_energy
from carom.dynamics.project import project_velocity
from carom.impact import layout
from carom.impact.collapse import count_blow, effective_restitution
from carom.impact.driven import blocked, driven_work
from carom.impact.layer import traverse
from carom.impact.mean_point import as_one
from carom.impact.record import note_drive, write_impact
from carom.impact.resolve import resolve
from carom.impact.resolve_by_slip import SlipFriction, resolve_by_slip
from carom.impact.return_map import return_map
from carom.impact.strike_together import strike_together
from carom.impact.tangential import return_slip
from carom.impact.thresholds import SEED
from carom.impact.work_mode import restore_work
from carom.kinematics.contact_point import contact_velocity
from carom.kinematics.moving_surfaces import set_surfaces
from carom.law import impact_laws
from carom.law.friction import bound_of_stick, depends_on_slip
from carom.model.controls import LOCATE, WORK
from carom.model.event_rows import begin_event, end_event
from carom.model.laws import PERSISTENT, STRIKES
from carom.model.method import THREE_FIELD
from carom.model.records import FULL_MULTIPLE, GROW, IMPACT, JAMS
from carom.status import BLOCKED, IMPACT_FAILED, RETURN_MAP_FAILED, TOO_MANY_POINTS


@kernel
def onto_surface(system, controls, c, state, work):
    """Move the body to the surface and write its striking point to work.hit; return 0 or a status.

    After a located impact this is the last correction. After a complete step it is the return map of the paper,
    and velocities are projected on the joints again at the new position.
    """
    contact, point = system.contacts[c], work.hit[0].point
    tie = controls.tie * contact.extent
    tolerance = max(controls.gap * contact.extent, round_off(contact, state))
    rho, _ = strike_point(system, contact, state, tie, point)
    if rho >= -(tie if controls.location == LOCATE else tolerance):
        return 0
    before = potential_energy(system, state, work.moment[0].time)
    if return_map(system, contact, state, work, tie, tolerance) < 0:
        return RETURN_MAP_FAILED
    project_velocity(system, state, False, work)
    strike_point(system, contact, state, tie, point)
    if controls.location == WORK:
        drop = before - potential_energy(system, state, work.moment[0].time)
        restore_work(system, contact, state, drop, work)
    return 0


@unit
def strike(model, data, method, c):
    """Solve the impact of contact c, together with all closed points of its group.

    The results in work.hit are 0 or the number of a `Status`, and the number of closed points if there was an
    impact. The velocities of `state` change; its position changes only by the return map.
    """
    system, controls = model.system, model.controls
    active, state, group, work, records = (
        data.active, data.state, data.group, data.work, data.records,
    )  # fmt: skip
    contact, hit, clock = system.contacts[c], work.hit[0], data.clocks[0]
    hit.closed = 0
    set_surfaces(system, clock.now)
    hit.code = onto_surface(system, controls, c, state, work)
    if hit.code != 0:
        return
    k = gather_closed(model, data, c, True)
    if k < 0:
        hit.code = TOO_MANY_POINTS
        return
    approach, jams = 0.0, False
    for i in range(k):
        closed_point = group.closed[i]
        jams = jams or (closed_point.active >= 0 and active.points[closed_point.active].jams == 1)
        u = contact_velocity(system, group.points[0][i], state)[0]
        if u < -slow(system.contacts[closed_point.contact], state):
            approach = min(approach, u)
            active.contact_states[closed_point.contact].broken = 0
    if approach < 0.0 or jams:
        hit.closed = max(k, 2) if jams else k  # after a jam active points are always decided again
        if k > 1:
            inverse_masses(system, k, group.points[0], state, work, group.problem.W)
            velocities(system, k, group.points[0], state, group.u)
        single = as_one(system, k, state, group, work)
        if not single and data.multiple.contact.shape[0] < k:
            work.step[0].grow, hit.code = FULL_MULTIPLE, GROW
            return
        begin_event(system, c, group.closed[0].feature, state, clock, records)
        first = clock.struck
        if single:
            law = contact.law[STRIKES]
            if approach == 0.0:
                law = contact.law[PERSISTENT]
                hit.u[0] = -SEED * math.sqrt(hit.u[1] ** 2 + hit.u[2] ** 2)
            strike_one(model, data, method, c, law)
        else:
            strike_together(model, data, c, k)
        if hit.code != 0:
            return
        project_velocity(system, state, False, work)
        clock.loads += driven_work(system, state, first, clock, records, work)
        end_event(system, c, JAMS if jams else IMPACT, state, clock, records)
        forget_jams(active, k, group)
        for i in range(active.contact_states.shape[0]):
            if concerns(system.contacts[i], work.body[contact.body].label, work):
                active.contact_states[i].near = 1
        label_groups(system, active, work)
    if controls.location != LOCATE:  # other contacts may have penetrated as well
        for i in range(active.contact_states.shape[0]):
            active.contact_states[i].near = 1


@kernel
def forget_jams(active, k, group):
    """Remove the mark of a jam from the active points of this impact, which ended it."""
    for i in range(k):
        if group.closed[i].active >= 0:
            active.points[group.closed[i].active].jams = 0


@kernel
def strike_one(model, data, method, c, law):
    """Solve the impact of the one point in work.struck, with W and u in work.hit, by the law of this number."""
    system, controls = model.system, model.controls
    active, state, work, clock = data.active, data.state, data.work, data.clocks[0]
    contact, hit, point, laws = system.contacts[c], work.hit[0], work.struck[0], system.laws
    hit.out[layout.STILL] = slow(contact, state)
    hit.friction, hit.impact_law = bound_of_stick(laws, law), laws.table[law].impact_law
    if blocked(system, point, hit.W[0, 0]):
        hit.code = BLOCKED
        return
    count_blow(system, controls, contact, active.contact_states[c], -hit.u[0], clock.now)
    hit.restitution = effective_restitution(system, contact, active.contact_states[c], -hit.u[0])
    if depends_on_slip(laws, law):
        slip = by_reference(SlipFriction(hit.friction, law, laws))
        code = resolve_by_slip(hit.W, hit.u, slip, hit.restitution, hit.impact_law, hit.out)
    else:
        code = collide(method, controls, contact, hit, work.history)
    if code != layout.OK:
        hit.code = IMPACT_FAILED
        return
    e_t = laws.table[law].tangential_restitution
    if e_t != 0.0:
        return_slip(hit.W, hit.u, hit.friction, e_t, hit.out)
    write_impact(contact, state, point, hit, clock, data.records)
    impulse = hit.out[layout.IMPULSE : layout.IMPULSE + 3]
    note_drive(system, point, state, impulse, clock)
    spread(system, point, state, impulse, work)
    add_velocity(system, point, work, state)


@inlined
def collide(method, controls, contact, hit, history):
    """Solve the impact in work.hit by the method of the run: to round-off, or as in the paper."""
    if method.kind == THREE_FIELD and hit.impact_law not in impact_laws.WITHOUT_PATH:
        return by_layer(controls, contact, hit, history)
    return resolve(hit.W, hit.u, hit.friction, hit.restitution, hit.impact_law, hit.out)


@unit
def by_layer(controls, contact, hit, history) -> int:
    """Pass the boundary layer by cubic splines."""
    layer = (contact.width, contact.penetration, controls.layer_steps)
    return traverse(hit, hit.impact_law, layer, history)
