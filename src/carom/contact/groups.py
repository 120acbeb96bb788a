"""Which bodies an impulse moves together: joined, or held to each other by contacts."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def label_components(system, work):
    """Give each body the number of its joints' component."""
    for b in range(work.body.shape[0]):
        work.body[b].group = system.bodies[b].component


@kernel
def unite(work, a, b):
    """Make the groups of two bodies one."""
    g, h = work.body[a].group, work.body[b].group
    if g != h:
        for i in range(work.body.shape[0]):
            if work.body[i].group == h:
                work.body[i].group = g


@kernel
def label_groups(system, held, work):
    """Give each body the number of its group, as held contacts make them."""
    label_components(system, work)
    for i in range(held.count[0]):
        hold = held.points[i]
        if hold.other >= 0:
            unite(work, hold.body, hold.other)


@kernel
def members(work, group, member):
    """List the bodies of a group; return how many."""
    count = 0
    for b in range(work.body.shape[0]):
        if work.body[b].group == group:
            member[count] = b
            count += 1
    return count
