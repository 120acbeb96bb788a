"""Projections on the allowed impulses of a contact, which has the fields mu, kind, h1, h2."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import CONE, DISC, SLIDING


@kernel
def project(contact, x0, x1, x2):
    """Return the projection of Alart and Curnier: on x_n >= 0, then on the disc of radius mu x_n.

    A solution is a fixed point p = project(p - rho w), for every rho > 0.
    """
    kind, mu = contact.kind, contact.mu
    if kind == DISC:
        return in_disc(contact.h1, x1, x2)
    if not x0 > 0.0:
        if kind in (CONE, SLIDING):
            return 0.0, 0.0, 0.0
        return 0.0, x1, x2
    if kind == SLIDING:
        return x0, -mu * x0 * contact.h1, -mu * x0 * contact.h2
    if kind == CONE:
        size = math.sqrt(x1 * x1 + x2 * x2)
        if size > mu * x0:
            r = mu * x0 / size
            return x0, r * x1, r * x2
    return x0, x1, x2


@kernel
def slope(contact, x0, x1, x2):
    """Return the derivative of `project`: d00, d10, d11, d12, d20, d21, d22 (the others are zero)."""
    kind, mu = contact.kind, contact.mu
    if kind == DISC:
        size, radius = math.sqrt(x1 * x1 + x2 * x2), contact.h1
        if size <= radius:
            return 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
        e1, e2, r = x1 / size, x2 / size, radius / size
        return 0.0, 0.0, r * e2 * e2, -r * e1 * e2, 0.0, -r * e1 * e2, r * e1 * e1
    if not x0 > 0.0:
        if kind in (CONE, SLIDING):
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        return 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    if kind == SLIDING:
        return 1.0, -mu * contact.h1, 0.0, 0.0, -mu * contact.h2, 0.0, 0.0
    if kind == CONE:
        size = math.sqrt(x1 * x1 + x2 * x2)
        if size > mu * x0:
            e1, e2 = x1 / size, x2 / size
            r = mu * x0 / size
            return 1.0, mu * e1, r * e2 * e2, -r * e1 * e2, mu * e2, -r * e1 * e2, r * e1 * e1
    return 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0


@kernel
def nearest(cone, x0, x1, x2):
    """Return the nearest point of the set for (kind, mu, h1, h2): cone, ray (1, -mu h), half-space, or disc."""
    kind, mu, h1, h2 = cone
    if kind == DISC:
        return in_disc(h1, x1, x2)
    if kind == CONE:
        size = math.sqrt(x1 * x1 + x2 * x2)
        if mu * size <= -x0:  # tested first: if x_n < 0, mu = 0 and size = 0 both tests hold
            return 0.0, 0.0, 0.0
        if size <= mu * x0:
            return x0, x1, x2
        n = (x0 + mu * size) / (1.0 + mu * mu)
        r = mu * n / size
        return n, r * x1, r * x2
    if kind == SLIDING:
        n = max(0.0, (x0 - mu * (h1 * x1 + h2 * x2)) / (1.0 + mu * mu * (h1 * h1 + h2 * h2)))
        return n, -mu * n * h1, -mu * n * h2
    return max(0.0, x0), x1, x2


@kernel
def in_disc(radius, x1, x2):
    """Return the nearest point of the disc |p_t| <= radius, in which p_n = radius."""
    size = math.sqrt(x1 * x1 + x2 * x2)
    r = radius / size if size > radius else 1.0
    return radius, r * x1, r * x2


@kernel
def shift(cone, w1, w2):
    """Return the term added to w_n so that w lies in the dual of the set of allowed impulses (de Saxce)."""
    kind, mu, h1, h2 = cone
    if kind == CONE:
        return mu * math.sqrt(w1 * w1 + w2 * w2)
    if kind == SLIDING:
        return mu * (h1 * w1 + h2 * w2)
    return 0.0
