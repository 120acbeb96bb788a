"""The points that carry the contact of a group of bodies in a state, found anew in each, and their springs.

Points have no memory: a corner of an overlap that wanders, appears or vanishes is no event. That needs one rule
for who carries, which is continuous in the positions. The points of two bodies (or of a body and all that never
moves) in one plane are a patch; only the corners of its convex hull carry, each with the weight

    k_i = half of the two sides next to it, over the perimeter.

A corner that splits into two at an edge, or two that merge, change no sum of forces. A line has weights 1/2,
1/2, a single point 1. A point presses like a spring: its compliance is (1/m_a + 1/m_b)/k_i, in units so small
that only the ratios matter (`carom.persistent.springs`). (Mathematics page, persistent contact.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.kinds.found_points import nearest_touch, which_touch
from carom.contact.kinds.level_surfaces import is_beside, is_of_moving, related
from carom.contact.kinds.partner import smaller
from carom.contact.kinds.rim import place_of, same_point
from carom.contact.operations import (
    active_reach,
    add_touch,
    find_active_touch,
    find_touches,
    forms_faces,
    list_touches,
    place,
)
from carom.contact.point_lists import is_active, write_closed, write_turning
from carom.contact.thresholds import NORMAL_ERROR, PLACE_ERROR, REACH
from carom.geometry.rotation import cross, rotate_back
from carom.geometry.thresholds import RESOLUTION, ROUND_OFF
from carom.kinematics.anisotropy import lengths_of_tangents, turn_plain
from carom.kinematics.contact_point import copy_point
from carom.law.turning import arm_of_torque
from carom.model.workspace import CONSTANT, MOTION_PIVOT, MOTION_POINT, MOTION_ROLL
from carom.persistent.active_set import is_first
from carom.persistent.joint_rows import add_frictions
from carom.persistent.thresholds import (
    LEAST_STICK,
    STICK_COMPLIANCE,
    STICK_OF_BODIES,
    STICK_OF_MASSES,
)

#: places in `Group.count`: of the first active point of the group, and behind the last
FIRST_OF_GROUP, END_OF_GROUP = 2, 3


@kernel
def note_range(active, label, group, work):
    """Write between which numbers the active points of a group are.

    Many groups share an island, and each of them finds its points several times in a step.
    """
    first, end = active.count[0], 0
    for i in range(active.count[0]):
        if work.body[active.points[i].body].label == label:
            first, end = min(first, i), i + 1
    group.count[FIRST_OF_GROUP], group.count[END_OF_GROUP] = first, end


@kernel
def find_points(system, data, label):
    """List the points of all pairs of a group in `work.stage`, then other friction; return the number."""
    active, group, work, k = data.active, data.group, data.work, 0
    for i in range(group.count[FIRST_OF_GROUP], group.count[END_OF_GROUP]):
        active_point = active.points[i]
        if work.body[active_point.body].label != label:
            continue
        if active_point.found == 0:
            k = add_known(system, data, i, k)
        elif is_first(active, i, group.count[FIRST_OF_GROUP]):
            k = add_pair(system, data, i, k)
    k = add_turning(system, active, k, group)
    k = add_frictions(system, label, work.stage, k, group, work)
    weigh(system, k, group)
    return k


@kernel
def add_known(system, data, i, k):
    """Add a point whose place is known; return the new count."""
    group, work, one = data.group, data.work, data.active.points[i]
    if k == group.closed.shape[0]:
        group.count[1] += 1
        return k
    closed_point = group.closed[k]
    write_closed(one.contact, one.feature, one.point, k, closed_point)
    closed_point.active, closed_point.listed = i, 1
    contact = system.contacts[one.contact]
    place(system, contact, one, work.stage, group.points[0][k], work)
    return k + 1


@unit
def add_pair(system, data, i, k) -> int:
    """Add the found points of a contact: of a face all its corners, else those of the active features.

    If no points belong together, those of the active features are found one by one. Return the new count.
    """
    active, state, work = data.active, data.work.stage, data.work
    c, end = active.points[i].contact, data.group.count[END_OF_GROUP]
    contact = system.contacts[c]
    if not forms_faces(contact):
        for j in range(i, end):
            if active.points[j].contact == c:
                one = active.points[j]
                t = find_active_touch(system, contact, one.feature, one.point, state, work)
                k = add_found(system, data, c, work.touches[t], j, k)
                data.group.closed[k - 1].listed = 1
        return k
    if is_of_moving(contact) and has_left(system, data, c):
        return k
    list_touches(system, contact, state, active_reach(system, contact), work)
    m = nearest_touch(work).normal
    n = (m[0], m[1], m[2])
    if not on_face(contact, data, i, n):
        for j in range(i, end):
            if active.points[j].contact == c:
                k = add_nearest(system, data, j, k)
        return k
    k = add_face(system, data, c, i, k)
    for d in range(system.contacts.shape[0]):
        if d != c and is_beside(contact, system.contacts[d]) and not is_active(active, d):
            k = add_face(system, data, d, i, k)
    for d in range(system.contacts.shape[0] if is_of_moving(contact) else 0):
        if d != c and not is_active(active, d) and related(system, c, d):
            k = add_riding(system, data, d, i, k, n)
    return k


@kernel
def has_left(system, data, c):
    """Return whether the bodies of a row have passed a seam of its solids, and ride on those of another row."""
    contact, active, work, state = system.contacts[c], data.active, data.work, data.work.stage
    if find_touches(system, contact, state, REACH * smaller(contact), work) > 0:
        return False
    for j in range(active.count[0]):
        d = active.points[j].contact
        if d != c and active.points[j].found == 1 and related(system, c, d):
            other = system.contacts[d]
            if find_touches(system, other, state, REACH * smaller(other), work) > 0:
                return True
    return False


@kernel
def add_riding(system, data, c, i, k, n):
    """Add the corners of a related row on the level surface with the normal n of active point i."""
    state, work, contact = data.work.stage, data.work, system.contacts[c]
    near = RESOLUTION * smaller(contact)
    for t in range(find_touches(system, contact, state, near, work)):
        touch = work.touches[t]
        across = 0.0
        for r in range(3):
            across = max(across, abs(touch.normal[r] - n[r]))
        if touch.surface > 0 and touch.gap <= near and across <= NORMAL_ERROR:
            k = add_found(system, data, c, touch, i, k)
    return k


@kernel
def on_face(contact, data, i, n):
    """Return whether active points of two bodies span a part of the plane through point i with the normal n.

    Points on a line, or in other planes, do not tell whether a corner at some distance is closed.
    """
    active, group, q = data.active, data.group, data.work.stage[contact.body].Q
    p, level = active.points[i].point, NORMAL_ERROR * smaller(contact)
    m, x, y, z, far = rotate_back(q, n), 0.0, 0.0, 0.0, level
    for find_end in (True, False):
        for j in range(group.count[FIRST_OF_GROUP], group.count[END_OF_GROUP]):
            other = active.points[j]
            if other.body != contact.body or other.other != contact.other:
                continue
            a, b, c = other.point[0] - p[0], other.point[1] - p[1], other.point[2] - p[2]
            if abs(a * m[0] + b * m[1] + c * m[2]) > level:
                continue
            if not find_end:
                a, b, c = cross(a, b, c, x, y, z)
            distance = math.sqrt(a * a + b * b + c * c)
            if not find_end and distance > level * far:
                return True
            if find_end and distance > far:
                x, y, z, far = a, b, c, distance
        if far == level:  # no other point is there
            return False
    return False


@kernel
def add_face(system, data, c, i, k):
    """Add all corners of a face; the active point i stands for those that are not active."""
    state, work, contact, near = data.work.stage, data.work, system.contacts[c], math.inf
    count = find_touches(system, contact, state, active_reach(system, contact), work)
    for t in range(count):
        near = min(near, work.touches[t].gap + REACH * smaller(contact))
    for t in range(count if near < 2.0 * REACH * smaller(contact) else 0):
        if work.touches[t].gap <= near:
            k = add_found(system, data, c, work.touches[t], i, k)
            own = place_of(system, data.active, c, work.touches[t], state)
            if own >= 0:
                data.group.closed[k - 1].active, data.group.closed[k - 1].listed = own, 1
    return k


@kernel
def add_nearest(system, data, j, k):
    """Add the found point with the feature of an active one, or the nearest one, if it is not there yet."""
    one, state, group, work = data.active.points[j], data.work.stage, data.group, data.work
    c = one.contact
    contact = system.contacts[c]
    t = which_touch(system, contact, one.feature, one.point, state, work)
    touch = work.touches[t]
    for i in range(k):
        if group.closed[i].contact == c and group.closed[i].feature == touch.feature:
            if same_point(system, contact, touch, touch.feature, group.closed[i].point, state):
                return k
    k = add_found(system, data, c, touch, j, k)
    group.closed[k - 1].listed = 1
    return k


@kernel
def add_found(system, data, c, touch, j, k):
    """Add a found point, with the active point j of its pair to stand for it; return the new count."""
    group = data.group
    if k == group.closed.shape[0]:
        group.count[1] += 1
        return k
    add_touch(system.contacts[c], c, touch, data.work.stage, k, group)
    group.closed[k].active, group.closed[k].listed = j, 0
    return k + 1


@kernel
def add_turning(system, active, k, group):
    """Add entries for the rolling and pivoting friction of k points; return the new count.

    While bounces that were left out would last, these torques do not act.
    """
    total = k
    for i in range(k):
        closed_point = group.closed[i]
        contact = system.contacts[closed_point.contact]
        if active.points[closed_point.active].bounces > 0.0:
            continue
        for motion in (MOTION_ROLL, MOTION_PIVOT):
            turns = arm_of_torque(system.laws, contact, motion) > 0.0
            if turns and total == group.closed.shape[0]:
                group.count[1] += 1
            elif turns:
                more, point = group.closed[total], group.points[0][total]
                write_turning(i, motion, closed_point, more)
                more.listed = closed_point.listed
                copy_point(group.points[0][i], point)
                turn_plain(contact, motion, smaller(contact), point)
                total += 1
    return total


@kernel
def weigh(system, k, group):
    """Write weight and compliance of the spring of each point: corners of the hull of its patch have one."""
    points, softness = group.points[0], softness_of_stick(system, k, group)
    for i in range(k):
        group.closed[i].weight, group.closed[i].patch, group.closed[i].presses = -1.0, -1, 0
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.motion != MOTION_POINT:
            bounded = (
                closed_point.parent != CONSTANT
            )  # by a force: as soft as the stick of its point
            closed_point.weight, closed_point.stick = 1.0, softness if bounded else 1.0
            continue
        if closed_point.weight < 0.0:
            weigh_patch(system, i, k, group)
        s = 1.0 / system.bodies[points[i].a].mass
        if points[i].b >= 0:
            s += 1.0 / system.bodies[points[i].b].mass
        closed_point.spring = s / closed_point.weight if closed_point.weight > 0.0 else 0.0
        closed_point.stick = softness * closed_point.spring


@kernel
def softness_of_stick(system, k, group):
    """Return the compliance of stick relative to that of pressing: less for many bodies, or masses far apart.

    What holds a heavy body by friction on a light one, or n bodies in a row, which bend n^3 times as easily as
    one turns, is found by corrections as many times their own size.
    """
    points, least, most, count = group.points[0], math.inf, 0.0, 0
    for i in range(k):
        if count**3 < STICK_OF_BODIES / LEAST_STICK and is_first_of_body(i, points):
            count += 1
        if group.closed[i].motion == MOTION_POINT:
            m = system.bodies[points[i].a].mass
            least, most = min(least, m), max(most, m)
            if points[i].b >= 0:
                m = system.bodies[points[i].b].mass
                least, most = min(least, m), max(most, m)
    if not most > 0.0:
        return STICK_COMPLIANCE
    softest = min(STICK_COMPLIANCE, STICK_OF_BODIES / count**3)
    return max(LEAST_STICK, min(softest, STICK_OF_MASSES * least / most))


@kernel
def is_first_of_body(i, points):
    """Return whether no point before point i is of its first body."""
    for j in range(i):
        if points[j].a == points[i].a:
            return False
    return True


@kernel
def in_patch(system, p, q):
    """Return whether two points are of the same bodies, in one plane."""
    points = p.motion == MOTION_POINT and q.motion == MOTION_POINT
    if not points or p.a != q.a or (p.b != q.b and max(p.b, q.b) >= 0):
        return False
    n, m, size = p.axes[0], q.axes[0], system.bodies[p.a].extent
    across, height = 0.0, 0.0
    for r in range(3):
        across = max(across, abs(n[r] - m[r]))
        height += n[r] * (q.arm_a[r] - p.arm_a[r])
    return across <= NORMAL_ERROR and abs(height) <= NORMAL_ERROR * size


@kernel
def weigh_patch(system, first, k, group):
    """Write the weights of the patch of a point: walk round its hull from the outermost point, side by side."""
    points, closed, perimeter = group.points[0], group.closed, 0.0
    size, start, last = system.bodies[points[first].a].extent, first, first
    for j in range(first, k):
        if closed[j].motion == MOTION_POINT and closed[j].weight < 0.0:
            if in_patch(system, points[first], points[j]):
                closed[j].weight, closed[j].patch, last = 0.0, first, j
                x, y = in_plane(points[first], points[j])
                a, b = in_plane(points[first], points[start])
                if x < a - PLACE_ERROR * size or (x < a + PLACE_ERROR * size and y < b):
                    start = j
    if last == first:
        closed[first].weight = 1.0
        return
    here = start
    for _ in range(k):
        there, side = next_corner(size, first, here, last + 1, group)
        if there < 0:
            break
        closed[here].weight += 0.5 * side
        closed[there].weight += 0.5 * side
        perimeter += side
        here = there
        if here == start:
            break
    for j in range(first, last + 1):
        if closed[j].patch == first:
            closed[j].weight = closed[j].weight / perimeter if perimeter > 0.0 else 0.0
    if not perimeter > 0.0:
        closed[start].weight = 1.0


@kernel
def in_plane(origin, point):
    """Return the place of a point in the plane of the patch."""
    r, E = point.arm_a, origin.axes
    x = E[1, 0] * r[0] + E[1, 1] * r[1] + E[1, 2] * r[2]
    y = E[2, 0] * r[0] + E[2, 1] * r[1] + E[2, 2] * r[2]
    a, b = lengths_of_tangents(origin)
    return (x, y) if abs(a - 1.0) <= ROUND_OFF else (x / a, y / b)


@kernel
def next_corner(size, first, here, k, group):
    """Return the next corner counter-clockwise, and the side in between; -1 if there is none."""
    points, closed = group.points[0], group.closed
    x0, y0 = in_plane(points[first], points[here])
    best, length, bx, by = -1, 0.0, 0.0, 0.0
    for j in range(first, k):
        if closed[j].patch != first or j == here:
            continue
        x, y = in_plane(points[first], points[j])
        x, y = x - x0, y - y0
        d = math.sqrt(x * x + y * y)
        if d <= PLACE_ERROR * size:  # the same corner
            continue
        if best >= 0:
            turn = bx * y - by * x  # below 0: to the right of the side
            if turn > PLACE_ERROR * size * length:
                continue
            if turn >= -PLACE_ERROR * size * length and d <= length:
                continue
        best, length, bx, by = j, d, x, y
    return best, length
