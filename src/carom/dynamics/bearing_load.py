"""What a joint presses together, by its reaction: the load that bounds its friction (theory, X.4).

The load is the sum of the lengths of up to three vectors (force F and moment M on the child at the middle of
its bearing, axis a, distance L of two bearings, radius r):

    one bearing        F
    two bearings       F_perp/2 + (M x a)/L,    F_perp/2 - (M x a)/L,   and F_a a on the shoulder of a shaft,
                       or M_a/r a of a slide that is kept from turning at the radius r
    a thread           (F_a - p sin lead)/cos lead a:  its normal force, with the friction p along the helix
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.kinematics.joints import arm, axis

NUMBERS = 9  # of the vectors of a load


@kernel
def reaction_at_bearing(system, one, state, work):
    """Return force and moment of a joint on the child of the scene, about its anchor, in its bearing."""
    c, joint = system.relations.coordinates[one.coordinate], system.joints[one.joint]
    wrench, sign = work.joint[one.joint].reaction, -1.0 if one.flipped == 1 else 1.0
    x, y, z = sign * wrench[0], sign * wrench[1], sign * wrench[2]
    here, there = place_of(state, joint), place_of(state, c)
    a, b, d = cross(here[0] - there[0], here[1] - there[1], here[2] - there[2], x, y, z)
    return (x, y, z), (sign * wrench[3] + a, sign * wrench[4] + b, sign * wrench[5] + d)


@kernel
def write_vectors(system, one, force, moment, state, out):
    """Write the vectors of the load of a friction, (9,), by the reaction of its joint at its bearing."""
    c = system.relations.coordinates[one.coordinate]
    a = axis(state, c.parent, c.parent_frame, 0)
    along = a[0] * force[0] + a[1] * force[1] + a[2] * force[2]
    turning = a[0] * moment[0] + a[1] * moment[1] + a[2] * moment[2]
    bent = cross(moment[0], moment[1], moment[2], a[0], a[1], a[2])
    for k in range(3):
        if one.thread != 0.0:
            out[k], out[3 + k], out[6 + k] = along * a[k] * one.steep, 0.0, 0.0
        elif one.length == 0.0:
            out[k], out[3 + k], out[6 + k] = force[k], 0.0, one.torsion * turning * a[k]
        else:
            half, pair = 0.5 * (force[k] - along * a[k]), bent[k] / one.length
            out[k], out[3 + k] = half + pair, half - pair
            out[6 + k] = (one.torsion * turning + one.shoulder * along) * a[k]


@kernel
def place_of(state, joint):
    """Return the anchor of the child of a joint, or coordinate, in the world."""
    r = arm(state, joint.child, joint.child_anchor)
    if joint.child < 0:
        return r
    x = state[joint.child].x
    return x[0] + r[0], x[1] + r[1], x[2] + r[2]


@kernel
def take_thread_out(system, one, p, state, out):
    """Take the part along the axis of the friction p of a thread out of the load of its flanks."""
    if one.thread != 0.0:
        c = system.relations.coordinates[one.coordinate]
        a = axis(state, c.parent, c.parent_frame, 0)
        for r in range(3):
            out[r] -= p * one.thread * one.steep * a[r]


@kernel
def load_of(vectors):
    """Return the sum of the lengths of the vectors of a load."""
    total = 0.0
    for v in range(0, NUMBERS, 3):
        x, y, z = vectors[v], vectors[v + 1], vectors[v + 2]
        total += math.sqrt(x * x + y * y + z * z)
    return total
