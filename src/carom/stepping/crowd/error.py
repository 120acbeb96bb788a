"""The error of time-stepping steps, from the change of the forces between one piece and the next.

A piece of length h moves a body as if its mean acceleration a acted all the time. Within the piece the force
may be anywhere: an impact, which is at its end, misplaces the body by up to h |dv|, and a force that grows
steadily by a part of that. The difference d of the mean accelerations of two pieces has both, so

    e = h^2/2 (|d| + L |d_w|)

is counted for each, with the size L of the body. It is of order 1 in h where bodies strike, of order 2
elsewhere, and 0 at rest and in even motion. Errors of pieces are added, though they may cancel.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.thresholds import ROUND_OFF


@kernel
def note_error(system, until, h, now, end, work):
    """Add the error of a piece of length h to those of its bodies: up to a time, from `now` to `end`."""
    g = system.gravity
    for b in range(now.shape[0]):
        memory, x, y = work.body[b], now[b], end[b]
        mean, last = memory["mean"], memory.piece_end  # `record.mean` is a method of NumPy's
        follows = last > 0.0 and abs(until - h - last) <= ROUND_OFF * until
        linear, turning, still, free = 0.0, 0.0, 0.0, 0.0
        for k in range(3):
            a, c = (y.v[k] - x.v[k]) / h, (y.w[k] - x.w[k]) / h
            linear += (a - mean[k]) ** 2
            turning += (c - mean[3 + k]) ** 2
            still, free = still + a * a, free + (a - g[k]) ** 2
            mean[k], mean[3 + k] = a, c
        if not follows:  # at rest, or in flight, up to now: the rotation of a flight is not known
            linear, turning = min(still, free), 0.0
        memory.piece_end = until
        memory.astray += 0.5 * h * h * (linear**0.5 + system.bodies[b].extent * turning**0.5)


@kernel
def watch_error(system, controls, work, watch):
    """Store the greatest error of the bodies so far relative to the tolerance, and to their size."""
    for b in range(work.body.shape[0]):
        size, astray = system.bodies[b].extent, work.body[b].astray
        part = astray / (controls.atol + controls.rtol * size)
        if part > watch.astray:
            watch.astray, watch.astray_size = part, astray / size
