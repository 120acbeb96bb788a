"""Derivatives of the impulse of one frictional impact with respect to W, u, mu and e.

The impact solver has an error of 1e-14, so its differences of order 6 have an error of 1e-11 (mathematics page,
§5.2). Steps are halved until all points of the stencil have the same phases of slip and stick, and until the
error no longer decreases.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.impact import layout as o
from carom.law.impact_laws import BY_SPEED

UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
INPUTS = 11  # six numbers of W, three of u, mu, e
BY_NORMAL, BY_RESTITUTION = 6, 10  # columns of the normal velocity and of e
CENTRAL = ((-3, -1 / 60), (-2, 3 / 20), (-1, -3 / 4), (1, 3 / 4), (2, -3 / 20), (3, 1 / 60))
FORWARD = ((0, -49 / 20), (1, 6), (2, -15 / 2), (3, 20 / 3), (4, -15 / 4), (5, 6 / 5), (6, -1 / 6))
FIRST = 2.0**-6  # first step, relative to the unit of an input
HALVINGS = 14
ROUND_OFF = 1e-13
ENOUGH = 1e-11
AT_REST = 1e-9  # slip below this part of the speed of impact counts as zero


class Blow(NamedTuple):
    """The result of an impact, and its derivatives."""

    impulse: np.ndarray  # (3,)
    slip_end: float  # normal impulse at which slip stops, -1 if it does not
    slip_end_rate: float  # normal velocity at which slip stops
    phases: int
    d: np.ndarray  # (4, 11) derivatives of the impulse and of slip_end
    error: float  # of the impulse in d, in units of the inputs, relative to its size
    kink: str  # reason why there is no derivative, or ""


def blow(W: np.ndarray, u: np.ndarray, mu: float, e: float, law: int) -> Blow | None:
    """Return the derivatives of an impact; None if it is not resolved."""
    base = _resolve(W, u, mu, e, law)
    if base is None:
        return None
    z = np.array([*(W[i, k] for i, k in UPPER), *u, mu, e])
    impulse, end, rate, phases = base[:3], float(base[3]), float(base[4]), int(base[5])
    slips = np.hypot(u[1], u[2]) > AT_REST * np.linalg.norm(u)
    kink = ""
    if not slips and phases & o.PHASE_SLIP and mu > 0.0:
        kink = "slip starts from rest, so its direction depends on the change"
    unit = _units(W, u, slips)
    d, error = np.zeros((4, INPUTS)), 0.0
    size = float(np.linalg.norm(impulse))
    for k in range(INPUTS):
        column, miss = _column(z, k, unit[k], law, base, size)
        if column is None:
            kink = kink or "its course of slip, stick and reversal is about to change"
            continue
        d[:, k], error = column, max(error, miss)
    return Blow(impulse, end, rate, phases, d, error, kink)


def _units(W, u, slips) -> np.ndarray:
    """Return the unit of each input: a change of this size changes the impact considerably."""
    least = float(np.linalg.eigvalsh(W)[0])
    weight = max(least, 1e-6 * W[0, 0])
    tangential = float(np.hypot(u[1], u[2])) if slips else -u[0]
    return np.array([*[weight] * 6, -u[0], tangential, tangential, 1.0, 1.0])


def _column(z, k, unit, law, base, size):
    """Return the derivative by input k, or None, and an estimate of its error in units."""
    bound = k >= 9  # mu and e must not be below 0
    best, least, before, step = None, np.inf, None, FIRST * unit
    for _ in range(HALVINGS):
        one_sided = bound and z[k] < 3.0 * step
        values = _stencil(z, k, step, law, base, FORWARD if one_sided else CENTRAL)
        if values is not None:
            if before is not None:
                miss = float(np.max(np.abs(values - before)[:3])) * unit / size
                miss += ROUND_OFF * unit / step
                if miss < least:
                    best, least = values, miss
                if least < ENOUGH or miss > 30.0 * least:
                    break
            before = values
        step *= 0.5
    return best, least


def _stencil(z, k, step, law, base, weights):
    """Return the difference quotient (4,), or None if not all points have the same phases."""
    total = np.zeros(4)
    for at, weight in weights:
        here = z.copy()
        here[k] += at * step
        W = np.empty((3, 3))
        for value, (i, j) in zip(here, UPPER):
            W[i, j] = W[j, i] = value
        found = base if at == 0 else _resolve(W, here[6:9], here[9], here[10], law)
        if found is None:
            return None
        if at != 0 and not _same_course(found, base, z, law):
            return None
        total += weight / step * found[:4]
    return total


def _same_course(found, base, z, law) -> bool:
    """Return whether two impacts have the same phases, in compression and in restitution."""
    if z[9] == 0.0:  # without friction the phases have no effect
        return True
    if not int(base[5]) & o.PHASE_SLIP:
        # it sticks from the start; changed impacts slip slightly first
        return bool(int(found[5]) & ~o.PHASE_SLIP == int(base[5]))
    same = found[5] == base[5] and (found[3] >= 0.0) == (base[3] >= 0.0)
    if z[10] == 0.0 or law in BY_SPEED:  # the phase of the end of slip has no effect
        return bool(same)
    return bool(same and (found[4] < 0.0) == (base[4] < 0.0))


def _resolve(W, u, mu, e, law):
    """Return impulse (3), end of slip (impulse, velocity) and phases; None if it is not resolved."""
    from carom.impact.resolve import resolve

    out = np.zeros(o.SIZE)
    if resolve(W, u, mu, e, law, out) != o.OK:
        return None
    return np.append(
        out[o.IMPULSE : o.IMPULSE + 3], [out[o.SLIP_END_P], out[o.SLIP_END_UN], out[o.PHASES]]
    )
