"""What is said of a run whose balance of energy is off, or in which a body gets into a surface."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.ledger import Ledger
from carom.status import Status
from carom.watch import ALL, BOUNCES, FRICTION, IMPACTS, RESIDUAL, ROUND_OFF, new_watch

INACCURATE = 100.0  # times the tolerance: what is no success any more
DEEP, TOO_DEEP = 1e-8, 1e-4  # parts of its size that a body is in a surface: said, and no success
VERTICES = 0  # a contact of the vertices of a body

_WHAT = {
    RESIDUAL: (
        "Energy that no entry of the ledger explains:",
        "Take a smaller step, or allow for it",
    ),
    IMPACTS: ("Impacts gave energy, which they never should:", 'Take impact_law="stronge"'),
    FRICTION: (
        "Friction gave energy, which it never should:",
        "Take a smaller step, or allow for it",
    ),
    BOUNCES: (
        "Bounces that were dropped gave energy, which they never should:",
        "Take a smaller step",
    ),
    ALL: (
        "Energy without a name, of several kinds together:",
        "Take a smaller step, or allow for it",
    ),
}


def beyond(i: int, watch: np.record, times: float = 1.0) -> bool:
    """Return whether energy of a kind without a name is beyond the tolerance, or that so many times."""
    allowed = watch.tolerance * watch.exchanged * times + ROUND_OFF * watch.size
    return not abs(watch.amount[i]) <= allowed


def judge(watch: np.record) -> Status:
    """Return whether a run that has reached its end has kept the balance of energy."""
    return Status.INACCURATE if beyond(ALL, watch, INACCURATE) else Status.SUCCESS


def sentences(watch: np.record) -> tuple[str, ...]:
    """Return what has gone beyond `Options.energy_tolerance`: when, how much, and what to change."""
    kinds = [i for i in (RESIDUAL, IMPACTS, FRICTION, BOUNCES) if beyond(i, watch)]
    if not kinds and beyond(ALL, watch):
        kinds = [ALL]
    return tuple(_sentence(i, watch) for i in kinds)


def deepest(run) -> tuple[float, float]:
    """Return how far a body of vertices is in a half-space at a saved time, as a part of its size, and when.

    Looked at where steps were taken whole or in parts; elsewhere it is rare, and small.
    """
    rec, clock, most = run.records, run.clock[0], (0.0, 0.0)
    if clock.whole == 0:
        return most
    state, vertices = rec.state[: clock.saved], run.compiled.system.vertices
    for contact in run.compiled.system.contacts:
        if contact.touches != VERTICES or contact.other >= 0:
            continue
        body, normal = state[:, contact.body], contact.axes[0]
        down = quaternion.rotate_back(body["Q"], normal)
        gap = body["x"] @ normal - contact.offset - contact.radius
        lowest = np.full(len(gap), np.inf)
        for point in vertices[contact.first : contact.last]:
            lowest = np.minimum(lowest, down @ point)
        k = int(np.argmin(gap + lowest))
        depth = -float(gap[k] + lowest[k]) / float(contact.extent)
        if depth > most[0]:
            most = depth, float(rec.series.t[k])
    return most


def of_depth(depth: float, when: float) -> tuple[str, ...]:
    """Return the sentence about a body that is so far in a surface; none up to `DEEP`."""
    if depth <= DEEP:
        return ()
    return (
        f"A body is in the surface that it touches by {depth:.2g} of its size at t = {when:.6g} s, where "
        "events followed each other too fast to be located. Take a smaller step.",
    )


def _sentence(i: int, watch: np.record) -> str:
    what, cure = _WHAT[i]
    amount, of = float(watch.amount[i]), float(watch.exchanged)
    part = abs(amount) / of if of > 0.0 else np.inf
    return (
        f"{what} {amount:.3g} J at t = {watch.time[i]:.6g} s, {part:.2g} of the largest energy exchanged "
        f"({of:.3g} J); allowed is Options.energy_tolerance = {float(watch.tolerance):g}. {cure}."
    )


def watched(t, ledger: Ledger, given, tolerance: float) -> np.record:
    """Return that record from a ledger at saved times t, for runs that are not watched in their loop.

    `given` is what impacts gave until then where Newton's law with friction may.
    """
    watch = new_watch(tolerance)[0]
    rises = {IMPACTS: ledger.impacts - given, FRICTION: ledger.friction, BOUNCES: ledger.bounces}
    kinds = {i: line - np.minimum.accumulate(line) for i, line in rises.items()}
    kinds[ALL] = np.abs(ledger.residual) + sum(kinds.values())
    kinds[RESIDUAL] = ledger.residual
    for i, amounts in kinds.items():
        k = int(np.argmax(np.abs(amounts)))
        watch.amount[i], watch.time[i] = amounts[k], t[k]
    change = ledger.potential - ledger.potential[0]
    lines = (ledger.kinetic, change, ledger.loads, ledger.impacts, ledger.friction, ledger.bounces)
    watch.exchanged = max(float(np.max(np.abs(line))) for line in lines)
    watch.size = float(np.max(ledger.kinetic + np.abs(ledger.potential)))
    return watch


def energy_error(watch: np.record) -> float:
    """Return the greatest energy without a name as a part of the largest exchanged; round-off is none."""
    amount, of = abs(float(watch.amount[ALL])), float(watch.exchanged)
    if amount <= ROUND_OFF * float(watch.size):
        return 0.0
    return amount / of if of > 0.0 else np.inf
