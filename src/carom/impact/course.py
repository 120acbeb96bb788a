"""The course of an impact over its normal impulse, from which the force in time follows.

The velocity and the friction impulse are functions of the normal impulse p alone, whatever the stiffness of the
contact (mathematics page, §1.9): on each piece of the path u is linear in p, or a Taylor series of slip in tau
with dp = |u_t| dtau. The pieces are written down as they are followed.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry
from carom.geometry.thresholds import ROUND_OFF
from carom.impact import layout as o
from carom.impact.resolve import (
    AT_GOAL,
    AT_STOP,
    BENT,
    CURVE,
    STICK,
    STRAIGHT,
    WITHOUT_END,
    Contact,
    Line,
    Phase,
    along_curve,
    along_line,
    from_rest,
    scaled,
    straightened,
    without_slip,
)
from carom.impact.slip_step import expand
from carom.law import impact_laws

#: columns of a piece: its state at the start (u_1, u_2, u_n, p, P_1, P_2, loss, work), its kind, impulses of
#: friction over the normal one, the series of x, y (17 each), r and q (16 each) in tau, and p at its end
KIND, SLOPE = 8, slice(9, 11)
X, Y, R, Q = slice(11, 28), slice(28, 45), slice(45, 61), slice(61, 77)
END, PIECE_COLUMNS = 77, 78
MOST_PIECES_OF_PATH = 2000
(MEASURED_BY_IMPULSE,) = impact_laws.BY_IMPULSE


@entry
def trace(W, u, mu, end, rows, units):
    """Write the pieces of the path of slip and stick up to the normal impulse `end` [N s].

    `units` receives those of velocity and of W, in which the pieces are. Return their number, or minus the code
    of a failure.
    """
    code, m, before, by, size = scaled(W, u, mu)
    if code != o.OK:
        return -code
    units[0], units[1] = by
    contact, goal = Contact(m, mu, size, 0.0), end * by[1] / by[0]
    phase = Phase(MEASURED_BY_IMPULSE, goal, False, 0.0)
    s, line = (before[1], before[2], before[0], 0.0, 0.0, 0.0, 0.0, 0.0), CURVE
    stopped = not math.sqrt(before[1] ** 2 + before[2] ** 2) > ROUND_OFF * size
    if mu == 0.0:
        line, stopped = Line(STRAIGHT, 0.0, 0.0, 0.0), False
    for k in range(rows.shape[0]):
        if stopped:
            s = without_slip(m, s, size)
            line = from_rest(contact)
        elif line.mode == BENT:
            line = straightened(contact, s)
        row = rows[k]
        for i in range(8):
            row[i] = s[i]
        row[KIND], row[9], row[10] = line.mode, line.t1, line.t2
        if line.mode == BENT:
            x, y, r, q = expand(m, mu, s)
            for i in range(17):
                row[11 + i], row[28 + i] = x[i], y[i]
            for i in range(16):
                row[45 + i], row[61 + i] = r[i], q[i]
            s, ended, _ = along_curve(contact, phase, s)
        else:
            s, ended, _ = along_line(contact, phase, line, s)
        row[END] = s[3]
        if ended == WITHOUT_END:
            return -o.NO_END
        if ended == AT_GOAL or line.mode == STICK or not s[3] < goal:
            return k + 1
        stopped = ended == AT_STOP
    return -o.TOO_MANY_STEPS
