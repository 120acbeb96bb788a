"""The warnings of a run whose balance of energy is off, or in which a body gets into what it touches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.model.contact_rows import touching_pairs
from carom.results.ledger import Ledger
from carom.status import Status
from carom.stepping.energy_balance import (
    ALL,
    BOUNCES,
    FRICTION,
    IMPACTS,
    RESIDUAL,
    ROUND_OFF,
    new_watch,
)

if TYPE_CHECKING:
    from carom.scene.all_pairs import PairTable
    from carom.scene.scene import Scene

INACCURATE = 100.0  # times the tolerance: what is no success any more
# parts of its size that a body is in what it touches: said, and no success
DEEP, TOO_DEEP = 1e-8, 1e-2
# parts of the greatest speed that contacts are not solved to: said, and no success
POOR, TOO_POOR = 1e-2, 0.1

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
    """Return whether the unnamed energy of a kind is beyond so many times the tolerance."""
    allowed = watch.tolerance * watch.exchanged * times + ROUND_OFF * watch.size
    return not abs(watch.amount[i]) <= allowed


def judge(watch: np.record) -> Status:
    """Return whether a run at its end has kept its balance of energy, its gaps and Coulomb's law."""
    off = beyond(ALL, watch, INACCURATE) or not watch.depth <= TOO_DEEP
    off = off or not watch.unsolved <= TOO_POOR * watch.speed
    return Status.INACCURATE if off else Status.SUCCESS


def sentences(
    watch: np.record, scene: Scene | None = None, pairs: PairTable | None = None
) -> tuple[str, ...]:
    """Return a sentence for each error that is too large: of energy, depth, or contacts that are not solved.

    Each says when the error arose, and what to change. `pairs` are those of the contacts of the
    run, None for all of the scene.
    """
    kinds = [i for i in (RESIDUAL, IMPACTS, FRICTION, BOUNCES) if beyond(i, watch)]
    if not kinds and beyond(ALL, watch):
        kinds = [ALL]
    deep = [_of_depth(watch, scene, pairs)] if scene is not None and watch.depth > DEEP else []
    poor = [] if watch.unsolved <= POOR * watch.speed else [_of_contacts(watch)]
    return (*(_sentence(i, watch) for i in kinds), *deep, *poor)


def _of_contacts(watch: np.record) -> str:
    """Return the sentence about contacts whose impulses were not found."""
    return (
        f"Contacts were solved to {watch.unsolved:.2g} m/s only at t = {watch.unsolved_at:.6g} s (greatest "
        f"speed: {watch.speed:.2g} m/s): so fast may points approach, or slip against their friction. Take a "
        "smaller step."
    )


def _of_depth(watch: np.record, scene: Scene, pairs: PairTable | None) -> str:
    """Return the sentence about a body that is in what it touches."""
    number, pairs = int(watch.deep_contact), pairs or touching_pairs(scene)
    if number < len(pairs.body):
        other, plane = pairs.other[number], pairs.plane[number]
        what = scene.bodies[pairs.body[number]]
        where = scene.bodies[other] if other >= 0 else scene.fixed[plane]
        said = f"Body {what.name!r} is in {where.name!r} by {watch.depth:.2g} of its size"
    else:
        stop = scene.stops[number - len(pairs.body)]
        said = f"Joint {stop.joint.name!r} is beyond its stop by {watch.depth:.2g} of the size of its body"
    return (
        f"{said} at t = {watch.deep_at:.6g} s: events follow each other too fast to be located. Take a "
        "smaller step."
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
    """Return the greatest unnamed energy as a part of the largest exchanged; round-off counts as zero."""
    amount, of = abs(float(watch.amount[ALL])), float(watch.exchanged)
    if amount <= ROUND_OFF * float(watch.size):
        return 0.0
    return amount / of if of > 0.0 else np.inf


def taken_whole(stats: dict) -> tuple[str, ...]:
    """Return a sentence about steps in which bodies that touch were taken whole, if there were any."""
    whole, steps = stats["whole_steps"], stats["steps"]
    if whole == 0:
        return ()
    return (
        f"In {whole} of {steps} steps bodies that touch were taken whole: their impacts are at the "
        "ends of these steps, or of parts of them.",
    )
