"""Return of a body in contact at one point to the surface at the end of a step, similar to joints.

The rows of a persistent contact hold at the level of accelerations and drift at the order of the method; the
shortest displacement and the smallest change of velocity in the kinetic metric remove this drift:

    xi = -P G_n^T gap/W_nn,        v <- v - P G^T W^-1 u   (normal row only while it slips).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.gap import round_off, slow
from carom.contact.place import place_active
from carom.dynamics.acceleration import OPEN, STICK
from carom.dynamics.contact_impulse import (
    add_velocity,
    alone,
    effective_inverse_mass,
    spread,
)
from carom.dynamics.friction import stick_force
from carom.dynamics.project import shift
from carom.kinematics.contact_point import (
    contact_motion,
    contact_velocity,
)


@kernel
def shift_reached(system, point, state, work):
    """Move the bodies that an impulse at the point reaches by the motion of the last solve."""
    if alone(system, point):
        shift(work.body[point.a].motion, state[point.a])
        if point.b >= 0:
            shift(work.body[point.b].motion, state[point.b])
    else:
        for b in range(state.shape[0]):
            shift(work.body[b].motion, state[b])


@kernel
def return_active(system, active, state, work):
    """Bring active points back to the surface, for bodies with a single one."""
    point = work.point[0]
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode == OPEN or active_point.several == 1 or active_point.rest == 1:
            continue
        contact = system.contacts[active_point.contact]
        for _ in range(4):
            place_active(system, active_point, state, point, work)
            if not abs(point.gap) > round_off(contact, state):
                break
            spread(system, point, state, 1.0, 0.0, 0.0, work)
            f = -point.gap / contact_motion(point, work)[0]
            spread(system, point, state, f, 0.0, 0.0, work)
            shift_reached(system, point, state, work)


@kernel
def stay_active(system, active, state, work):
    """Remove the velocities that active points forbid, for bodies with a single one."""
    point = work.point[0]
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode == OPEN or active_point.several == 1 or active_point.rest == 1:
            continue
        contact = system.contacts[active_point.contact]
        place_active(system, active_point, state, point, work)
        u, still = contact_velocity(point, state), slow(contact, state)
        sticks = active_point.mode == STICK
        if abs(u[0]) <= still and not (sticks and max(abs(u[1]), abs(u[2])) > still):
            continue
        W = work.hit[0].W
        effective_inverse_mass(system, point, state, work, W)
        n, t1, t2 = -u[0] / W[0, 0], 0.0, 0.0
        if sticks:
            n, t1, t2 = stick_force(W, u[0], u[1], u[2])
        spread(system, point, state, n, t1, t2, work)
        add_velocity(system, point, work, state)
