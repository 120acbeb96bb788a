"""The response of bodies to impulses at the points of a crowd: of single bodies, or of joined bodies.

The Delassus operator W = G P G^T is never formed: each point has its rows G, and the responses P G^T of the
bodies that its impulse moves. These are the two bodies of the point and, if they have joints, the bodies
connected to them (`OTHER`): motions that the back end finds for unit impulses. (Mathematics page, §3.9.)
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.contact_impulse import add_impulse, alone, clear_wrenches, respond_alone, spread
from carom.dynamics.solve import solve
from carom.friction import layout as o
from carom.friction.island import write_motion
from carom.friction.layout import CONE
from carom.friction.solve import inverse_mass_of, scale_link
from carom.geometry.rotation import unit_vector
from carom.kinematics.contact_point import contact_velocity
from carom.kinematics.row_of_coordinate import rate_in_pose
from carom.model.parts_of_system import are_joined
from carom.model.workspace import MOTION_PIVOT, MOTION_STOP, MOTION_THREE


@kernel
def write_responses(system, first, k, crowd, work):
    """Write rows and responses of points `first` to k in `crowd.points[0]`, with masses after the flight."""
    problem, points = crowd.problem, crowd.points[0]
    last = problem.link[first - 1].others_end if first > 0 else 0
    for i in range(first, k):
        link, point = problem.link[i], points[i]
        link.body[0], link.body[1], link.others = point.a, point.b, last
        last = write_rows(system, point, crowd, link, last, work)
        link.others_end = last
        for r in range(6):
            link.local[r] = 0.0
        for e in range(link.others, last if link.spans == 1 else link.others):
            add_products(problem.other[e].rows, problem.other[e].response, link.local)
        scale_link(link, problem.contact[i], 0.0, CONE, (0.0, 0.0))
        s = problem.contact[i].scale
        for e in range(link.others, last):
            for r in range(6):
                for a in range(3):
                    problem.other[e].response[r, a] *= s
                    problem.other[e].rows[a, r] *= s
        if point.motion in (MOTION_STOP, MOTION_THREE):  # without tangents any positive number does
            for m in (3, 5):
                link.local[m] = link.local[m] if link.local[m] > 0.0 else link.local[0]


@kernel
def respond(system, k, gamma, crowd, work):
    """Write `crowd.p` from the present scaled impulses, and the motion of all bodies that they cause."""
    problem = crowd.problem
    for i in range(3 * k):
        crowd.p[i] = gamma * problem.contact[i // 3].scale * problem.vector[o.ITERATE, i]
    if are_joined(system):
        spread_impulses(system, k, crowd, work)
        return
    write_motion(problem, k, problem.vector[o.ITERATE])
    for b in range(work.body.shape[0]):
        for j in range(6):
            work.body[b].motion[j] = gamma * problem.body[b].motion[j]


@kernel
def spread_impulses(system, k, crowd, work):
    """Write the motion of all bodies from the impulses `crowd.p`, with the joints between bodies."""
    clear_wrenches(work)
    for i in range(k):
        p = crowd.p
        add_impulse(system, crowd.points[0][i], crowd.pose, p[3 * i : 3 * i + 3], work)
    solve(system, crowd.flight, False, work)


@kernel
def block_of_point(problem, i, W):
    """Write the block W (3, 3) of one point."""
    inverse_mass_of(problem.link[i], problem.contact[i], W)


@kernel
def write_rows(system, point, crowd, link, first, work):
    """Write rows G and responses P G^T of a point: of its bodies, and of all that joints move with them.

    A row is the wrench of a unit impulse, and its response the motion. The others are rows of `OTHER` from
    `first` on; return their end.
    """
    other, last, link.spans = crowd.problem.other, first, 0
    for b in range(0 if alone(system, point) else system.bodies.shape[0]):
        if system.bodies[b].isolated == 0 and b != link.body[0] and b != link.body[1]:
            other[last].body = b
            last += 1
    for r in range(3):
        respond_to(system, point, unit_vector(r), crowd, work)
        for side in range(2):
            if link.body[side] >= 0:
                G, Y, memory = link.rows[side], link.response[side], work.body[link.body[side]]
                for j in range(6):
                    G[r, j], Y[j, r] = memory.wrench[j], memory.motion[j]
        for e in range(first, last):
            memory = work.body[other[e].body]
            for j in range(6):
                spans = point.motion in (MOTION_STOP, MOTION_THREE) or point.bends == 1
                spans = spans and memory.wrench[j] != 0.0
                other[e].rows[r, j] = memory.wrench[j] if spans else 0.0
                other[e].response[j, r] = memory.motion[j]
                link.spans = 1 if spans else link.spans
    moved = first
    for e in range(first, last):
        if responds(other[e]):
            other[moved] = other[e]
            moved += 1
    return moved


@kernel
def respond_to(system, point, p, crowd, work):
    """Write the wrenches and the motion of an impulse at a point; the rows of a stop are those of the pose."""
    if point.motion > MOTION_PIVOT:
        clear_wrenches(work)
        add_impulse(system, point, crowd.pose, p, work)
        if alone(system, point):
            respond_alone(system, point, crowd.flight, work)
        else:
            solve(system, crowd.flight, False, work)
        return
    spread(system, point, crowd.flight, p, work)


@kernel
def velocity_of(system, point, crowd, state):
    """Return u = G v of a point of a crowd: the rows of the pose, the velocities of a state."""
    if point.motion > MOTION_PIVOT:
        return rate_in_pose(system, point, crowd.pose, state)
    return contact_velocity(system, point, state)


@kernel
def add_products(rows, response, local):
    """Add the upper triangle of the product of rows and responses of a body."""
    at = 0
    for a in range(3):
        for d in range(a, 3):
            for j in range(6):
                local[at] += rows[a, j] * response[j, d]
            at += 1


@kernel
def responds(other):
    """Return whether a body moves: the response of a body without connection to the point is zero."""
    for j in range(6):
        for r in range(3):
            if other.response[j, r] != 0.0:
                return True
    return False
