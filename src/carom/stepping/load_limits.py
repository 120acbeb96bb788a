"""Loads of joints that may break, looked at after each step without a return to Python.

A joint breaks where its force, its torque, or the impulse that it takes in an impact exceeds a limit. A run
that has such joints goes on as any other, and the compiled loop is left after a step at whose end a load is
beyond its limit, in which it may have been (the parabola through three ends of steps is), or in which an
impact may have broken a joint. What follows is that of `carom.watch`, which takes this step once more.

Dry friction in joints loads the bodies with the force that the step has found at its end, slip or stick. A
time-stepping step knows no force at its end, and leaves the loop.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import by_reference, entry, kernel
from carom._compiled.units import unit
from carom.dynamics.reactions import add_touch, load_bodies, solve_reactions
from carom.geometry.rotation import norm
from carom.geometry.vectors import cross, plus
from carom.kinematics.combination import push
from carom.kinematics.curve import seek_feet
from carom.kinematics.joints import anchor_gap
from carom.model.arrays import System
from carom.model.data import Data
from carom.model.parts_of_system import has_relations
from carom.model.records import Records
from carom.model.workspace import Work
from carom.stepping.record import room_of_touches, save_contacts
from carom.stepping.time_loop import begin_call, take_steps

#: what may break: its limits, and the greatest part of them at the ends of the last three steps, less 1
LOAD_LIMIT = [
    ("element", "i8"),  # the joint, or -1
    ("contact", "i8"),  # the number of the stop, or -1
    ("flipped", "i8"),  # whether its child is the parent in the solver
    ("force", "f8"),
    ("torque", "f8"),
    ("impulse", "f8"),
    ("value", "f8", 3),
]
#: where a run with limits stands
LIMIT_CLOCK = [
    ("until", "i8"),  # the step to which it goes
    ("beyond", "i8"),  # whether the loop was left because a limit may have been passed
    ("known", "i8"),  # how many of the last values are known
    ("struck", "i8"),  # impacts before the step
    ("whole", "i8"),  # time-stepping steps before the step
    ("augment", "f8"),  # `Options.augmentation`
    ("time", "f8", 3),  # ends of the last three steps
]


class LoadLimits(NamedTuple):
    """Limits, and the arrays with which reactions are solved for: those of the run stay as they are."""

    rows: np.recarray  # (B,) LOAD_LIMIT
    place: np.recarray  # (1,) LIMIT_CLOCK
    system: System
    work: Work
    clocks: np.recarray  # (1,) CLOCK: counts the touches
    records: Records  # forces at contacts of one time


@entry
def run_within(model, data, method, islands, grid, limits):
    """Continue as `time_loop.run` does, until a limit may have been passed within the last step."""
    clock, place = data.clocks[0], limits.place[0]
    begin_call(data.work)
    while clock.step < place.until:
        code = take_steps(model, data, method, islands, grid, clock.step + 1)
        if code != 0:
            return code
        if look_at_loads(model, data, limits):
            place.beyond = 1
            return 0
    return 0


@kernel
def look_at_loads(model, data, limits):
    """Write the loads at the end of a step; return whether one may have passed its limit within it."""
    place, clock = limits.place[0], data.clocks[0]
    if not find_reactions(model, data, limits):
        return True
    known = min(place.known + 1, 3)
    place.time[0], place.time[1], place.time[2] = place.time[1], place.time[2], clock.now
    found = False
    for i in range(limits.rows.shape[0]):
        row = limits.rows[i]
        row.value[0], row.value[1] = row.value[1], row.value[2]
        row.value[2] = load_of(row, data.state, limits)
        found = found or not row.value[2] < 0.0 or (known == 3 and may_peak(place.time, row.value))
        if row.impulse < math.inf:
            for k in range(place.struck, clock.struck):
                found = found or row.contact < 0 or data.records.impact[k].contact == row.contact
    place.known, place.struck = known, clock.struck
    return found


@entry
def find_loads(model, data, limits):
    """Write the reactions at the present state, for Python."""
    find_reactions(model, data, limits)


@kernel
def find_reactions(model, data, limits):
    """Write the reactions at the present state; return whether the forces beside them are known."""
    touch, own, place = limits.records.touch, limits.clocks[0], limits.place[0]
    whole, place.whole = place.whole, data.clocks[0].whole
    if whole != place.whole and model.system.relations.frictions.shape[0] > 0:
        return False
    own.now, own.touched = data.clocks[0].now, 0
    if room_of_touches(model.system, data.active.count[0]) > touch.shape[0]:
        return False
    here = by_reference(
        Data(
            state=data.state, active=data.active, work=data.work, group=data.group, multiple=data.multiple,
            crowd=data.crowd, clocks=limits.clocks, records=limits.records, watch=data.watch,
        )
    )  # fmt: skip
    if data.active.count[0] > 0:
        save_contacts(model, here, 0)
    system, work = limits.system, limits.work
    if system.joints.shape[0] == 0:
        return True
    work.moment[0].time = own.now
    memory, known = system.relations.memory, model.system.relations.memory
    for i in range(memory.coordinates.shape[0]):
        memory.coordinates[i].reference = known.coordinates[i].reference
    seek_feet(system, data.state)
    load_bodies(system, data.state, work)
    for h in range(own.touched):
        add_touch(touch[h], work)
    add_friction(model.system, data.state, work)
    solve_reactions(system, place.augment, data.state, work)
    return True


@unit(where=has_relations)
def add_friction(system, state, work):
    """Add the wrenches of dry friction in joints by its forces at the end of the step."""
    relations = system.relations
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        force = one.arm * relations.memory.frictions[i].force[1]
        push(system, relations.coordinates[one.coordinate], state, force, work)


@kernel
def load_of(row, state, limits):
    """Return the greatest part of a limit that a force or a torque has, less 1."""
    if row.contact >= 0:
        force, touch = 0.0, limits.records.touch
        for h in range(limits.clocks[0].touched):
            if touch[h].contact == row.contact:
                force += touch[h].force[0]
        return abs(force) / row.force - 1.0
    f = limits.work.joint[row.element].reaction
    torque = (f[3], f[4], f[5])
    if row.flipped == 1:  # about the anchor of the child, which is the parent in the solver
        d = anchor_gap(limits.system.joints[row.element], state)
        torque = plus(torque, 1.0, cross(d, (f[0], f[1], f[2])))
    return max(norm((f[0], f[1], f[2])) / row.force, norm(torque) / row.torque) - 1.0


@kernel
def may_peak(t, f):
    """Return whether the parabola through three values below 0 comes above 0 in the last interval.

    It is greatest where f' = a + bend (2 s - t_0 - t_1) = 0, with divided differences a and bend.
    """
    a, b = (f[1] - f[0]) / (t[1] - t[0]), (f[2] - f[1]) / (t[2] - t[1])
    bend = (b - a) / (t[2] - t[0])
    if not (bend < 0.0 and max(f[1], f[2]) < 0.0):
        return False
    top = 0.5 * (t[0] + t[1] - a / bend)
    return t[1] < top < t[2] and f[0] + (top - t[0]) * (a + bend * (top - t[1])) > 0.0
