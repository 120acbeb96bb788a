"""Many impacts at once: the arguments of `resolve_impact` as arrays, spatial or plane."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from carom import checks
from carom._compiled.decorators import by_reference, entry
from carom.friction.thresholds import FILE_DIGITS
from carom.impact import layout as o
from carom.impact.api import Impact, phase_names
from carom.impact.resolve import resolve
from carom.impact.resolve_by_slip import SlipFriction, resolve_by_slip
from carom.impact.tangential import return_slip
from carom.law.impact_laws import NUMBERS
from carom.model.laws import Laws, LawTable
from carom.scene.friction import bound_of, isotropic
from carom.scene.restitution import Restitution
from carom.scene.speed_law import SpeedLaw

FEW_IMPACTS = 2000  # take ten times as long as a thread to begin


@entry
def resolve_each(W, u, numbers, kinds, laws, out):
    """Solve each impact, with mu, e and e_t in `numbers`.

    `kinds` has the law of impact, and the number of the law of friction among `laws`, below 0 for none. Return
    the number of the first that failed and its code, or (-1, OK).
    """
    for i in range(u.shape[0]):
        mu, e, e_t = numbers[i]
        law, by_slip = kinds[i]
        if by_slip < 0:
            code = resolve(W[i], u[i], mu, e, law, out[i])
        else:
            slip = by_reference(SlipFriction(mu, by_slip, laws))
            code = resolve_by_slip(W[i], u[i], slip, e, law, out[i])
        if code != o.OK:
            return i, code
        if e_t != 0.0:
            return_slip(W[i], u[i], mu, e_t, out[i])
    return -1, o.OK


def resolve_many(inverse_mass, velocity, friction, restitution, law, tangential) -> Impact:
    """Solve impacts whose arguments are arrays that go together; see `resolve_impact`."""
    W = _checked_inverse_masses(inverse_mass)
    k = W.shape[-1]
    u = checks.vectors("velocity", velocity, k)
    name = "velocity[..., 0] (normal velocity, approach is negative)"
    _all(name, u[..., 0], "below 0", u[..., 0] < 0)
    mu, by_slip, laws = _frictions(friction)
    e = _restitutions(restitution, -u[..., 0])
    e_t = _numbers("tangential_restitution", tangential, "from -1 to 1", lambda a: abs(a) <= 1)
    names = np.asarray(law, dtype=object)
    number = np.array(
        [NUMBERS[checks.choice("law", name, NUMBERS)] for name in names.flat], np.int64
    )
    parts = W.shape[:-2], u.shape[:-1], mu.shape, e.shape, names.shape, e_t.shape
    try:
        shape = np.broadcast_shapes(*parts)
    except ValueError:
        raise ValueError(
            "inverse_mass, velocity, friction, restitution, law and tangential_restitution must have first "
            f"axes that go together (broadcast), got {', '.join(map(str, parts))}"
        ) from None
    n = int(np.prod(shape))
    full, speed = np.zeros((n, 3, 3)), np.zeros((n, 3))  # of a plane, 0 along its second tangent
    full[:, :k, :k] = np.broadcast_to(W, (*shape, k, k)).reshape(n, k, k)
    speed[:, :k] = np.broadcast_to(u, (*shape, k)).reshape(n, k)
    numbers = np.stack([np.broadcast_to(a, shape).flatten() for a in (mu, e, e_t)], axis=1)
    kinds = (number.reshape(names.shape), by_slip)
    kinds = np.stack([np.broadcast_to(a, shape).flatten() for a in kinds], axis=1)
    out = np.zeros((n, o.SIZE))

    def solve(first: int) -> None:
        part = slice(first, first + size)
        given = full[part], speed[part], numbers[part], kinds[part]
        failed, code = resolve_each(*given, laws, out[part])
        if failed >= 0:
            at = tuple(map(int, np.unravel_index(first + failed, shape)))
            raise ValueError(f"the impact at index {at} could not be solved: {o.MESSAGES[code]}")

    size = max(FEW_IMPACTS, -(-n // (os.cpu_count() or 1)))
    if n <= size:
        solve(0)
    else:
        with ThreadPoolExecutor() as pool:
            list(pool.map(solve, range(0, n, size)))
    return _impact(out, shape, k)


def _impact(out: np.ndarray, shape: tuple[int, ...], k: int) -> Impact:
    """Return the rows of `out` as an `Impact` of arrays, with vectors of k components."""

    def vector(first: int) -> np.ndarray:
        return out[:, first : first + k].reshape(*shape, k)

    def number(column: int) -> Any:
        return _plain(out[:, column].reshape(shape))

    masks = out[:, o.PHASES].astype(np.int64)
    words = {mask: phase_names(mask) for mask in np.unique(masks).tolist()}
    phases = np.empty(len(masks), dtype=object)
    phases[:] = [words[mask] for mask in masks.tolist()]
    return Impact(
        velocity_after=vector(o.VELOCITY),
        impulse=vector(o.IMPULSE),
        compression_impulse=vector(o.COMPRESSION),
        compression_work=number(o.WORK_C),
        restitution_work=number(o.WORK_R),
        friction_loss=number(o.FRICTION_LOSS),
        energy_change=number(o.ENERGY_CHANGE),
        phases=_plain(phases.reshape(shape)),
        wedged=_plain((masks & o.WEDGED != 0).reshape(shape)),
    )


def _plain(values: np.ndarray) -> Any:
    """Return values of several impacts as they are, that of one as a number or a tuple."""
    return values if values.ndim else values.item()


def _checked_inverse_masses(given) -> np.ndarray:
    """Return W (..., k, k), k = 2 or 3, as symmetric arrays; refuse others unless W >= 0 and W_nn > 0."""
    W = checks.real_array("inverse_mass", given, "(..., 3, 3) or (..., 2, 2)")
    if W.shape[-2:] not in ((3, 3), (2, 2)):
        raise ValueError(
            f"inverse_mass must have shape (..., 3, 3) or (..., 2, 2) [1/kg], got shape {W.shape}"
        )
    _all("inverse_mass", W, "finite", np.isfinite(W).all(axis=(-2, -1)))
    off = np.abs(W - W.swapaxes(-2, -1)).max(axis=(-2, -1))
    _all("inverse_mass", W, "symmetric", off <= FILE_DIGITS * np.abs(W).max(axis=(-2, -1)))
    W = 0.5 * (W + W.swapaxes(-2, -1))
    _all("inverse_mass[..., 0, 0] (normal)", W[..., 0, 0], "above 0", W[..., 0, 0] > 0)
    values = np.linalg.eigvalsh(W)
    _all(
        "inverse_mass", W, "positive semidefinite", values[..., 0] >= -FILE_DIGITS * values[..., -1]
    )
    return W


def _frictions(given) -> tuple[np.ndarray, np.ndarray, Laws]:
    """Return the coefficients that bound stick, the numbers of laws of the slip (-1 for none), and these."""
    table, known = LawTable(), {}
    if not _any_law(given):
        mu = _numbers("friction", given, "at least 0", lambda a: a >= 0)
        return mu, np.full(mu.shape, -1), table.arrays()
    stated = np.array(given, dtype=object)
    mu, number = np.zeros(stated.shape), np.full(stated.shape, -1)
    for at, one in np.ndenumerate(stated):
        one = isotropic("friction", one)
        if isinstance(one, SpeedLaw) and one not in known:
            known[one] = table.add(one)
        mu[at], number[at] = bound_of(one), known.get(one, -1)
    return mu, number, table.arrays()


def _restitutions(given, approach: np.ndarray) -> np.ndarray:
    """Return e: numbers, or the values of laws at speeds of approach."""
    if not _any_law(given):
        return _numbers("restitution", given, "from 0 to 1", lambda a: (a >= 0) & (a <= 1))
    stated = np.array(given, dtype=object)
    try:
        shape = np.broadcast_shapes(stated.shape, approach.shape)
    except ValueError:
        return np.zeros(stated.shape)  # `resolve_many` refuses it, with all shapes
    e, stated = np.zeros(shape), np.broadcast_to(stated, shape)
    for at, speed in np.ndenumerate(np.broadcast_to(approach, shape)):
        one = stated[at]
        if isinstance(one, Restitution):
            e[at] = one(speed)
        else:
            e[at] = checks.number("restitution", one, least=0.0, most=1.0)
    return e


def _any_law(given) -> bool:
    if isinstance(given, np.ndarray) and given.dtype != object:
        return False
    return any(isinstance(one, SpeedLaw) for one in np.array(given, dtype=object).flat)


def _numbers(name: str, given, allowed: str, inside) -> np.ndarray:
    values = checks.real_array(name, given, "any shape")
    _all(name, values, f"finite and {allowed}", np.isfinite(values) & inside(values))
    return values


def _all(name: str, values: np.ndarray, allowed: str, good) -> None:
    """Refuse values of which one is not good, with its index."""
    if not np.all(good):
        at = tuple(map(int, np.argwhere(~good)[0]))
        where = f" at index {at}" if at else ""
        raise ValueError(
            f"{name} must be {allowed}, got {checks.shown(values[at].tolist())}{where}"
        )
