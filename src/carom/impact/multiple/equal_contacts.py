"""What makes an impact smaller, exactly.

Contacts that move alike are one, those that no force presses take no part, and contacts that do not reach each
other are solved apart.

Contacts of equal velocity, friction, restitution, law and stiffness whose coupling to each class of such
contacts is equal have the same history in the layer. m of them are one contact, with the impulse shared
equally: W_CD = sum_ij W_ij / (m_C m_D), kappa_C = m_C kappa. A box that falls flat on its face is one contact.

A contact that does not approach stays open, whatever the forces of the others are, if each of them can only
part it: W_jn,in >= mu_i |W_jn,it|. (One end of an edge strikes while the other lies: that one is lifted.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.impact.multiple.layout import CLASS, FIRST, GROUP, PRESSED, SIZE, STACK

SAME = 1e-11  # relative difference of velocities and inverse masses that is round-off
_NONE = 1e-13  # coupling below this part of the diagonal is round-off


@kernel
def clean(k, W, mu, out):
    """Copy W, without what rounds to nothing and without tangents where there is no friction."""
    largest = 0.0
    for a in range(3 * k):
        row, new = W[a], out[a]
        rough = a % 3 == 0 or mu[a // 3] > 0.0
        largest = max(largest, abs(row[a]))
        for b in range(3 * k):
            value = 0.5 * (row[b] + W[b, a])
            if not (rough and (b % 3 == 0 or mu[b // 3] > 0.0)) or (
                a != b and value * value <= _NONE * _NONE * abs(row[a] * W[b, b])
            ):
                value = 0.0
            new[b] = value
    return largest


@kernel
def find_classes(k, W, u, mu, e, law, kappa, scale_W, scale_u, index):
    """Write the class of each contact, the first member and the size of each class; return how many."""
    cls, first = index[CLASS], index[FIRST]
    count = 0
    for i in range(k):
        cls[i] = -1
        for q in range(count):
            j = first[q]
            if (
                mu[i] == mu[j] and e[i] == e[j] and law[i] == law[j] and kappa[i] == kappa[j]
                and _same_velocity(u, i, j, mu[i] > 0.0, SAME * scale_u)
            ):  # fmt: skip
                cls[i] = q
                break
        if cls[i] < 0:
            cls[i] = count
            first[count] = i
            count += 1
    split = True
    while split and count < k:
        split = False
        for q in range(count):
            new = -1
            for i in range(first[q] + 1, k):
                if cls[i] != q or _same_coupling(k, W, cls, count, i, first[q], SAME * scale_W):
                    continue
                if new < 0:
                    new = count
                    first[new] = i
                cls[i] = -1 - new  # counts as its old class until all members are compared
            if new >= 0:
                for i in range(k):
                    if cls[i] == -1 - new:
                        cls[i] = new
                count += 1
                split = True
                break
    for q in range(count):
        index[SIZE, q] = 0
    for i in range(k):
        index[SIZE, cls[i]] += 1
    return count


@kernel
def friction_sleeps(k, W, mu, count, scale_W, index):
    """Return whether friction never acts on contacts that do not slip: no normal force makes them slip.

    `index` has the classes of contacts without friction, whose normal forces are equal.
    """
    for i in range(k):
        if not mu[i] > 0.0:
            continue
        for r in range(1, 3):
            for q in range(count):
                total = 0.0
                for j in range(k):
                    if index[CLASS, j] == q:
                        total += W[3 * i + r, 3 * j]
                if not abs(total) <= SAME * scale_W:
                    return False
    return True


@kernel
def nothing_slips(k, u, mu, scale_u):
    """Return whether no contact with friction slips."""
    for i in range(k):
        slip = abs(u[3 * i + 1]) + abs(u[3 * i + 2])
        if mu[i] > 0.0 and not slip <= SAME * scale_u:
            return False
    return True


@kernel
def _same_velocity(u, i, j, rough, tolerance):
    same = abs(u[3 * i] - u[3 * j]) <= tolerance
    for r in range(1, 3 if rough else 1):
        same = same and abs(u[3 * i + r] - u[3 * j + r]) <= tolerance
    return same


@kernel
def _same_coupling(k, W, cls, count, i, j, tolerance):
    """Return whether contacts i and j are coupled to each class in the same way."""
    for q in range(count):
        for r in range(3):
            for s in range(3):
                difference = 0.0
                for b in range(k):
                    c = cls[b]
                    if c == q or (c < 0 and cls[j] == q):
                        difference += W[3 * i + r, 3 * b + s] - W[3 * j + r, 3 * b + s]
                if not abs(difference) <= tolerance:
                    return False
    return True


@kernel
def class_coupling(k, W, index, p, q, r, s):
    """Return the entry (r, s) of W between classes p and q: sum_ij W_ij / (m_p m_q)."""
    total = 0.0
    for i in range(k):
        if index[CLASS, i] == p:
            for j in range(k):
                if index[CLASS, j] == q:
                    total += W[3 * i + r, 3 * j + s]
    return total / (index[SIZE, p] * index[SIZE, q])


@kernel
def coupled(W, i, j):
    """Return whether contacts i and j act on each other."""
    for r in range(3):
        for s in range(3):
            if W[3 * i + r, 3 * j + s] != 0.0:
                return True
    return False


@kernel
def find_pressed(k, W, u, mu, least, index):
    """Note the contacts that approach faster than `least`, and those that forces of such can press."""
    pressed, stack, height = index[PRESSED], index[STACK], 0
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
                if not row[3 * i] >= mu[i] * side:
                    pressed[j] = 1
                    stack[height] = j
                    height += 1


@kernel
def parts_others(k, W, i, index):
    """Return whether forces of contact `i` act on others that nothing presses."""
    for j in range(k):
        if index[PRESSED, j] == 0 and coupled(W, i, j):
            return True
    return False


@kernel
def find_groups(k, count, W, index):
    """Write the group of each class: classes that reach each other; return how many.

    Classes that nothing presses are of no group (-1).
    """
    group, stack, cls, pressed, first = (
        index[GROUP], index[STACK], index[CLASS], index[PRESSED], index[FIRST],
    )  # fmt: skip
    for q in range(count):
        group[q] = -1
    groups = 0
    for start in range(count):
        if group[start] >= 0 or pressed[first[start]] == 0:
            continue
        group[start] = groups
        stack[0] = start
        height = 1
        while height > 0:
            height -= 1
            q = stack[height]
            for i in range(k):
                if cls[i] != q:
                    continue
                for j in range(k):
                    if group[cls[j]] < 0 and pressed[j] == 1 and coupled(W, i, j):
                        group[cls[j]] = groups
                        stack[height] = cls[j]
                        height += 1
        groups += 1
    return groups
