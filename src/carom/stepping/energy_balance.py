"""The energy balance, step by step: the energy error compared with the largest energy exchanged so far.

After each step, with sums since the start (and `exchanged` within steps too),

    residual = T + V - (T_0 + V_0) - loads - impacts - friction - bounces,
    unnamed  = |residual| + sum over entries that never rise of (entry - its lowest value so far),
    exchanged = greatest value so far of T, |V - V_0|, |loads|, |impacts|, |friction|, |bounces|.

"unnamed" is the energy error, which no entry of the ledger explains. The balance does not depend on the zero of
the potential. The sum over impacts may rise if Newton's law with friction adds energy. The largest error of
a run is compared with the largest energy exchanged in it; 1e-13 of the terms of the energies is round-off.
(Mathematics page, §1.12.)
"""

from __future__ import annotations

import math

import numpy as np

from carom._compiled.decorators import inlined, kernel
from carom._compiled.record_arrays import table
from carom.dynamics.energy import energies
from carom.geometry.rotation import norm
from carom.law import impact_laws
from carom.model.actions import EVENT_JAM
from carom.model.laws import STRIKES
from carom.persistent.thresholds import CUT_SHARE
from carom.stepping import thresholds as limits

#: kinds of energy errors: indices in the columns of `WATCH`
RESIDUAL, IMPACTS, FRICTION, BOUNCES, ALL = range(5)
IN_A_ROW = 3  # after so many shortest steps that still gain energy the run ends

FEW = 10  # bodies: a time-stepping step of so few is named in the warnings; of more it is that of a crowd

WATCH = [
    ("tolerance", "f8"),  # `Options.energy_tolerance`
    ("total", "f8"),  # kinetic and potential energy at the start
    ("potential", "f8"),  # potential energy at the start
    ("exchanged", "f8"),
    ("struck", "i8"),  # number of impacts checked
    ("named", "f8"),  # energy that impacts added by Newton's law with friction
    ("lowest", "f8", 4),  # lowest values of the entries so far
    ("size", "f8"),  # greatest size of the terms of the energies
    ("amount", "f8", 5),  # greatest error of each kind
    ("time", "f8", 5),  # its time
    ("depth", "f8"),  # greatest depth at a saved time, relative to the size of the body
    ("deep_at", "f8"),  # its time, and its contact
    ("deep_contact", "i8"),
    ("speed", "f8"),  # greatest speed of a body so far, plus the gain from gravity in a step [m/s]
    ("unsolved", "f8"),  # greatest residual of active contacts so far [m/s], and its time
    ("unsolved_at", "f8"),
    # greatest work that applied forces could do over the allowed errors of positions
    ("able", "f8"),
    # number of steps that were given up event by event and made as time-stepping steps; of the first its start,
    # bodies and code, of the longest its length, of all a bound of the errors of position over a body's size
    ("whole", "i8"),
    ("whole_at", "f8"),
    ("whole_length", "f8"),
    ("whole_error", "f8"),
    ("whole_bodies", "i8"),
    ("whole_code", "i8"),
    # greatest error of a body by time-stepping steps so far: relative to its tolerance, and to its size
    ("astray", "f8"),
    ("astray_size", "f8"),
    ("gains", "i8"),  # shortest steps in a row that gained
    ("share", "f8"),  # allowed error of a step, as a part of the energy exchanged
]


def new_watch(tolerance: float, share: float = np.inf) -> np.recarray:
    """Return the record of errors for a new run, (1,); by default single steps have no limit."""
    watch = table(WATCH, 1)
    watch["tolerance"], watch["share"] = tolerance, share
    return watch


@kernel
def begin_watch(system, now, t, watch):
    """Store the energies at the start."""
    kinetic, potential, size = energies(system, now, t)
    watch.total, watch.potential = kinetic + potential, potential
    watch.exchanged, watch.struck, watch.named, watch.gains = kinetic, 0, 0.0, 0
    watch["size"], watch.depth, watch.speed, watch.unsolved = size, 0.0, 0.0, 0.0
    for i in range(5):
        watch.amount[i], watch.time[i] = 0.0, t
    for i in range(4):
        watch.lowest[i] = 0.0


@kernel
def note_whole(system, controls, step, code, bodies, watch):
    """Note that a step was given up event by event, and becomes a time-stepping step.

    Its impacts are at its end, so a body that it stops or turns round is misplaced by at most 2 V h, with the
    greatest speed V so far; these bounds add up.
    """
    if controls.order == 0 or bodies > FEW:
        return
    size = math.inf
    for b in range(system.bodies.shape[0]):
        size = min(size, system.bodies[b].extent)
    speed = watch.speed + controls.pull * step.length
    watch.whole_error += 2.0 * speed * step.length / size
    if watch.whole == 0:
        watch.whole_at, watch.whole_bodies, watch.whole_code = step.begin, bodies, code
    watch.whole += 1
    watch.whole_length = max(watch.whole_length, step.length)


@kernel
def forget_whole(step, watch):
    """Forget the first time-stepping step, which is not taken: prescribed motions block the bodies in it."""
    if watch.whole == 1 and watch.whole_at == step.begin:
        watch.whole = 0


@kernel
def note_energies(system, now, clock):
    """Store the present energies; return the size of their terms."""
    clock.kinetic, clock.potential, size = energies(system, now, clock.now)
    return size


@inlined
def note_exchanged(clock, kinetic):
    """Note the energy exchanged: the kinetic energy of bodies, and the works since the start.

    This is done at each trial step that is accepted, because what was exchanged may be back at the end of a
    step of the run (a whole period of a pendulum). Potential energy turns into one of these, so it is not
    needed. The clock is put back with a step that is repeated.
    """
    most = max(clock.exchanged, max(kinetic, abs(clock.loads)))
    most = max(most, max(abs(clock.impacts), abs(clock.friction)))
    clock.exchanged = max(most, abs(clock.bounces))


@kernel
def watch_step(system, data):
    """Check the balance at the end of a step."""
    now, clock, step, watch = data.state, data.clocks[0], data.work.step[0], data.watch[0]
    size = max(note_energies(system, now, clock), size_of_stillness(system, step.length))
    kinetic, potential = clock.kinetic, clock.potential
    residual = kinetic + potential - watch.total
    residual -= clock.loads + clock.impacts + clock.friction + clock.bounces
    note_exchanged(clock, kinetic)
    exchanged = max(watch.exchanged, max(clock.exchanged, abs(potential - watch.potential)))
    watch.exchanged, watch["size"] = exchanged, max(watch["size"], size)
    watch.able = max(watch.able, step.able)
    watch.named += given_by_law(system, clock, data.records, watch)
    total = abs(residual)
    compare(RESIDUAL, residual, clock.now, watch)
    for i in range(1, 4):
        line = clock.friction if i == FRICTION else clock.bounces
        if i == IMPACTS:
            line = clock.impacts - watch.named
        watch.lowest[i] = min(watch.lowest[i], line)
        total += line - watch.lowest[i]
        compare(i, line - watch.lowest[i], clock.now, watch)
    compare(ALL, total, clock.now, watch)
    fastest = greatest_speed(system, now) + norm(system.gravity) * step.length
    watch.speed = max(watch.speed, max(fastest, speed_of_stillness(system, step.length)))
    if not clock.residual <= watch.unsolved and watch.unsolved == watch.unsolved:
        watch.unsolved, watch.unsolved_at = clock.residual, clock.now


@kernel
def size_of_stillness(system, h):
    """Return the round-off of sum m (L/h)^2: the energy of moving by the round-off of L in a step.

    Where nothing moves, all energies are of that size.
    """
    size = 0.0
    for b in range(system.bodies.shape[0]):
        size += system.bodies[b].mass * (system.bodies[b].extent / h) ** 2
    return limits.ENERGY_ROUND_OFF * size


@kernel
def speed_of_stillness(system, h):
    """Return the speed of moving by the round-off of the greatest size in a step [m/s]."""
    size = 0.0
    for b in range(system.bodies.shape[0]):
        size = max(size, system.bodies[b].extent)
    return limits.ENERGY_ROUND_OFF * size / h


@kernel
def greatest_speed(system, now):
    """Return the greatest speed of a body, including that of its rotation at its size [m/s]."""
    most = 0.0
    for b in range(now.shape[0]):
        most = max(most, norm(now[b].v) + system.bodies[b].extent * norm(now[b].w))
    return most


@inlined
def compare(i, amount, t, watch):
    """Store an energy error if it is the largest of its kind so far; a NaN is never replaced."""
    greatest = watch.amount[i]
    if not (abs(amount) <= abs(greatest)) and greatest == greatest:
        watch.amount[i], watch.time[i] = amount, t


@kernel
def given_by_law(system, clock, records, watch):
    """Return the energy that the new impacts have added, if their law with friction allows it (V8)."""
    total = 0.0
    for k in range(watch.struck, clock.struck):
        row = records.impact[k]
        given = max(row.energy_change, row.compression_work + row.restitution_work)
        if given > 0.0 and may_give(system, row.contact):
            total += given
    watch.struck = clock.struck
    return total


@kernel
def may_give(system, number):
    """Return whether the contact with this number in the scene has Newton's law and friction."""
    low, high = 0, system.contacts.shape[0]
    while low < high:  # numbers are sorted
        middle = (low + high) // 2
        if system.contacts[middle].number < number:
            low = middle + 1
        else:
            high = middle
    if low == system.contacts.shape[0]:
        return False
    contact = system.contacts[low]
    law = system.laws.table[contact.law[STRIKES]]
    gains = law.impact_law in impact_laws.GAINING and law.friction > 0.0
    return contact.number == number and gains


@inlined
def imbalance(model, data, named, t, h):
    """Return the energy error of a step as a fraction of the allowed one, and whether the step multiplies it.

    Bodies on which only gravity acts are exact in flight; in persistent contact `carom.persistent.step_control`
    checks them.
    """
    loaded = False
    for b in range(data.state.shape[0]):
        loaded = loaded or model.system.bodies[b].ballistic == 0
    return unbalanced(model, data, named, t, h) if loaded else (0.0, False)


@kernel
def speeds_known(system, state, h):
    """Return the energy [J] of the speeds that correspond to round-off of positions in a step."""
    total = 0.0
    for b in range(state.shape[0]):
        body = system.bodies[b]
        speed = limits.ENERGY_ROUND_OFF * (norm(state[b].x) + body.extent) / h
        total += body.mass * speed * speed
    return total


@kernel
def unbalanced(model, data, named, t, h):
    """Return the result of `imbalance` for joined or loaded bodies; `named` is the work of loads and friction.

    A step multiplies energy if its unexplained gain is as large as the energy that it exchanges, and above the
    tolerance. Explicit methods do so with springs and dampers that are too stiff for the step. The work that
    the forces could do over the allowed error of positions is no error of energy.
    """
    system, end, watch = model.system, data.work.trial, data.watch[0]
    before, low, _ = energies(system, data.state, t)
    after, high, size = energies(system, end, t + h)
    gain = after + high - before - low - named
    exchanged = before + after + abs(high - low) + abs(named)
    known = limits.ENERGY_ROUND_OFF * size + speeds_known(system, end, h) + watch.able
    tolerated = watch.tolerance * watch.exchanged + known
    grows = not (gain <= limits.ENERGY_GAIN * exchanged + tolerated)
    share = watch.share * (limits.ACTIVE_SHARE if data.active.count[0] > 0 else 1.0)
    may = share * max(watch.exchanged, exchanged) + known
    if not abs(gain) < math.inf:
        return math.inf, grows
    return abs(gain) / may if may > 0.0 else 0.0, grows


@kernel
def off_balance(model, data):
    """Return whether a step must be cut for its energy error, and the number of steps in a row that gained.

    The shortest steps are accepted with any error, and the limit is then raised for the following steps, so
    that round-off or a force that jumps does not cut all steps of a run. Forces grow without bound before a
    jam, so steps towards a jam are halved without a shortest length. A given step in which friction adds energy
    is cut too: slip stops or turns within it, and the weights of its stages are not all positive.
    """
    controls, active, work = model.controls, data.active, data.work
    search, clock, watch = work.search[0], data.clocks[0], data.watch[0]
    dt, named = search.dt, search.applied + search.friction
    shortest, careful = dt <= limits.SHORTEST_STEP * controls.step, search.pace < math.inf
    jams = search.active == 1 and search.kind == EVENT_JAM
    if active.count[0] == 0:
        search.unnamed = 0.0
    watch.able = max(watch.able, work.step[0].able)
    off, grows = imbalance(model, data, named, clock.now, dt)
    search.unnamed = max(search.unnamed, off)
    cut = grows or off > (CUT_SHARE if careful else 1.0)
    round_off = limits.ENERGY_ROUND_OFF * watch["size"]
    if controls.order == 0 and search.friction > limits.FRICTION_GAIN * watch.exchanged + round_off:
        cut = True
    if (cut and not shortest) or (grows and (jams or search.active == 1)):
        return True, 0
    if search.active == 1 and shortest and not jams:
        return False, 0
    if off > 1.0:
        watch.share *= limits.LIMIT_GROWTH
    watch.gains = watch.gains + 1 if grows else 0
    return False, watch.gains
