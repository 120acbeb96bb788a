"""Distance of two convex cores by the method of Gilbert, Johnson and Keerthi (IEEE J. Robotics 4, 1988).

The nearest point v of A - B to the origin is found in simplices of its corners. For polytopes it is
found in a finite number of steps, to round-off; for smooth cores the error of the distance is of second
order in that of the direction.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.simplex import move_corner, nearest_point, reduce_simplex, size_of
from carom.collision.support import propose
from carom.geometry.thresholds import SUM_ERROR

GJK_STEPS = 100


@kernel
def distance(pair, accuracy, x, y, z):
    """Return the distance |v| of the cores and the vector v from B to A; zeros if the cores overlap.

    The search starts in the direction (x, y, z), any vector except zero, and ends when the relative gain of a
    step is at most `accuracy`. The simplex and its weights stay in the workspace: they give the two points.
    """
    s = pair.state
    s.searches += 1
    propose(pair, x, y, z)
    move_corner(s, 4, 0)
    s.points, s.weight[0] = 1, 1.0
    vx, vy, vz = s.w[0, 0], s.w[0, 1], s.w[0, 2]
    v2 = vx * vx + vy * vy + vz * vz
    for _ in range(GJK_STEPS):
        scale = size_of(s)
        if not v2 > (SUM_ERROR * scale) ** 2:
            return 0.0, 0.0, 0.0, 0.0
        propose(pair, vx, vy, vz)
        w = s.w[4]
        gain = v2 - (vx * w[0] + vy * w[1] + vz * w[2])
        if not gain > accuracy * v2:
            break
        # A corner that is already in the simplex can change the result only by rounding.
        again = False
        for k in range(s.points):
            if s.w[k, 0] == w[0] and s.w[k, 1] == w[1] and s.w[k, 2] == w[2]:
                again = True
        if again:
            break
        move_corner(s, 4, s.points)
        s.points += 1
        new = reduce_simplex(s)
        if new == 0.0:
            return 0.0, 0.0, 0.0, 0.0
        vx, vy, vz = nearest_point(s, s.w)
        if not new < v2:
            break
        v2 = new
    return math.sqrt(vx * vx + vy * vy + vz * vz), vx, vy, vz
