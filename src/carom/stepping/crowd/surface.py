"""Penetrating points return to the surfaces: 0 <= lam _|_ phi + W_nn lam >= 0, xi = P G_n^T lam.

phi are the gaps. It is solved by sweeps over the normal rows, and repeated because gaps are not linear. A point
that joints hold along its normal is left where it is.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.kinds.partner import smaller
from carom.contact.thresholds import PLACE_ERROR
from carom.dynamics.project import project_position, shift
from carom.dynamics.thresholds import JOINT_ERROR
from carom.model.parts_of_system import are_joined
from carom.model.workspace import MOTION_POINT
from carom.stepping.crowd.response import spread_impulses
from carom.stepping.crowd.spots import place_all
from carom.stepping.thresholds import IMMOBILITY, RETURN_GAIN

# passes; least and greatest number of sweeps of a pass, and number of sweeps times points. To place all points
# again costs as much as thirty sweeps
SURFACE_PASSES, SWEEPS, SURFACE_WORK = 8, (100, 1000), 20000


@kernel
def onto_surfaces(model, data, k):
    """Move bodies to their joints, and apart where points penetrate; return the relative error of the joints.

    `crowd.points[1]` are the points at the end.
    """
    system, crowd, work, end = model.system, data.crowd, data.work, data.work.trial
    missed = project_position(system, end, True, JOINT_ERROR, work)
    for _ in range(SURFACE_PASSES):
        place_all(model, data, 0, k, end, crowd.points[1])
        deepest, tiny = 0.0, 1.0
        for i in range(k):
            gap = crowd.points[1][i].gap
            size = smaller(system.contacts[crowd.closed[i].contact])
            moves = crowd.problem.link[i].local[0] > IMMOBILITY
            moves = moves and crowd.closed[i].motion == MOTION_POINT
            if moves and gap < -PLACE_ERROR * size:
                deepest, tiny = max(deepest, -gap), min(tiny, 0.1 * PLACE_ERROR * size)
        if deepest == 0.0:
            break
        lift(system, k, max(tiny, RETURN_GAIN * deepest), crowd, work)
        for b in range(end.shape[0]):
            shift(work.body[b].motion, 1.0, end[b])
        missed = project_position(system, end, True, JOINT_ERROR, work)
    return missed


@kernel
def lift(system, k, tolerance, crowd, work):
    """Write the motion of all bodies that removes the penetration of the points, to a tolerance [m]."""
    problem, lam, joined = crowd.problem, crowd.lift, are_joined(system)
    for b in range(problem.body.shape[0]):
        for j in range(6):
            problem.body[b].motion[j] = 0.0
    for i in range(k):
        lam[i] = 0.0
    for turn in range(max(SWEEPS[0], min(SWEEPS[1], SURFACE_WORK // max(1, k)))):
        change = 0.0
        for place in range(k):
            i = place if turn % 2 == 0 else k - 1 - place
            if crowd.closed[i].motion == MOTION_POINT and problem.link[i].local[0] > IMMOBILITY:
                gap = crowd.points[1][i].gap
                change = max(change, lift_one(problem, i, gap, lam))
        if change <= tolerance:
            break
    if not joined:
        for b in range(work.body.shape[0]):
            for j in range(6):
                work.body[b].motion[j] = problem.body[b].motion[j]
        return
    for i in range(k):
        crowd.p[3 * i] = problem.contact[i].scale * lam[i]
        crowd.p[3 * i + 1], crowd.p[3 * i + 2] = 0.0, 0.0
    spread_impulses(system, k, crowd, work)


@kernel
def lift_one(problem, i, gap, lam):
    """Remove the penetration of one point, the others fixed; return the change of its gap. Rows are scaled."""
    link, s = problem.link[i], problem.contact[i].scale
    for side in range(2):
        if link.body[side] >= 0:
            G, y = link.rows[side], problem.body[link.body[side]].motion
            for j in range(6):
                gap += G[0, j] * y[j] / s
    for e in range(link.others, link.others_end if link.spans == 1 else link.others):
        G, y = problem.other[e].rows, problem.body[problem.other[e].body].motion
        for j in range(6):
            gap += G[0, j] * y[j] / s
    before = lam[i]
    lam[i] = max(0.0, before - s * gap / link.local[0])
    d = lam[i] - before
    if d == 0.0:
        return 0.0
    for side in range(2):
        if link.body[side] >= 0:
            Y, y = link.response[side], problem.body[link.body[side]].motion
            for j in range(6):
                y[j] += d * Y[j, 0]
    for e in range(link.others, link.others_end):
        Y, y = problem.other[e].response, problem.body[problem.other[e].body].motion
        for j in range(6):
            y[j] += d * Y[j, 0]
    return abs(d) * link.local[0] / s
