"""Impact without collision: a contact that slips and jams (Painleve; mathematics page, §3.6)."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, entry, kernel
from carom.impact.layout import OK
from carom.impact.multiple.layout import SEEDED, CornerContacts
from carom.impact.multiple.resolve import resolve_multiple

_SEED = 1e-7  # speed of approach given to a jammed contact, as a part of its slip


@kernel
def jams(W, u, mu, i):
    """Return whether contact `i` slips without opening, and its own force presses it together.

    k = W_nn - mu W_nt.u_t/|u_t| <= 0: no finite force holds it, whatever the loads.
    """
    n = 3 * i
    x, y = u[n + 1], u[n + 2]
    r = math.sqrt(x * x + y * y)
    if not (r > 0.0 and u[n] <= 0.0):
        return False
    return W[n, n] - mu * (W[n, n + 1] * x + W[n, n + 2] * y) / r <= 0.0


@entry
def impact_without_collision(contacts, settings, workspace, out):
    """Resolve the impact of persistent contacts that jam; return (code, number of contacts that jam).

    Arguments as of `resolve_multiple`. A jammed contact begins with u_n = -1e-7 |u_t|: its depth grows like
    an exponential until slip stops, and the result does not depend on that seed (to 1e-7).
    """
    k, W, u, mu = contacts.k, contacts.W, contacts.u, contacts.friction
    v, count = workspace.work.vector[SEEDED], 0
    for i in range(3 * k):
        v[i] = u[i]
    for i in range(k):
        n = 3 * i
        if u[n] > -_SEED * (abs(u[n + 1]) + abs(u[n + 2])) and jams(W, u, mu[i], i):
            v[n] = -_SEED * math.sqrt(u[n + 1] * u[n + 1] + u[n + 2] * u[n + 2])
            count += 1
    seeded = by_reference(
        CornerContacts(
            k, 0, W, v, mu, contacts.restitution, contacts.law, contacts.stiffness, contacts.pair
        )
    )  # fmt: skip
    code = resolve_multiple(seeded, settings, workspace, out)
    if code == OK:
        for i in range(3 * k):  # u+ = u + W P holds for what was given
            out.velocity[i] += u[i] - v[i]
    return code, count
