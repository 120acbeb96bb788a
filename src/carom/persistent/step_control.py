"""Step control of a group by its energy error: if the error is too large, the step is too long.

Edges that are nearly parallel turn their normal in some 1e-5 s, with forces of 1e4 times the weight: a step of
order 2 over all of such a push takes energy that no friction has. Where only gravity acts the balance is known.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.geometry.rotation import norm
from carom.model.allowance import affordable
from carom.model.arrays import LOOPS
from carom.model.workspace import ONE
from carom.persistent.middle_state import spin_momentum

# what a step of several bodies may lose: this part of the kinetic energy at its start, and of what a fall of a
# whole step gains, but no more than of m g times their size, which does not grow with the step; one that is cut
# is cut on until it loses CAREFUL of that
OF_MOTION, OF_FALL, OF_SIZE = 1e-6, 1e-2, 1e-7
# ... of a body that hardly moves not even that: of so many times what it exchanges in the step, and of this
# part of m g times its size, which is far above round-off
MUCH, LEAST = 1e3, 1e-4
CAREFUL = 0.01
SURE = 1.0 / 32.0  # of that: what a step may lose for the next to be twice as long (order 4: 2^5)
# of one body: these parts of its kinetic energy and of m g times its size, at one point and at several
OF_ONE, OF_SEVERAL = 1e-9, 2e-8
# ... and how far it may turn: the methods are of use for less than a radian
TURN = 0.5
# residual of contacts, as a part of what gravity gives in a step: where a step is cut, then taken whole; where
# there is nothing to take whole, and the run stops
UNSOLVED, USELESS = 0.01, 10.0
# what is solved so much worse than rest asks for is not rest: of a few bodies, and of a crowd
POORLY, MANY = 10.0, 1e3
# of the step: what is no longer is cut no more, for what it loses and for a solution
SHORTEST, RETRIED = 1e-4, 1e-2
# what is so many times more than may be lost, in a step that is cut no more, is not lost by its length: where a
# force grows without bound (near a jam, or as a rim becomes flat) no step is short enough, and it is taken
# whole in the end. Of groups, and of one body
WILD, GROSS = 100.0, 1e4
# about what a step without contacts takes of a body [us], with closed loops and without
LOOPS_STEP, OTHER_STEP = 25.0, 0.6
# of a search for impulses: what an iteration takes for k points, by k^2 [us]; how many it has in any case
ITERATION, SOME = 0.3, 100


@kernel
def kinetic(body, state):
    """Return the kinetic energy of a body."""
    q, v, w = state.Q, state.v, state.w
    l = spin_momentum(body, q, w[0], w[1], w[2])
    return 0.5 * (body.mass * norm(v) ** 2 + l[0] * w[0] + l[1] * w[1] + l[2] * w[2])


@kernel
def lost_by(system, b, start, end):
    """Return the energy that a body on which gravity acts has lost in a step."""
    body, lost, g = system.bodies[b], kinetic(system.bodies[b], start[b]), system.gravity
    for k in range(3):
        lost += body.mass * g[k] * (end[b].x[k] - start[b].x[k])
    return lost - kinetic(body, end[b])


@kernel
def may_lose(system, b, start, part):
    """Return a part of the kinetic energy of a body and of its weight times its size."""
    body = system.bodies[b]
    return part * (kinetic(body, start[b]) + body.mass * norm(system.gravity) * body.extent)


@kernel
def weigh(system, b, start, end):
    """Return the weight of a body times its size; less where it hardly moves: it is not what is looked at."""
    body, g, fallen = system.bodies[b], system.gravity, 0.0
    for k in range(3):
        fallen += body.mass * g[k] * (end[b].x[k] - start[b].x[k])
    size = body.mass * norm(g) * body.extent
    turned = kinetic(body, start[b]) + kinetic(body, end[b]) + abs(fallen)
    return min(size, MUCH * turned + LEAST * size)


@kernel
def unnamed(system, controls, start, end, friction, count, member):
    """Return what the step has lost or gained besides the work of friction, as a part of what it may."""
    lost, may = friction, 0.0
    fall = 0.5 * OF_FALL * (controls.step * norm(system.gravity)) ** 2
    for m in range(count):
        b = member[m]
        body = system.bodies[b]
        lost += lost_by(system, b, start, end)
        may += OF_MOTION * kinetic(body, start[b])
        may += min(body.mass * fall, OF_SIZE * weigh(system, b, start, end))
    if count == 1:
        may = may_lose(system, member[0], start, OF_SEVERAL)
    return abs(lost) / may if may > 0.0 else 0.0


@kernel
def unnamed_alone(system, start, end, friction, work):
    """Return the same of bodies in contact at one point each, on which gravity alone acts besides."""
    lost, may = friction, 0.0
    for b in range(start.shape[0]):
        if work.body[b].status == ONE:
            if system.bodies[b].ballistic == 0:
                return 0.0
            lost += lost_by(system, b, start, end)
            may += may_lose(system, b, start, OF_ONE)
    return abs(lost) / may if may > 0.0 else 0.0


@kernel
def turns_far(system, active, start, end, dt):
    """Return whether a body that is active turns too far in a step."""
    for i in range(active.count[0]):
        active_point = active.points[i]
        if (
            active_point.rest == 0
            and not dt * max(norm(start[active_point.body].w), norm(end[active_point.body].w))
            <= TURN
        ):
            return True
    return False


@kernel
def unsolved(system, controls, work, part):
    """Return whether contacts of the last trial step are off by that part of what gravity gives in one."""
    gained = controls.step * norm(system.gravity)
    return gained > 0.0 and not work.result[0].residual <= part * gained


@inlined
def too_long(model, data):
    """Return whether a step with active points is to be cut: for want of a solution, or for what it loses."""
    system, controls = model.system, model.controls
    active, start, work, search = data.active, data.state, data.work, data.work.search[0]
    end, dt = work.trial, search.dt
    if active.count[0] == 0:
        return False
    if dt > RETRIED * controls.step and unsolved(system, controls, work, UNSOLVED):
        return True
    shortest = dt <= SHORTEST * controls.step
    if not shortest and turns_far(system, active, start, end, dt):
        return True
    result = work.result[0]
    alone = unnamed_alone(system, start, end, search.alone, work)
    if shortest:
        return not (alone <= GROSS)
    result.unnamed = max(result.unnamed, alone)
    return not (result.unnamed <= (CAREFUL if search.pace < math.inf else 1.0))


@inlined
def goes_wild(work):
    """Return whether a step of a group that was cut as far as it may be loses a lot all the same."""
    return work.result[0].unnamed > WILD


@inlined
def next_pace(pace, work):
    """Return how long the next step may be: twice as long, unless that would lose too much."""
    return 2.0 * pace if work.result[0].unnamed <= SURE * CAREFUL else pace


@kernel
def plain_step(system):
    """Return about what a step without contacts takes [us]."""
    each = LOOPS_STEP if system.solver.kind == LOOPS else OTHER_STEP
    return system.bodies.shape[0] * each


@kernel
def iterations_left(controls, clock, k):
    """Return how many iterations for k points the step can afford, some in any case."""
    return max(SOME, int((affordable(controls, clock) - clock.effort) / (ITERATION * k * k)))


@kernel
def charge_iterations(clock, k, iterations):
    """Add the work of iterations for k points to that of the step."""
    clock.effort += ITERATION * k * k * iterations
    clock.since += ITERATION * k * k * iterations


@kernel
def rest_speed(controls, gained, residual, k, poorly):
    """Return the speed [m/s] below which bodies rest that are held at k points.

    `Options.rest_tolerance` of the speed that applied forces give them in the step, or what k contacts that are
    solved to a residual may leave of it, up to so many times the former.
    """
    least = controls.rest * gained
    return max(least, min(k * residual, poorly * least))
