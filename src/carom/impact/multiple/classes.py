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
from carom.impact.multiple import layout as o
from carom.impact.thresholds import GROUP_ERROR, IMPACT_ERROR
from carom.law.alike import strike_alike
from carom.law.friction import depends_on_slip


@kernel
def reduce(given, acting, scale, index):
    """Write the W and the friction that act, and the classes of contacts; return the number of classes.

    `acting` are the contacts `given`, with space for this W and friction; `scale` is the greatest velocity.
    """
    if nothing_slips(given, scale):
        for i in range(given.k):
            acting.friction[i] = 0.0
        clean(given, acting)
        count = find_classes(acting, scale, index)
        if friction_sleeps(given, count, index):
            return count
    for i in range(given.k):
        acting.friction[i] = given.friction[i]
    clean(given, acting)
    return find_classes(acting, scale, index)


@kernel
def clean(given, acting):
    """Copy W without round-off, and without tangents of contacts that have no friction."""
    k, W, mu = given.k, given.W, acting.friction
    for a in range(3 * k):
        row, new = W[a], acting.W[a]
        rough = a % 3 == 0 or mu[a // 3] > 0.0
        for b in range(3 * k):
            value = 0.5 * (row[b] + W[b, a])
            if not (rough and (b % 3 == 0 or mu[b // 3] > 0.0)) or (
                a != b and value * value <= IMPACT_ERROR * IMPACT_ERROR * abs(row[a] * W[b, b])
            ):
                value = 0.0
            new[b] = value


@kernel
def find_classes(contacts, scale_u, index):
    """Write the class of each contact, and the first member and size of each class; return their number."""
    k, cls, first, count = contacts.k, index[o.CLASS], index[o.FIRST_MEMBER], 0
    for i in range(k):
        cls[i] = -1
        for q in range(count):
            if _same_kind(contacts, i, first[q], GROUP_ERROR * scale_u):
                cls[i] = q
                break
        if cls[i] < 0:
            cls[i] = count
            first[count] = i
            count += 1
    q = 0
    while q < count < k:
        if _split(contacts, q, count, index):
            count += 1
            q = 0  # members of other classes may be coupled to the two parts in different ways
        else:
            q += 1
    for q in range(count):
        index[o.CLASS_SIZE, q] = 0
    for i in range(k):
        index[o.CLASS_SIZE, cls[i]] += 1
    return count


@kernel
def _split(contacts, q, count, index):
    """Move the members of class `q` with another coupling than its first to a class `count`; return if any."""
    cls, first, found = index[o.CLASS], index[o.FIRST_MEMBER], False
    for i in range(first[q] + 1, contacts.k):
        if cls[i] == q and not _same_coupling(contacts, count, i, first[q], index):
            if not found:
                found = True
                first[count] = i
            cls[i] = -1 - count  # still part of the old class until all members are compared
    for i in range(contacts.k):
        if cls[i] == -1 - count:
            cls[i] = count
    return found


@kernel
def friction_sleeps(contacts, count, index):
    """Return whether friction never acts, because no normal force makes a contact slip; no contact slips now.

    `index` has the classes of contacts without friction, whose normal forces are equal.
    """
    for i in range(contacts.k):
        for r in range(1, 3 if contacts.friction[i] > 0.0 else 1):
            row = contacts.W[3 * i + r]
            for q in range(count):
                tolerance = GROUP_ERROR * _coupling_scale(contacts.W, i, index[o.FIRST_MEMBER, q])
                if not abs(_of_class(contacts.k, row, q, index[o.CLASS])) <= tolerance:
                    return False
    return True


@kernel
def _coupling_scale(W, i, j):
    """Return (W_ii W_jj)^1/2 of the greatest diagonal entries of two contacts: the bound of their coupling."""
    own = max(W[3 * i, 3 * i], W[3 * i + 1, 3 * i + 1], W[3 * i + 2, 3 * i + 2])
    other = max(W[3 * j, 3 * j], W[3 * j + 1, 3 * j + 1], W[3 * j + 2, 3 * j + 2])
    return math.sqrt(own * other)


@kernel
def _of_class(k, row, q, cls):
    """Return the sum of a row of W over the normals of class `q`."""
    total = 0.0
    for j in range(k):
        if cls[j] == q:
            total += row[3 * j]
    return total


@kernel
def nothing_slips(contacts, scale_u):
    """Return whether no contact with friction slips."""
    u = contacts.u
    for i in range(contacts.k):
        slip = abs(u[3 * i + 1]) + abs(u[3 * i + 2])
        if contacts.friction[i] > 0.0 and not slip <= GROUP_ERROR * scale_u:
            return False
    return True


@kernel
def _same_kind(contacts, i, j, tolerance):
    """Return whether contacts i and j have the same velocity, friction, restitutions, laws and stiffness."""
    u, mu, e = contacts.u, contacts.friction, contacts.restitution
    law, kappa = contacts.law, contacts.stiffness
    same = mu[i] == mu[j] and e[i] == e[j] and kappa[i] == kappa[j]
    same = same and strike_alike(contacts.laws, law[i], law[j])
    for r in range(3 if mu[i] > 0.0 else 1):
        same = same and abs(u[3 * i + r] - u[3 * j + r]) <= tolerance
    return same


@kernel
def _same_coupling(contacts, count, i, j, index):
    """Return whether contacts i and j are coupled to each class in the same way."""
    W, cls = contacts.W, index[o.CLASS]
    for q in range(count):
        tolerance = GROUP_ERROR * _coupling_scale(W, j, index[o.FIRST_MEMBER, q])
        for r in range(3):
            for s in range(3):
                difference = _difference(contacts, 3 * i + r, 3 * j + r, s, q, cls)
                if not abs(difference) <= tolerance:
                    return False
    return True


@kernel
def _difference(contacts, a, c, s, q, cls):
    """Return the difference of rows `a` and `c` of W in component `s`, summed over class `q`.

    If it is the class of these rows, with the members that leave it.
    """
    row, other, own, total = contacts.W[a], contacts.W[c], cls[c // 3] == q, 0.0
    for b in range(contacts.k):
        if cls[b] == q or (own and cls[b] < 0):
            total += row[3 * b + s] - other[3 * b + s]
    return total


@kernel
def couple(contacts, index, a, b, mass):
    """Write W between the members a and b of a group, classes p and q: sum_ij W_ij / (m_p m_q)."""
    W, cls, p, q = contacts.W, index[o.CLASS], index[o.MEMBER, a], index[o.MEMBER, b]
    size = index[o.CLASS_SIZE, p] * index[o.CLASS_SIZE, q]
    for r in range(3):
        for s in range(3):
            total = 0.0
            for i in range(contacts.k):
                for j in range(contacts.k if cls[i] == p else 0):
                    if cls[j] == q:
                        total += W[3 * i + r, 3 * j + s]
            mass[3 * a + r, 3 * b + s] = total / size


@kernel
def coupled(W, i, j):
    """Return whether contacts i and j act on each other."""
    for r in range(3):
        for s in range(3):
            if W[3 * i + r, 3 * j + s] != 0.0:
                return True
    return False


@kernel
def find_pressed(contacts, least, index):
    """Mark the contacts that approach faster than `least`, and those that forces of marked ones can press."""
    k, W, u, mu = contacts.k, contacts.W, contacts.u, contacts.friction
    pressed, stack, height = index[o.PRESSED], index[o.STACK], 0
    for i in range(k):
        pressed[i] = 0
        if u[3 * i] < -least:
            pressed[i] = 1
            stack[height] = i
            height += 1
    while height > 0:
        height -= 1
        i = stack[height]
        for j in range(k):
            if pressed[j] == 0:
                row = W[3 * j]
                side = math.sqrt(row[3 * i + 1] ** 2 + row[3 * i + 2] ** 2)
                # a law may rise above what bounds stick
                rises = depends_on_slip(contacts.laws, contacts.law[i]) and side > 0.0
                if not row[3 * i] >= (math.inf if rises else mu[i]) * side:
                    pressed[j] = 1
                    stack[height] = j
                    height += 1


@kernel
def parts_others(k, W, i, index):
    """Return whether forces of contact `i` act on contacts that no force presses."""
    for j in range(k):
        if index[o.PRESSED, j] == 0 and coupled(W, i, j):
            return True
    return False


@kernel
def find_groups(k, count, W, index):
    """Write the group of each class: classes of one group are coupled; return the number of groups.

    Classes that no force presses belong to no group (-1).
    """
    group, stack = index[o.GROUP], index[o.STACK]
    for q in range(count):
        group[q] = -1
    groups = 0
    for start in range(count):
        if group[start] >= 0 or index[o.PRESSED, index[o.FIRST_MEMBER, start]] == 0:
            continue
        group[start] = groups
        stack[0] = start
        height = 1
        while height > 0:
            height = _push_neighbours(k, W, height - 1, index)
        groups += 1
    return groups


@kernel
def _push_neighbours(k, W, height, index):
    """Add to the group of the class at `height` of the stack those coupled to it; return the new height."""
    group, stack, cls, pressed = index[o.GROUP], index[o.STACK], index[o.CLASS], index[o.PRESSED]
    q = stack[height]
    for i in range(k):
        if cls[i] != q:
            continue
        for j in range(k):
            if group[cls[j]] < 0 and pressed[j] == 1 and coupled(W, i, j):
                group[cls[j]] = group[q]
                stack[height] = cls[j]
                height += 1
    return height
