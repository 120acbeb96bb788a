"""The bodies that may meet in a step: each has a ball around its path, and overlapping balls form an island.

As long as a body meets nothing, it moves at most v h + g h^2 in a step h, where v is a bound of the speed of
its points. In a set of bodies that meet, none moves faster than twice the greatest speed, unless a heavy body
throws a light one: then a body leaves its ball, which is detected, and the step is repeated with more room. So
islands are exact: bodies of different islands have not met.

Balls overlap where bodies are far from each other, the more so around long ones. So two convex solids are an
island only if they are nearer than their points can move: the reach of both, which counts their rotation, too.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.sweep import sweep
from carom.contact.operations import distance, room
from carom.geometry.rotation import norm, rotate_back
from carom.kinematics.reach import way_of_turn
from carom.model import records as r
from carom.model.workspace import FREE, RESTS
from carom.stepping.islands.layout import ASLEEP, FLIES, IN_ISLAND
from carom.stepping.islands.order import sort_contacts, sort_pairs
from carom.stepping.thresholds import (
    BALL_SLACK,
    MEETING_STEPS,
    NEAR_REACH,
    PARTED_STEPS,
    SPEED_UP,
    START_ROOM,
)

READY = -1  # no array must grow


@kernel
def root(member, b):
    """Return the lowest body of the set of b."""
    while member[b].parent != b:
        member[b].parent = member[member[b].parent].parent
        b = member[b].parent
    return b


@kernel
def join(member, a, b):
    """Join the sets of two bodies; return whether they were different sets."""
    a, b = root(member, a), root(member, b)
    if a == b:
        return False
    a, b = min(a, b), max(a, b)
    member[b].parent = a
    member[a].bodies += member[b].bodies
    member[a].awake = max(member[a].awake, member[b].awake)
    member[a].speed = max(member[a].speed, member[b].speed)
    member[a].swing = max(member[a].swing, member[b].swing)
    return True


@kernel
def seek(system, active, now, length, work, islands):
    """Find the sets of bodies that may meet; return `READY`, or the arrays that must grow first."""
    member, plan, fall = islands.member, islands.plan[0], norm(system.gravity)
    islands.known[:] = 0
    for b in range(system.bodies.shape[0]):
        v, w, memory, m = now[b].v, now[b].w, work.body[b], member[b]
        m.parent, m.bodies, m.awake = b, 1, 0 if memory.status == RESTS else 1
        m.speed = norm(v) + norm(w) * system.bodies[b].ball
        m.swing = norm(v) + way_of_turn(system.bodies[b], rotate_back(now[b].Q, w))
        if system.bodies[b].ballistic == 0:  # `bound` is of the last step
            m.speed += memory.bound[0] * length
        memory.room = m.awake * plan.widen * (m.speed + fall * length) * length
        if not m.speed + fall * length > 0.0:  # it starts from rest, with a force of unknown size
            memory.room = m.awake * (plan.widen - 1.0) * START_ROOM * system.bodies[b].extent
        for k in range(3):
            memory.home[k] = now[b].x[k]
            islands.centre[b, k] = now[b].x[k]
        for k in range(4):
            memory.facing[k] = now[b].Q[k]
    join_joined(islands, islands.joined.component)
    for i in range(active.count[0]):
        if active.points[i].other >= 0:
            join(member, active.points[i].body, active.points[i].other)
    for turn in range(20):
        for b in range(system.bodies.shape[0]):
            whole, memory, ball = member[root(member, b)], work.body[b], system.bodies[b].ball
            memory.reach = math.inf
            if turn > 0 and whole.awake == 1 and whole.bodies > 1:
                room = SPEED_UP * plan.widen * (whole.speed + fall * length) * length
                memory.room = max(memory.room, room)
            islands.radius[b] = (1.0 + BALL_SLACK) * ball + memory.room if ball > 0.0 else -1.0
        plan.pairs = sweep(islands.centre, islands.radius, islands.pair[0], islands.sweep)
        if plan.pairs > islands.pair.shape[1]:
            return r.FULL_PAIRS
        if not join_pairs(system, now, length, work, islands) and turn > 0:
            break
    if plan.open == 1 and any_new(islands):
        return note_new(system, work, islands)
    sort_pairs(islands)
    return keep_clusters(islands)


@kernel
def join_joined(islands, number):
    """Join the sets of joined bodies with the same number."""
    first = islands.joined.first
    write_firsts(islands, number)
    for b in islands.joined.body:
        join(islands.member, first[number[b]], b)


@kernel
def write_firsts(islands, number):
    """Write the first of the joined bodies with each number."""
    joined, first = islands.joined, islands.joined.first
    for k in range(first.shape[0]):
        first[k] = -1
    for b in joined.body:
        if first[number[b]] < 0:
            first[number[b]] = b


@kernel
def keep_clusters(islands):
    """Join the sets of each cluster, unless this was needless for many steps; return as `seek` does."""
    member, joined, parted = islands.member, islands.joined, islands.parted
    if parted.shape[0] == 0:
        return READY
    if parted[0] >= PARTED_STEPS:
        return r.CLUSTERS_PART
    write_firsts(islands, joined.cluster)
    parted[1] = 0
    for b in joined.body:
        if root(member, b) != root(member, joined.first[joined.cluster[b]]):
            parted[1] = 1
    join_joined(islands, joined.cluster)
    return READY


@kernel
def any_new(islands):
    """Return whether two bodies may meet that have no contact yet."""
    for p in range(islands.plan[0].pairs):
        if is_new(islands, islands.pair[0, p, 0], islands.pair[0, p, 1]):
            return True
    return False


@kernel
def is_new(islands, i, j):
    """Return whether two bodies, not both asleep, may touch and have no contact yet."""
    member = islands.member
    awake = member[root(member, i)].awake + member[root(member, j)].awake
    return awake > 0 and first_contact(islands, i, j) < 0


@kernel
def note_new(system, work, islands):
    """List pairs of bodies without a contact that may meet in this step or soon; return the array to grow.

    Pairs of some further steps are included, because the loop is left to make their contacts.
    """
    plan, pair = islands.plan[0], islands.pair[0]
    for b in range(system.bodies.shape[0]):
        if islands.radius[b] > 0.0:
            islands.radius[b] += min(MEETING_STEPS * work.body[b].room, system.bodies[b].ball)
    plan.pairs = sweep(islands.centre, islands.radius, pair, islands.sweep)
    if plan.pairs > pair.shape[0]:
        return r.FULL_PAIRS
    plan.noted = 0
    for p in range(plan.pairs):
        i, j = pair[p, 0], pair[p, 1]
        if is_new(islands, i, j):
            pair[plan.noted, 0], pair[plan.noted, 1] = i, j
            plan.noted += 1
    return r.NEW_PAIRS


@kernel
def join_pairs(system, now, length, work, islands):
    """Join the sets of all pairs that may touch, unless both are asleep; return whether any set was joined."""
    member, any_joined, more = islands.member, False, True
    while more:
        more = False
        for p in range(islands.plan[0].pairs):
            i, j = islands.pair[0, p, 0], islands.pair[0, p, 1]
            awake = member[root(member, i)].awake + member[root(member, j)].awake
            if awake == 0 or root(member, i) == root(member, j) or not may_touch(islands, i, j):
                continue
            if not stay_apart(system, now, length, work, islands, p):
                join(member, i, j)
                more, any_joined = True, True
    return any_joined


@kernel
def stay_apart(system, now, length, work, islands, p):
    """Return whether the bodies of pair p are farther from each other than their points move in the step."""
    i, j, bodies, need = islands.pair[0, p, 0], islands.pair[0, p, 1], system.bodies, 0.0
    q = first_contact(islands, i, j)
    if q < 0:
        return False
    for b in (i, j):
        reach = reach_of(system, b, length, islands)
        if bodies[b].ballistic == 0 or not reach < bodies[b].ball:  # it may turn round
            return False
        need += reach + BALL_SLACK * bodies[b].ball
    if islands.known[q] == 0:
        islands.known[q], islands.gap[q] = 1, least_distance(system, now, work, islands, i, q)
    if not islands.gap[q] > need:
        return False
    for b in (i, j):
        work.body[b].reach = reach_of(system, b, length, islands)
    return True


@kernel
def reach_of(system, b, length, islands):
    """Return how far points of a body may move in the step, or it is repeated with more room."""
    whole = islands.member[root(islands.member, b)]
    speed = whole.swing + norm(system.gravity) * length
    return whole.awake * NEAR_REACH * islands.plan[0].widen * speed * length


@kernel
def least_distance(system, now, work, islands, i, first):
    """Return a lower bound of the distance of body i and a partner, whose contacts begin at place `first`."""
    least, other, q = math.inf, islands.partner[0, first], first
    while q < islands.partner_first[i + 1] and islands.partner[0, q] == other:
        gap = distance(system, system.contacts[islands.partner[1, q]], now, work)
        if not gap > 0.0:  # NaN counts as touch
            return 0.0
        least, q = min(least, gap), q + 1
    return least


@kernel
def may_touch(islands, i, j):
    """Return whether two bodies i < j may touch: they have a contact, or can get one."""
    q = first_contact(islands, i, j)
    return islands.partner[1, q] >= 0 if q >= 0 else islands.plan[0].open == 1


@kernel
def first_contact(islands, i, j):
    """Return the place among partners of the first contact of bodies i < j, -1 if they are not partners."""
    low, high = islands.partner_first[i], islands.partner_first[i + 1]
    end = high
    while low < high:
        middle = (low + high) // 2
        if islands.partner[0, middle] < j:
            low = middle + 1
        else:
            high = middle
    return low if low < end and islands.partner[0, low] == j else -1


@kernel
def near_plane(system, c, now, work):
    """Return whether a body may reach a half-space or a static body in the step."""
    contact = system.contacts[c]
    slack = BALL_SLACK * (contact.extent + contact.other_extent)
    return room(system, contact, now, False) <= slack + work.body[contact.body].room


@kernel
def number(system, active, now, work, islands):
    """Give numbers to islands, and slots to bodies, contacts and active points; return as `seek` does."""
    member, plan, n = islands.member, islands.plan[0], system.bodies.shape[0]
    for b in range(n):
        member[b].island = -1
        member[b].kind = kind_of(system, b, now, work, islands)
    plan.count = 0
    for b in range(n):  # the root is the lowest body of its set
        if member[b].kind == IN_ISLAND and root(member, b) == b:
            member[b].island = plan.count
            plan.count += 1
        islands.cluster[b] = -1
    for b in islands.joined.body:
        island = member[root(member, b)].island
        if island < 0:
            continue
        if islands.cluster[island] < 0:
            islands.cluster[island] = islands.joined.cluster[b]
        elif islands.cluster[island] != islands.joined.cluster[b]:
            return r.CLUSTERS_MEET
    for s in range(3):
        for i in range(plan.count + 1):
            islands.first[s, i] = 0
    for phase in range(2):  # count, then fill
        list_bodies(system, active, islands, phase)
        list_contacts(system, now, work, islands, phase)
        for s in range(3 if phase == 0 else 0):
            ranges(islands, s)
        plan.used = islands.first[1, plan.count]
        if plan.used > islands.which.shape[0]:
            return r.FULL_PAIRS
    for s in range(3):
        back(islands, s)
    for slot in range(islands.first[0, plan.count]):
        member[islands.body_of[slot]].place = slot
    sort_contacts(system, islands)
    return READY


@kernel
def kind_of(system, b, now, work, islands):
    """Return the state of a body in the step: ASLEEP, FLIES (nothing is near), or IN_ISLAND (in an island)."""
    whole = islands.member[root(islands.member, b)]
    if whole.awake != 1:
        return ASLEEP
    if whole.bodies != 1 or work.body[b].status != FREE or system.bodies[b].ballistic == 0:
        return IN_ISLAND
    for q in range(islands.plane_first[b], islands.plane_first[b + 1]):
        if near_plane(system, islands.plane[q], now, work):
            return IN_ISLAND
    return FLIES


@kernel
def list_contacts(system, now, work, islands, phase):
    """Count (phase 0) or write (1) the contacts of islands; contacts with half-spaces come first."""
    member, plan = islands.member, islands.plan[0]
    for c in islands.joined.stops:
        b = system.contacts[c].body
        put(islands, 1, phase, member[root(member, b)].island, c)
    for b in range(system.bodies.shape[0]):
        if member[b].kind == IN_ISLAND:
            for q in range(islands.plane_first[b], islands.plane_first[b + 1]):
                if near_plane(system, islands.plane[q], now, work):
                    put(islands, 1, phase, member[root(member, b)].island, islands.plane[q])
    for p in range(plan.pairs):
        i, j = islands.pair[0, p, 0], islands.pair[0, p, 1]
        island = member[root(member, i)].island
        q = first_contact(islands, i, j)
        if island < 0 or q < 0 or root(member, j) != root(member, i):
            continue
        if islands.partner[1, q] < 0:  # the two never touch
            continue
        while q < islands.partner_first[i + 1] and islands.partner[0, q] == j:
            put(islands, 1, phase, island, islands.partner[1, q])
            q += 1


@kernel
def list_bodies(system, active, islands, phase):
    """Count (phase 0) or write (1) the bodies and the active points of islands, joined bodies first."""
    member = islands.member
    for b in islands.joined.body:
        put(islands, 0, phase, member[root(member, b)].island, b)
    for b in range(system.bodies.shape[0]):
        if system.bodies[b].ballistic == 1:
            put(islands, 0, phase, member[root(member, b)].island, b)
    for i in range(active.count[0]):
        put(islands, 2, phase, member[root(member, active.points[i].body)].island, i)


@kernel
def ranges(islands, s):
    """Convert the counts of the islands to first places; the last entry is the sum."""
    total = 0
    for i in range(islands.plan[0].count):
        count = islands.first[s, i]
        islands.first[s, i] = total
        total += count
    islands.first[s, islands.plan[0].count] = total


@kernel
def back(islands, s):
    """Convert the places at which filling has ended back to first places."""
    for i in range(islands.plan[0].count - 1, 0, -1):
        islands.first[s, i] = islands.first[s, i - 1]
    if islands.plan[0].count > 0:
        islands.first[s, 0] = 0


@kernel
def put(islands, s, phase, island, i):
    """Count a body, contact or active point (s = 0, 1, 2) of an island, or write it to the next slot."""
    if island < 0:
        return
    if phase == 1:
        slots = islands.body_of if s == 0 else islands.which if s == 1 else islands.active_of
        slots[islands.first[s, island]] = i
    islands.first[s, island] += 1
