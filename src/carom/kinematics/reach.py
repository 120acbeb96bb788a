"""How far the points of a body move by a rotation."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.rotation import norm


@kernel
def way_of_turn(body, w):
    """Return a bound of |w x r| for all points r of a body; w is along its principal axes.

    With the rate of a rotation it is a speed, and with its axis times sin(angle/2) half the way of a point.
    """
    arms = abs(w[0]) * body.arm[0] + abs(w[1]) * body.arm[1] + abs(w[2]) * body.arm[2]
    return min(arms, norm(w) * body.ball)
