"""The contact problem of a crowd: mixed sweeps, the central path, and steps of Newton's method.

Sweeps from the impulses of the last step are enough if bodies move about, but converge slowly if they stand on
each other (a tower of twenty boxes: 1e-2 of g h after 200 sweeps, and it falls). Then the central path
(`carom.friction.interior`) comes near a solution, with one factor of the graph of bodies a step. From there a
step of Newton's method, and sweeps that correct the modes, solve the problem; where the path has ended far from
a solution, it begins again from what they have reached. If all this fails (many balls that roll on each other),
alternating directions leave less than the others. Few bodies, and balls, are solved without the path.
"""

from __future__ import annotations

from carom._compiled.decorators import by_reference, kernel
from carom.friction import layout as o
from carom.friction.alternating import alternate
from carom.friction.graph import find_order, of_present_size
from carom.friction.newton import copy, step
from carom.friction.residual import residual
from carom.friction.solve import scale_vectors
from carom.friction.thresholds import CHORD_GAIN, PROXIMAL, RESIDUAL
from carom.model.allowance import COUNT_BLOCKS
from carom.model.workspace import MOTION_POINT
from carom.persistent.thresholds import CROWD_REST
from carom.stepping import thresholds as limits
from carom.stepping.crowd.central_path import follow_path
from carom.stepping.crowd.sweeps import sweep_until

# sweeps: at first; after a step; allowed for all turns but one
FIRST, BETWEEN, ALLOWED = 40, 30, 150
PATH_TURNS = 3  # turns that begin along the central path
FEW_BODIES = 8  # what Newton's steps solve without the path
FACE_POINTS = 3  # points of a pair of bodies that lie on each other by faces
IDLE_TURNS = 4  # turns that do not halve the residual until a start from 0, and again until the end
MORE_WORK = 4  # factor of the allowed work if the step can afford it
# iterations of alternating directions: usual, and most without the path if the step can afford them
SPLIT, LONG_SPLIT = 100, 1000


@kernel
def has_faces(crowd, k):
    """Return whether a pair touches at several points, of which some are redundant: balls need no path."""
    count = 0
    for i in range(k):
        one = crowd.closed[i]
        if crowd.points[0][i].motion != MOTION_POINT:
            continue
        same = count > 0 and one.contact == crowd.closed[i - 1].contact
        count = count + 1 if same else 1
        if count == FACE_POINTS:
            return True
    return False


@kernel
def solve(system, data, k, tolerance, left):
    """Solve for the scaled impulses; return their scale, and the residual [m/s].

    More than the usual work is done while the step has products with blocks `left`: a sweep and an iteration
    of alternating directions take one for each contact, factors one for each update and four for each contact.
    """
    crowd, n, counts = data.crowd, data.state.shape[0], data.work.step[0]
    work = crowd.problem
    work.count[o.ITERATIONS] = 0
    gamma = scale_vectors(work, k, crowd.c, crowd.p)
    most = max(ALLOWED * k, min(left, MORE_WORK * ALLOWED * k))
    speed = greatest_speed(crowd, k) / gamma
    r, goal, done = sweep_until(system, crowd, k, max(tolerance / gamma, RESIDUAL * speed), FIRST)
    enough = max(tolerance / gamma, goal, RESIDUAL * speed)
    good = max(goal, limits.SLOW_RESIDUAL * speed, CROWD_REST * tolerance / gamma)
    spent, least, turn, idle, faces = done * k, r, 0, 0, n > FEW_BODIES and has_faces(crowd, k)
    p, kept = work.vector[o.ITERATE], work.vector[o.START_BEST]
    copy(k, p, kept)
    while not least <= enough and spent < most and idle < 2 * IDLE_TURNS:
        before = least
        # start from 0: the last impulses may be a poor first guess
        if idle == IDLE_TURNS and n > 1:
            for i in range(3 * k):
                p[i] = 0.0
        if turn < PATH_TURNS and faces:
            r, more = follow_path(system, crowd, k, n, enough)
            spent += more
            if r < least:
                least = r
                copy(k, p, kept)
            if least <= enough:
                break
        spent += newton_step(crowd, k, n, limits.PROXIMAL_TURNS[turn % 3])
        r, _, more = sweep_until(system, crowd, k, enough, BETWEEN)
        done, spent, turn = done + more, spent + more * k, turn + 1
        if r < least:
            least = r
            copy(k, p, kept)
        if least <= good and not least < CHORD_GAIN * before:
            break
        idle = 0 if least < 0.5 * before else idle + 1
    copy(k, kept, p)
    wrong = not least <= max(limits.WRONG_RESIDUAL * speed, CROWD_REST * tolerance / gamma)
    allowed_residual = max(good, limits.RESIDUAL_LIMIT * speed) if faces else good
    if (
        not least <= allowed_residual
        and not has_discs(work, k)
        and find_order(n, k, crowd.graph, crowd.problem)
    ):
        at_least = LONG_SPLIT if wrong and not faces else SPLIT
        allowed = LONG_SPLIT if not faces and (wrong or spent < left) else SPLIT
        ordered = by_reference(of_present_size(n, crowd.graph, crowd.problem))
        least, more = alternate(ordered, k, limits.RHO, enough, at_least, allowed)
        done, spent = done + more, spent + more * k
        copy(k, p, kept)
    if goal < least <= good:  # one more step for the last digits
        spent += newton_step(crowd, k, n, PROXIMAL)
        r, _, _ = residual(work, k)
        if r < least:
            least = r
        else:
            copy(k, kept, p)
    data.clocks[0].rounds += done
    counts.since += 0.2 * spent
    counts.counts[COUNT_BLOCKS] += spent
    return gamma, gamma * least


@kernel
def greatest_speed(crowd, k):
    """Return the greatest normal or tangential velocity of a point at the start [m/s]."""
    most = 0.0
    for i in range(k):
        u = crowd.closed[i].before
        most = max(most, abs(u[0]), abs(u[1]), abs(u[2]))
    return most


@kernel
def has_discs(work, k):
    """Return whether there is rolling or pivoting friction, whose bounds follow the normal impulses."""
    for i in range(k):
        if work.contact[i].kind == o.DISC:
            return True
    return False


@kernel
def newton_step(crowd, k, n, eps):
    """Make one step of Newton's method, if there is room for it; return its products with blocks."""
    if not find_order(n, k, crowd.graph, crowd.problem):
        return 0
    work, updates = (
        by_reference(of_present_size(n, crowd.graph, crowd.problem)),
        crowd.graph.count[2],
    )
    step(work, k, eps)
    return updates + 4 * k
