"""Groups of bodies that an impulse moves together, because of joints or closed contacts."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def unite(work, a, b):
    """Join the groups of two bodies."""
    g, h = work.body[a].label, work.body[b].label
    if g != h:
        for i in range(work.body.shape[0]):
            if work.body[i].label == h:
                work.body[i].label = g


@kernel
def label_groups(system, active, work):
    """Give each body the number of its group, where joints and persistent contacts connect bodies."""
    for b in range(work.body.shape[0]):
        work.body[b].label = system.bodies[b].component
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.other >= 0:
            unite(work, active_point.body, active_point.other)


@kernel
def members(work, label, member):
    """List the bodies of a group; return their number."""
    count = 0
    for b in range(work.body.shape[0]):
        if work.body[b].label == label:
            member[count] = b
            count += 1
    return count
