"""The motion of a crowd without contacts, and the work of loads on this motion and on the actual path."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.contact_impulse import gain
from carom.dynamics.elements.relation import prescribed
from carom.dynamics.explicit import copy_state, rubs
from carom.dynamics.forces import applied_wrenches, difference_of_loads
from carom.dynamics.project import shift
from carom.dynamics.solve import solve
from carom.dynamics.step import step
from carom.geometry.rotation import conjugate, log, multiply, turn
from carom.kinematics.combination import rate
from carom.kinematics.flight import free_flight
from carom.persistent.contact_step import contact_step
from carom.stepping.energy_balance import unbalanced

TOO_LONG = -1  # the piece is too long


@kernel
def is_loaded(system):
    """Return whether joints or forces act on a body, besides gravity."""
    for b in range(system.bodies.shape[0]):
        if system.bodies[b].ballistic == 0:
            return True
    return False


@kernel
def fly(model, data, method, h, loaded, cut):
    """Write the motion without contacts to `crowd.flight`, and its middle for loaded bodies.

    Return a code, and the power of this path (`power_of_path`) of loads and of friction in joints.
    With `cut` the code is `TOO_LONG` if the energy error of this motion is larger than a step may have.
    """
    system, active, now, crowd, work = model.system, data.active, data.state, data.crowd, data.work
    search, code, loads, friction = work.search[0], 0, 0.0, 0.0
    if loaded:
        count, active.count[0] = active.count[0], 0
        work.moment[0].start = work.step[0].begin + work.step[0].spent
        applied, code = step(model, data, method, h)
        search.applied, search.friction = applied, 0.0
        if rubs(system) and code == 0:
            applied, search.friction, code = contact_step(model, data, method, h)
            search.applied += applied
        for b in range(now.shape[0]):
            copy_state(work.trial[b], crowd.flight[b])
            halfway(now[b], crowd.flight[b], crowd.flight_middle[b])
        if code == 0 and cut:  # forces may be too stiff for a step of this length
            named = search.applied + search.friction
            off, grows = unbalanced(model, data, named, work.moment[0].start, h)
            code = TOO_LONG if grows or off > 1.0 else 0
        loads, friction = power_of_path(system, h, now, crowd.flight, crowd.middle, work)
        active.count[0] = count
    else:
        for b in range(now.shape[0]):
            free_flight(system.bodies[b], system.gravity, h, now[b], crowd.flight[b], work.body[b])
    return code, loads, friction


@kernel
def halfway(start, end, out):
    """Write the middle state of a body: mean position and velocities, half the rotation."""
    p, q, Q = start.Q, end.Q, out.Q
    a = log(multiply(q, conjugate(p)))
    Q[0], Q[1], Q[2], Q[3] = p[0], p[1], p[2], p[3]
    turn(Q, 0.5 * a[0], 0.5 * a[1], 0.5 * a[2])
    for k in range(3):
        out.x[k] = 0.5 * (start.x[k] + end.x[k])
        out.v[k] = 0.5 * (start.v[k] + end.v[k])
        out.w[k] = 0.5 * (start.w[k] + end.w[k])


@kernel
def friction_powers(system, state, t):
    """Return the powers of drives with limits and of friction in joints, by the last forces in contact."""
    relations, driven, power = system.relations, 0.0, 0.0
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        force = one.arm * relations.memory.frictions[i].force[1]
        goal = prescribed(relations, one, t)[1] if one.drives == 1 else 0.0
        speed = rate(system, relations.coordinates[one.coordinate], state)
        driven += force * goal
        power += force * (speed - goal)
    return driven, power


@kernel
def power_of_path(system, h, start, end, middle, work):
    """Return P_start + 4 P_middle + P_end of loads, and of friction in joints, on a path of linear velocities.

    Times h/6 this is the work, by Simpson's rule: the power of dampers is quadratic in time.
    """
    moment, begin = work.moment[0], work.moment[0].start
    for b in range(start.shape[0]):
        halfway(start[b], end[b], middle[b])
    moment.time = begin
    loads, (driven, friction) = (
        applied_wrenches(system, start, False, work),
        friction_powers(system, start, moment.time),
    )
    loads += driven
    moment.time = begin + 0.5 * h
    driven, slip = friction_powers(system, middle, moment.time)
    loads += 4.0 * (applied_wrenches(system, middle, False, work) + driven)
    friction += 4.0 * slip
    moment.time = begin + h
    driven, slip = friction_powers(system, end, moment.time)
    loads += applied_wrenches(system, end, False, work) + driven
    return loads, friction + slip


@kernel
def work_on_path(done, h, free, taken):
    """Return the work on the actual path, of which `done` was done on the path without contacts.

    `free` and `taken` are the powers of both paths (`power_of_path`). What the rule misses of the free path is
    added in proportion: all of it where the paths are the same, and nothing at rest, where no force does work.
    """
    simple, own = h / 6.0 * free, h / 6.0 * taken
    part = min(1.0, own / simple) if own * simple > 0.0 else 0.0
    return own + part * (done - simple)


@kernel
def greatest_change(system, start, end):
    """Return the greatest change of velocity of a point of the bodies."""
    most = 0.0
    for b in range(start.shape[0]):
        for j in range(3):
            turning = system.bodies[b].extent * abs(end[b].w[j] - start[b].w[j])
            most = max(most, max(abs(end[b].v[j] - start[b].v[j]), turning))
    return most


@kernel
def follow_path(system, h, start, end, crowd, work):
    """Add to the flight the effect of loads on the actual path minus their effect on the path without contacts.

    A damper then acts on the speed with contacts. Return whether there is a difference.
    """
    for b in range(start.shape[0]):
        halfway(start[b], end[b], crowd.middle[b])
    if not difference_of_loads(system, h, crowd.middle, crowd.flight_middle, work):
        return False
    solve(system, crowd.flight, False, work)
    for b in range(start.shape[0]):
        gain(work.body[b].motion, crowd.flight[b])
        shift(work.body[b].motion, 0.5 * h, crowd.flight[b])
    return True
