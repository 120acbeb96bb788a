"""The course of a multiple impact in time: its layers passed once more, with the state after each step.

The coefficients are energetic ones, e_*^2 = A_r/|A_c| of each contact, by whatever law it ended. So the layer
has the forces that the contacts had, and stiffnesses in newton give them their time. With the unit v of speeds,
1/m of W and c = max k_i W_nn,i the scaled variables of §2.1 have the units

    T = (v^(1-p)/c)^(1/(p+1)),      v T of depths,      m v/T of forces.
"""

from __future__ import annotations

import numpy as np

from carom._compiled.decorators import entry, kernel
from carom.geometry.thresholds import ROUND_OFF
from carom.impact.multiple import normal_law as law
from carom.impact.multiple.layer import drift, set_velocity, start, wedged
from carom.impact.multiple.layout import MultipleSettings, Passage
from carom.impact.multiple.stages import by_stages
from carom.impact.multiple.workspace import new_multiple_workspace
from carom.impact.thresholds import (
    APPROACH_PART,
    COURSE_SHARE,
    DRIFT_SHARE,
    INSTANT,
    LEAST_LAYER_RTOL,
    LEAST_RESTITUTION,
)
from carom.model.laws import with_slip

CONTACT_COLUMNS = 10  # of a contact: N, T1, T2, depth, velocity (3), impulse (3)
FEW_TRACE_ROWS, MOST_TRACE_ROWS = 2**11, 2**17
FULL = -1


@entry
def follow(k, work, passage, rows):
    """Pass the layers of k contacts; write time and state after each step, all in scaled variables.

    Return the number of rows, FULL if there are too many.
    """
    clock, p = work.clock[0], passage.exponent
    start(k, work)
    t, h, count, apart = 0.0, 0.0, 0, max(ROUND_OFF, DRIFT_SHARE * passage.rtol)
    while count < rows.shape[0]:
        write_state(k, work, p, t, rows[count])
        write_friction(k, work, h > INSTANT, rows[max(0, count - 1)], rows[count])
        count += 1
        fast = swiftest(k, work)
        before, speed = work.now.depth[fast], work.now.velocity[3 * fast]
        if drift(k, work, apart, p) == 1 or wedged(k, work, h, p):
            set_velocity(k, work)
            return count
        if work.now.depth[fast] != before:
            t += (before - work.now.depth[fast]) / speed
            continue
        h, changes = by_stages(k, work, passage.rtol, passage)
        t += h
        if changes:
            clock.idle = clock.idle + 1 if h <= INSTANT else 0
            law.change_modes(k, work, h + INSTANT, p, clock.idle > 2 * k)
    return FULL


@kernel
def swiftest(k, work):
    """Return the contact with the greatest normal speed."""
    best = 0
    for i in range(k):
        if abs(work.now.velocity[3 * i]) > abs(work.now.velocity[3 * best]):
            best = i
    return best


@kernel
def write_state(k, work, p, t, row):
    """Write time, normal force, depth, velocity and impulse of each contact."""
    row[0] = t
    now = work.now
    for i in range(k):
        n = 1 + CONTACT_COLUMNS * i
        row[n], row[n + 3] = law.force(work.contact[i], now.depth[i], p), now.depth[i]
        for r in range(3):
            row[n + 4 + r], row[n + 7 + r] = now.velocity[3 * i + r], now.impulse[3 * i + r]


@kernel
def write_friction(k, work, stepped, last, row):
    """Write the friction of each contact: that of the last stage, for the normal force of now.

    Where no step was taken, as between two changes of mode at one instant, it has the ratio of the row before.
    """
    force = work.stages.force[5]
    for i in range(k):
        n = 1 + CONTACT_COLUMNS * i
        N = force[3 * i] if stepped else last[n]
        for r in range(1, 3):
            T = force[3 * i + r] if stepped else last[n + r]
            row[n + r] = T / N * row[n] if N > 0.0 else 0.0


def course(W, u, friction, restitution, stiffness, settings: MultipleSettings) -> np.ndarray | None:
    """Return times and states (T, 1 + 10 k) of an impact, in SI units; None where it does not end.

    Parameters
    ----------
    W : (3k, 3k)
    u : (k, 3) velocities before
    friction : (Laws, k numbers): the laws of the contacts by their places, and the bounds of stick
    restitution : (k,) energetic coefficients
    stiffness : (k,) [N/m^p]
    settings : MultipleSettings, with the exponent p
    """
    k, p, (laws, mu) = len(u), settings.exponent, friction
    normal = np.diag(W)[::3]
    mass, stiff = normal.max(), (stiffness * normal).max()
    acting = u * np.where(mu[:, None] > 0.0, 1.0, [[1.0, 0.0, 0.0]])
    speed = max(-u[:, 0].min(), APPROACH_PART * np.abs(acting).max())
    time = (speed ** (1.0 - p) / stiff) ** (1.0 / (p + 1.0))
    by_slip = with_slip(laws.table) & (mu > 0.0)
    passage = Passage(
        max(LEAST_LAYER_RTOL, COURSE_SHARE * settings.rtol), p, settings.max_events, settings.max_steps,
        settings.max_rounds, bool(np.any(by_slip)), False, speed, laws,
    )  # fmt: skip
    size = FEW_TRACE_ROWS
    while size <= MOST_TRACE_ROWS:
        work, rows = new_multiple_workspace(k).work, np.zeros((size, 1 + CONTACT_COLUMNS * k))
        work.W[:], work.before[:] = W / mass, acting.reshape(-1) / speed
        contact = work.contact
        contact["mu"], contact["law"], contact["by_slip"] = mu, np.arange(k), by_slip
        contact["e"] = np.clip(restitution, LEAST_RESTITUTION, 1.0)
        contact["grip"] = mu * (np.diag(W).reshape(k, 3)[:, 1:].sum(axis=1) / mass)
        contact["root"] = (stiffness * mass / stiff) ** (1.0 / p)
        count = follow(k, work, passage, rows)
        if count != FULL:
            force = speed / (time * mass)
            units = [force] * 3 + [speed * time] + [speed] * 3 + [speed / mass] * 3
            found = rows[:count] * np.array([time, *units * k])
            states = found[:, 1:].reshape(count, k, CONTACT_COLUMNS)  # a view
            P = states[..., 7:].reshape(count, -1)
            # without friction, tangents were left out
            states[..., 4:7] = u + (P @ W).reshape(count, k, 3)
            return found
        size *= 8
    return None
