"""Stops of slip within a given step, which are located, so that a step has its order on both sides of them.

Beyond its stop a slip keeps the friction of its way before, as if it went on, in all stages and members. So the
part of a slip that is left at the end of a trial step,

    left = u . d / |u at the start|,    d: its direction at the start,

goes smoothly through zero, and its root is the end of a step (EVENT_STOP). There the point sticks if friction
holds it, or slips the other way. Of rolling and pivoting friction the same holds with the rates of a turn. With
tolerances the error of a step beyond a stop does this (`rows.beyond_stop`).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.persistent.joint_rows import greatest_load
from carom.persistent.memory import memory_of, slip_at_start
from carom.persistent.rows import slip_of
from carom.persistent.springs import place_forces, rate_by_forces


@kernel
def locates(model, data):
    """Return whether stops are located: with given steps, unless events follow each other without end."""
    return model.controls.order == 0 and data.work.search[0].eager == 1


@kernel
def note_left(model, data, k):
    """Write the parts of slip of k points that are left at the end of a step, with their velocities in `u`."""
    if not locates(model, data):
        return
    system, active, group = model.system, data.active, data.group
    still = 0.5 * model.controls.rest * greatest_load(k, group) * model.controls.step
    for i in range(k):
        closed_point, u = group.closed[i], group.u
        slips, d1, d2, speed = slip_at_start(system, active, closed_point)
        if closed_point.listed == 0 or not (slips and speed > 2.0 * still):
            continue
        e1, e2, _ = slip_of(system, data, i, still)
        left = (u[3 * i + 1] * d1 + u[3 * i + 2] * d2) / speed
        if e1 == 0.0 and e2 == 0.0:  # a stop
            left = 0.0
        memory = memory_of(system, active, closed_point)
        memory.left = min(memory.left, left)


@kernel
def concerned(label, work):
    """Return whether the search for an event concerns a group; joined and loaded bodies always take part."""
    return label == work.body.shape[0] or work.body[label].sought == 1


@kernel
def is_sought(label, work):
    """Return whether the trial step moves a group: in a search only those that it concerns."""
    search = work.search[0]
    return search.active == 0 or search.part != 1 or concerned(label, work)


@kernel
def least_left(system, active, work):
    """Return the least part of a slip that is left at the end of a trial step, of the groups that it moves."""
    least, frictions = 1.0, system.relations.memory.frictions
    for i in range(active.count[0]):
        if active.points[i].rest == 0 and is_sought(work.body[active.points[i].body].label, work):
            least = min(least, active.points[i].left)
    for i in range(frictions.shape[0]):
        least = min(least, frictions[i].left)
    return least


@kernel
def pass_stops(model, data, k, hg):
    """Let points keep their friction that have passed their stops in a stage; return whether there are more.

    `u` has the slip of the stage without its forces.
    """
    group, more = data.group, False
    place_forces(k, group.p, group)
    for i in range(k):
        closed_point, q = group.closed[i], 3 * i
        slips, d1, d2, speed = slip_at_start(model.system, data.active, closed_point)
        moves = slips and speed > 0.0 and (d1 != 0.0 or d2 != 0.0)
        if closed_point.listed == 0 or closed_point.passes == 1 or not moves:
            continue
        u1 = group.u[q + 1] + hg * rate_by_forces(k, q + 1, group)
        u2 = group.u[q + 2] + hg * rate_by_forces(k, q + 2, group)
        if not u1 * d1 + u2 * d2 > 0.0:
            closed_point.passes, more = 1, True
            group.problem.heading[i, 0], group.problem.heading[i, 1] = d1, d2
    return more
