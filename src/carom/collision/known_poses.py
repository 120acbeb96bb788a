"""Places of two profiles that were found in a pose before: they are kept, and found again bit by bit."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.found import put, put_parts


@kernel
def is_pose_of(one, pair, reach):
    """Return whether what is known of a pose is that of the present one, bit by bit, and goes far enough."""
    s, same = pair.state, one.first[0] == pair.a.first and one.first[1] == pair.b.first
    same = same and one.reach >= reach
    for i in range(3):
        same = same and one.p[i] == s.p[i]
        for j in range(3):
            same = same and one.R[i, j] == s.R[i, j]
    return same


@kernel
def recall(pair, reach):
    """Write the places that were found in this pose before, and return how many; -1 if it is not known.

    A state is looked at once for each point of a contact, and again after each trial step that is cut.
    """
    for k in range(pair.poses.shape[0]):
        one = pair.poses[k]
        if is_pose_of(one, pair, reach):
            for i in range(one.total):
                copy_found(pair.known[k, i], pair.found[i])
            pair.state.count[0], pair.state.count[1] = one.cross[0], one.cross[1]
            return one.total
    return -1


@kernel
def remember(pair, reach, count):
    """Keep the places that were found, in the place of those that were kept first."""
    if count > pair.known.shape[1]:
        return
    k = pair.poses[0].next
    pair.poses[0].next = (k + 1) % pair.poses.shape[0]
    one, s = pair.poses[k], pair.state
    for i in range(3):
        one.p[i] = s.p[i]
        for j in range(3):
            one.R[i, j] = s.R[i, j]
    one.first[0], one.first[1], one.total = pair.a.first, pair.b.first, count
    one.cross[0], one.cross[1], one.reach = s.count[0], s.count[1], reach
    for i in range(count):
        copy_found(pair.found[i], pair.known[k, i])


@kernel
def copy_found(found, out):
    """Copy a place that was found."""
    n, p, q = found.normal, found.on_a, found.on_b
    put(out, found.gap, (n[0], n[1], n[2]), (p[0], p[1], p[2]), (q[0], q[1], q[2]), found.feature)
    put_parts(out, found.owner, found.parts[0], found.parts[1])
