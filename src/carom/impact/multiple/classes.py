"""Exact reductions of a multiple impact.

Contacts that move alike are solved as one, contacts that no force presses are left out, and groups that do not
act on each other are solved one after the other.

Contacts form a class if they have equal velocity, friction, restitutions, law and stiffness, and equal coupling
to each class. They have the same history in the layer: m of them are one contact, whose impulse they share
equally, W_CD = sum_ij W_ij / (m_C m_D), kappa_C = m_C kappa. A box that falls flat on its face is one contact.

A contact j that does not approach stays open if all forces at the other contacts i can only separate it:
W_jn,in >= mu_i |W_jn,it|. (If one end of an edge strikes, the other end, at rest on the ground, is lifted.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.impact.thresholds import GROUP_ERROR, IMPACT_ERROR
from carom.law.alike import strike_alike
from carom.law.friction import depends_on_slip


@kernel
def reduce(k, blow, laws, scale):
    """Write the W and the friction that act, and the classes of contacts; return the number of classes.

    `scale` is the greatest velocity.
    """
    if nothing_slips(k, blow.contacts, scale):
        for i in range(k):
            blow.contacts.contact[i].acting = 0.0
        clean(k, blow)
        count = find_classes(k, blow, laws, scale)
        if friction_sleeps(k, blow, count):
            return count
    for i in range(k):
        c = blow.contacts.contact[i]
        c.acting = c.friction
    clean(k, blow)
    return find_classes(k, blow, laws, scale)


@kernel
def clean(k, blow):
    """Copy W without round-off, and without tangents of contacts that have no friction."""
    W, contact = blow.contacts.W, blow.contacts.contact
    for a in range(3 * k):
        row, new = W[a], blow.clean[a]
        rough = a % 3 == 0 or contact[a // 3].acting > 0.0
        for b in range(3 * k):
            value = 0.5 * (row[b] + W[b, a])
            if not (rough and (b % 3 == 0 or contact[b // 3].acting > 0.0)) or (
                a != b and value * value <= IMPACT_ERROR * IMPACT_ERROR * abs(row[a] * W[b, b])
            ):
                value = 0.0
            new[b] = value


@kernel
def find_classes(k, blow, laws, scale_u):
    """Write the class of each contact, and the first member and size of each class; return their number."""
    contacts, classes, count = blow.contacts, blow.classes, 0
    contact = contacts.contact
    for i in range(k):
        contact[i].of_class = -1
        for q in range(count):
            if _same_kind(contacts, laws, i, classes[q].first, GROUP_ERROR * scale_u):
                contact[i].of_class = q
                break
        if contact[i].of_class < 0:
            contact[i].of_class = count
            classes[count].first = i
            count += 1
    q = 0
    while q < count < k:
        if _split(k, blow, q, count):
            count += 1
            q = 0  # members of other classes may be coupled to the two parts in different ways
        else:
            q += 1
    for q in range(count):
        classes[q].members = 0
    for i in range(k):
        classes[contact[i].of_class].members += 1
    return count


@kernel
def _split(k, blow, q, count):
    """Move the members of class `q` with another coupling than its first to a class `count`; return if any."""
    contact, classes, found = blow.contacts.contact, blow.classes, False
    for i in range(classes[q].first + 1, k):
        if contact[i].of_class == q and not _same_coupling(k, blow, count, i, classes[q].first):
            if not found:
                found = True
                classes[count].first = i
            # still part of the old class until all members are compared
            contact[i].of_class = -1 - count
    for i in range(k):
        if contact[i].of_class == -1 - count:
            contact[i].of_class = count
    return found


@kernel
def friction_sleeps(k, blow, count):
    """Return whether friction never acts, because no normal force makes a contact slip; no contact slips now.

    The classes are those of contacts without friction, whose normal forces are equal.
    """
    contacts = blow.contacts
    for i in range(k):
        for r in range(1, 3 if contacts.contact[i].friction > 0.0 else 1):
            row = contacts.W[3 * i + r]
            for q in range(count):
                tolerance = GROUP_ERROR * _coupling_scale(contacts.W, i, blow.classes[q].first)
                if not abs(_of_class(k, row, q, contacts.contact)) <= tolerance:
                    return False
    return True


@kernel
def _coupling_scale(W, i, j):
    """Return (W_ii W_jj)^1/2 of the greatest diagonal entries of two contacts: the bound of their coupling."""
    own = max(W[3 * i, 3 * i], W[3 * i + 1, 3 * i + 1], W[3 * i + 2, 3 * i + 2])
    other = max(W[3 * j, 3 * j], W[3 * j + 1, 3 * j + 1], W[3 * j + 2, 3 * j + 2])
    return math.sqrt(own * other)


@kernel
def _of_class(k, row, q, contact):
    """Return the sum of a row of W over the normals of class `q`."""
    total = 0.0
    for j in range(k):
        if contact[j].of_class == q:
            total += row[3 * j]
    return total


@kernel
def nothing_slips(k, contacts, scale_u):
    """Return whether no contact with friction slips."""
    u = contacts.u
    for i in range(k):
        slip = abs(u[3 * i + 1]) + abs(u[3 * i + 2])
        if contacts.contact[i].friction > 0.0 and not slip <= GROUP_ERROR * scale_u:
            return False
    return True


@kernel
def _same_kind(contacts, laws, i, j, tolerance):
    """Return whether contacts i and j have the same velocity, friction, restitutions, laws and stiffness."""
    u, a, b = contacts.u, contacts.contact[i], contacts.contact[j]
    same = a.acting == b.acting and a.restitution == b.restitution and a.stiffness == b.stiffness
    same = same and strike_alike(laws, a.law, b.law)
    for r in range(3 if a.acting > 0.0 else 1):
        same = same and abs(u[3 * i + r] - u[3 * j + r]) <= tolerance
    return same


@kernel
def _same_coupling(k, blow, count, i, j):
    """Return whether contacts i and j are coupled to each class in the same way."""
    W, classes, sums = blow.clean, blow.classes, blow.sums
    for r in range(3):
        _sum_differences(k, blow, count, 3 * i + r, 3 * j + r)
        for q in range(count):
            tolerance = GROUP_ERROR * _coupling_scale(W, j, classes[q].first)
            for s in range(3):
                if not abs(sums[3 * q + s]) <= tolerance:
                    return False
    return True


@kernel
def _sum_differences(k, blow, count, a, c):
    """Write the differences of rows `a` and `c` of W, summed over each class.

    That of the class of these rows includes contacts that are leaving it.
    """
    contact, row, other, sums = blow.contacts.contact, blow.clean[a], blow.clean[c], blow.sums
    for q in range(3 * count):
        sums[q] = 0.0
    own = contact[c // 3].of_class
    for b in range(k):
        q = contact[b].of_class if contact[b].of_class >= 0 else own
        for s in range(3):
            sums[3 * q + s] += row[3 * b + s] - other[3 * b + s]


@kernel
def couple(blow, a, b, out):
    """Write W between the members a and b of a group, classes p and q: sum_ij W_ij / (m_p m_q)."""
    W, contact, k = blow.clean, blow.contacts.contact, blow.impact[0].k
    p, q = blow.members[a], blow.members[b]
    first, other = blow.classes[p], blow.classes[q]
    size = first.members * other.members
    end_p, end_q = _end_of_class(k, contact, p, first), _end_of_class(k, contact, q, other)
    for r in range(3):
        for s in range(3):
            total = 0.0
            for i in range(first.first, end_p):
                for j in range(other.first, end_q if contact[i].of_class == p else 0):
                    if contact[j].of_class == q:
                        total += W[3 * i + r, 3 * j + s]
            out[3 * a + r, 3 * b + s] = total / size


@kernel
def _end_of_class(k, contact, q, one):
    """Return the number after that of the last contact of class `q`."""
    found, i = 0, one.first
    while i < k and found < one.members:
        found += 1 if contact[i].of_class == q else 0
        i += 1
    return i


@kernel
def coupled(W, i, j):
    """Return whether contacts i and j act on each other."""
    for r in range(3):
        for s in range(3):
            if W[3 * i + r, 3 * j + s] != 0.0:
                return True
    return False


@kernel
def find_pressed(k, blow, laws, least):
    """Mark the contacts that approach faster than `least`, and those that forces of marked ones can press."""
    W, u, contact, stack, height = blow.clean, blow.contacts.u, blow.contacts.contact, blow.stack, 0
    for i in range(k):
        contact[i].pressed = 0
        if u[3 * i] < -least:
            contact[i].pressed = 1
            stack[height] = i
            height += 1
    while height > 0:
        height -= 1
        i = stack[height]
        for j in range(k):
            if contact[j].pressed == 0:
                row = W[3 * j]
                side = math.sqrt(row[3 * i + 1] ** 2 + row[3 * i + 2] ** 2)
                # a law may rise above what bounds stick
                rises = depends_on_slip(laws, contact[i].law) and side > 0.0
                if not row[3 * i] >= (math.inf if rises else contact[i].acting) * side:
                    contact[j].pressed = 1
                    stack[height] = j
                    height += 1


@kernel
def parts_others(blow, i):
    """Return whether forces of contact `i` act on contacts that no force presses."""
    for j in range(blow.impact[0].k):
        if blow.contacts.contact[j].pressed == 0 and coupled(blow.clean, i, j):
            return True
    return False


@kernel
def find_groups(k, count, blow):
    """Write the group of each class: classes of one group are coupled; return the number of groups.

    Classes that no force presses belong to no group (-1).
    """
    classes, stack = blow.classes, blow.stack
    for q in range(count):
        classes[q].group = -1
    groups = 0
    for start in range(count):
        one = classes[start]
        if one.group >= 0 or blow.contacts.contact[one.first].pressed == 0:
            continue
        one.group = groups
        stack[0] = start
        height = 1
        while height > 0:
            height = _push_neighbours(k, blow, height - 1)
        groups += 1
    return groups


@kernel
def _push_neighbours(k, blow, height):
    """Add to the group of the class at `height` of the stack those coupled to it; return the new height."""
    contact, classes, stack = blow.contacts.contact, blow.classes, blow.stack
    q = stack[height]
    for i in range(k):
        if contact[i].of_class != q:
            continue
        for j in range(k):
            other = contact[j].of_class
            if classes[other].group < 0 and contact[j].pressed == 1 and coupled(blow.clean, i, j):
                classes[other].group = classes[q].group
                stack[height] = other
                height += 1
    return height
