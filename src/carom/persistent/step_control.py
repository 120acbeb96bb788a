"""Step control of a group by its energy error: if the error is too large, the step is too long.

The normal of nearly parallel edges can turn within about 1e-5 s, with forces of 1e4 times the weight. A step of
order 2 over such a time loses energy, and friction is not the cause. With gravity alone the balance is known.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.contact.thresholds import SAFE_ROTATION
from carom.dynamics.energy import kinetic_of
from carom.dynamics.thresholds import RTOL
from carom.geometry.rotation import norm
from carom.model.actions import MODE_OPEN, MODE_SLIP, MODE_STICK
from carom.persistent import thresholds as limits
from carom.persistent.rows import bodies_of


@kernel
def lost_by(system, b, start, end):
    """Return the energy that a body on which gravity acts has lost in a step."""
    body, lost, g = system.bodies[b], kinetic_of(system.bodies[b], start[b]), system.gravity
    for k in range(3):
        lost += body.mass * g[k] * (end[b].x[k] - start[b].x[k])
    return lost - kinetic_of(body, end[b])


@kernel
def weigh(system, b, start, end):
    """Return the weight of a body times its size, or less if the body hardly moves."""
    body, g, fallen = system.bodies[b], system.gravity, 0.0
    for k in range(3):
        fallen += body.mass * g[k] * (end[b].x[k] - start[b].x[k])
    size = body.mass * norm(g) * body.extent
    turned = kinetic_of(body, start[b]) + kinetic_of(body, end[b]) + abs(fallen)
    return min(size, limits.EXCHANGE_FACTOR * turned + limits.LEAST_WEIGHT * size)


@kernel
def note_unnamed(model, data, label, named, h, push):
    """Note the change of energy in a step besides the `named` work, relative to the allowed loss.

    It is known of bodies on which only gravity acts. Implicit Euler, the closing member with a step of length
    h, also loses m (h a)^2/2 by an acceleration a. That is at most the sum of a at the start, what friction
    changes, at most `push`, and gravity: more is an impact, of a normal that jumps.
    """
    system, start, end, member = model.system, data.state, data.work.trial, data.group.bodies.member
    (count, loaded), lost, may, by_euler = bodies_of(model, data, label), named, 0.0, 0.0
    if loaded:
        return
    g, search = norm(system.gravity), data.work.search[0]
    fall = 0.5 * limits.FALL_LOSS * (model.controls.step * g) ** 2
    for m in range(count):
        b = member[m]
        body = system.bodies[b]
        lost += lost_by(system, b, start, end)
        by_euler += (
            body.mass * (h * (first_acceleration(system, b, data.work.stages) + push + g)) ** 2
        )
        may += limits.MOTION_LOSS * kinetic_of(body, start[b])
        may += min(body.mass * fall, limits.SIZE_LOSS * weigh(system, b, start, end))
    if count == 1:
        body = system.bodies[member[0]]
        may = kinetic_of(body, start[member[0]]) + body.mass * g * body.extent
        may *= limits.BODY_LOSS
    over = abs(lost) - min(by_euler, abs(lost))
    search.unnamed = max(search.unnamed, over / may if may > 0.0 else 0.0)


@kernel
def lost_in_stop(model, data, label, named):
    """Return what a body has lost beside the `named` work in a closing step that has stopped its slip.

    The power of friction is that at the end of such a step, where nothing slips. Points that stay closed have
    no other loss, so that friction has taken this, also where slip jams and only an impulse stops it. A normal
    that jumps, of several touches of two bodies, is an impact.
    """
    system, active, member, stops = model.system, data.active, data.group.bodies.member, False
    count, loaded = bodies_of(model, data, label)
    if loaded or count != 1:
        return 0.0
    for i in range(active.count[0]):
        active_point = active.points[i]
        if data.work.body[active_point.body].label == label:
            jumps = active_point.shares == 1 and active_point.fixed == 0
            if jumps or active_point.next == MODE_OPEN:
                return 0.0
            stops = stops or (active_point.mode == MODE_SLIP and active_point.next == MODE_STICK)
    b = member[0]
    return max(0.0, named + lost_by(system, b, data.state, data.work.trial)) if stops else 0.0


@kernel
def first_acceleration(system, b, stages):
    """Return the acceleration of a body at the start of a step, including that of its rotation at its size."""
    rate, linear, angular = stages[0, b].rate, 0.0, 0.0
    for r in range(3):
        linear, angular = linear + rate[r] * rate[r], angular + rate[3 + r] * rate[3 + r]
    return math.sqrt(linear) + system.bodies[b].extent * math.sqrt(angular)


@kernel
def turns_far(active, start, end, dt):
    """Return whether a body with an active point turns too far in a step."""
    for i in range(active.count[0]):
        active_point = active.points[i]
        spin = max(norm(start[active_point.body].w), norm(end[active_point.body].w))
        if active_point.rest == 0 and not dt * spin <= SAFE_ROTATION:
            return True
    return False


@kernel
def unsolved(controls, work, part):
    """Return whether the residual of the last trial step exceeds `part` of the speed that gravity gives."""
    gained = controls.step * controls.pull
    return gained > 0.0 and not work.search[0].residual <= part * gained


@inlined
def too_long(model, data):
    """Return whether a step with active points is to be cut, for want of a solution or for its loss."""
    controls = model.controls
    active, start, work, search = data.active, data.state, data.work, data.work.search[0]
    end, dt = work.trial, search.dt
    if active.count[0] == 0:
        return False
    if dt > limits.SHORTEST_RETRY * controls.step and unsolved(controls, work, limits.CUT_RESIDUAL):
        return True
    shortest = dt <= limits.SHORTEST_CUT * controls.step
    if controls.order == 0 and not shortest and turns_far(active, start, end, dt):
        return True
    search = work.search[0]
    if shortest:
        return False
    part = limits.CUT_SHARE if search.pace < math.inf else 1.0
    return not (search.unnamed <= part * by_tolerance(controls))


@kernel
def by_tolerance(controls):
    """Return by how much the tolerance of a run allows a greater loss than its default."""
    return max(1.0, controls.rtol / RTOL)


@inlined
def goes_wild(controls, work):
    """Return whether a group loses too much energy even in a step that must not be cut further.

    The limit grows with the root of the tolerance: with the tolerance itself a loss of a tenth of m g times
    the size would pass at 1e-4, which is more than the tolerance of the energy of a run.
    """
    return work.search[0].unnamed > limits.LOSS_LIMIT * math.sqrt(by_tolerance(controls))


@inlined
def next_pace(pace, work):
    """Return the limit for the next step: twice the last limit, unless the loss would be too large."""
    return 2.0 * pace if work.search[0].unnamed <= limits.GROWTH_SHARE * limits.CUT_SHARE else pace


@kernel
def rest_speed(controls, gained, residual, k, poorly):
    """Return the speed [m/s] below which bodies on k persistent points are at rest.

    It is `Options.rest_tolerance` of the speed `gained` from applied forces in the step, or the speed that the
    residual of k contacts may leave, if this is greater, but at most `poorly` times the former.
    """
    least = controls.rest * gained
    return max(least, min(k * residual, poorly * least))
