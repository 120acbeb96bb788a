"""Surfaces that move in themselves: their velocity field at a time.

A point p of the surface moves with w_0 + rate axis x (p - x_0), while the solid stays where it is. Contacts,
and points from them, have w_0 - rate axis x x_0 and rate axis, with the rates of both.
"""

from __future__ import annotations

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.rotation import cross


@kernel
def set_surfaces(system, t):
    """Write the velocity fields of functions of time at time t to the contacts."""
    if system.moving.rows.shape[0] > 0:
        _set_surfaces(system, t)


@unit
def _set_surfaces(system, t):
    moving = system.moving
    rows, w = moving.rows, moving.write
    for i in range(rows.shape[0]):
        one = rows[i]
        for k in range(6):
            w[k] = one.velocity[k] if k < 3 else 0.0
        w[6], w[7] = one.rate, 0.0
        if one.velocity_address != 0:
            call_function(one.velocity_address, t, moving.read, w[0:6])
        if one.spin_address != 0:
            call_function(one.spin_address, t, moving.read, w[6:8])
        a, p = one.axis, one.point
        c = cross(a[0], a[1], a[2], p[0], p[1], p[2])
        for contact in range(system.contacts.shape[0]):
            if system.contacts[contact].moves == 2 + i:
                field = system.contacts[contact].field
                for r in range(2):
                    for k in range(3):
                        field[2 * r, k] = w[3 * r + k] - w[6 + r] * c[k]
                        field[2 * r + 1, k] = w[6 + r] * a[k]
