"""Impact without collision: a contact that slips and jams (Painleve; mathematics page, §3.6)."""

from __future__ import annotations

import numpy as np

from carom.impact.layout import OK
from carom.impact.multiple.resolve import resolve_multiple

_SEED = 1e-7  # speed of approach given to a jammed contact, as a part of its slip


def jams(W, u, mu, i) -> bool:
    """Return whether contact `i` slips without opening, and its own force presses it together.

    k = W_nn - mu W_nt.u_t/|u_t| <= 0: no finite force holds it, whatever the loads.
    """
    n = 3 * i
    slip = u[n + 1 : n + 3]
    r = np.linalg.norm(slip)
    if not (r > 0.0 and u[n] <= 0.0):
        return False
    return W[n, n] - mu * (W[n, n + 1 : n + 3] @ slip) / r <= 0.0


def impact_without_collision(k, contacts, laws, settings, workspace, out):
    """Resolve the impact of persistent contacts that jam; return (code, number of contacts that jam).

    Arguments as of `resolve_multiple`. A jammed contact begins with u_n = -1e-7 |u_t|: its depth grows like
    an exponential until slip stops, and the result does not depend on that seed (to 1e-7).
    """
    W, u, mu = contacts.W, contacts.u, contacts.contact.friction
    v, count = u.copy(), 0
    for i in range(k):
        n = 3 * i
        if u[n] > -_SEED * np.sum(np.abs(u[n + 1 : n + 3])) and jams(W, u, mu[i], i):
            v[n] = -_SEED * np.linalg.norm(u[n + 1 : n + 3])
            count += 1
    code = resolve_multiple(k, contacts._replace(u=v), laws, settings, workspace, out)
    if code == OK:
        out.velocity[: len(u)] += u - v  # u+ = u + W P holds for what was given
    return code, count
