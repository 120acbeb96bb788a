"""Warnings of a run: errors of energy, penetration, unsolved contact problems, and steps that are too long."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.model.contact_rows import touching_pairs
from carom.results.ledger import Ledger
from carom.scene.surface_definition import SurfaceDefinition
from carom.stepping.energy_balance import ALL, BOUNCES, FRICTION, IMPACTS, RESIDUAL, new_watch
from carom.stepping.thresholds import ENERGY_ROUND_OFF

if TYPE_CHECKING:
    from carom.results.solution import Solution
    from carom.scene.all_pairs import PairTable
    from carom.scene.scene import Scene

INACCURATE = 100.0  # relative to the tolerance: a run with a larger error is no success
# depth of a penetration, relative to the size of the body, that gives a warning, and that is no success
DEEP, TOO_DEEP = 1e-8, 1e-2
# residual of contacts, relative to the greatest speed, that gives a warning, and that is no success
POOR, TOO_POOR = 1e-2, 0.1
#: allowed difference, relative to the path at the greatest speed: that of a harmonic motion with 1.1 rad in a
#: step, and with 2.2 rad for the method of order 8, which is still accurate then
COARSE, OF_ORDER_8 = 0.1, 0.4
SEEN = 1e-3  # of the size of a body: smaller differences do not count
GOOD = 1e-3  # the same difference for the step that the sentence recommends

_WHAT = {
    RESIDUAL: ("Energy error that no entry of the ledger explains:", "{finer}, or raise the tolerance"),
    IMPACTS: ("Energy that impacts added, which is not physical:", 'Use impact_law="stronge"'),
    FRICTION: ("Energy that friction added, which is not physical:", "{finer}, or raise the tolerance"),
    BOUNCES: ("Energy that was added where small bounces were dropped, which is not physical:", "{finer}"),
    ALL: ("Sum of several energy errors:", "{finer}, or raise the tolerance"),
}  # fmt: skip

_WHY = {
    1: "a contact problem was not solved, or lost too much energy",
    2: "a step was cut too often",
    3: "events follow each other without end, or need too many trial steps",
    6: "an impact could not be solved",
}
_OTHER = "they could not be moved from event to event"


def beyond(i: int, watch: np.record | np.ndarray | dict, times: float = 1.0):
    """Return whether the energy error of a kind exceeds `times` the tolerance; for one record, or an array.

    The work that applied forces could do over the allowed errors of positions is allowed too: at rest no energy
    is exchanged, and its round-off is no error.
    """
    return ~(np.abs(watch["amount"][..., i]) <= allowed(watch, times))


def allowed(watch: np.record | np.ndarray | dict, times: float = INACCURATE):
    """Return `times` the energy errors that the tolerance allows [J]."""
    most = (watch["tolerance"] * watch["exchanged"] + watch["able"]) * times
    return most + ENERGY_ROUND_OFF * watch["size"]


def inaccurate(watch: np.record | np.ndarray | dict):
    """Return whether runs are no success by energy, gaps and contact problems; for one record, or an array."""
    solved = watch["unsolved"] <= TOO_POOR * watch["speed"]
    return beyond(ALL, watch, INACCURATE) | np.logical_not((watch["depth"] <= TOO_DEEP) & solved)


def sentences(
    watch: np.record, finer: str, scene: Scene | None = None, pairs: PairTable | None = None
) -> tuple[str, ...]:
    """Return a sentence for each error that is too large, of energy, penetration, or contact problems.

    The first is that of the error which exceeds its bound most: it decides whether a run is a success. Each has
    the time of the error and a remedy, `finer` for shorter steps. `pairs` are the pairs of the contacts of the
    run, None for all pairs of the scene.
    """
    numbers: dict[str, Any] = dict(zip(watch.dtype.names or (), watch.item()))
    bound = allowed(numbers, 1.0)
    over = [not abs(amount) <= bound for amount in numbers["amount"].tolist()]
    kinds = [i for i in (RESIDUAL, IMPACTS, FRICTION, BOUNCES) if over[i]]
    if not kinds and over[ALL]:
        kinds = [ALL]
    found = [
        (_excess(abs(watch.amount[i]), float(allowed(watch))), _of_energy(i, watch)) for i in kinds
    ]
    if scene is not None and DEEP < numbers["depth"] < np.inf:  # inf: a gap that has no value
        found.append((_excess(watch.depth, TOO_DEEP), _of_depth(watch, scene, pairs)))
    if not numbers["unsolved"] <= POOR * numbers["speed"]:
        found.append((_excess(watch.unsolved, TOO_POOR * watch.speed), _of_contacts(watch)))
    found.sort(key=lambda one: -one[0])
    if numbers["whole"] > 0:
        found.append((0.0, _of_whole(watch)))
    if numbers["astray"] > 1.0 and not numbers["astray_size"] <= numbers["whole_error"]:
        found.append((0.0, _of_crowd(watch)))
    return tuple(sentence.replace("{finer}", finer) for _, sentence in found)


def _excess(error: float, bound: float) -> float:
    """Return an error in parts of the bound beyond which a run is no success; NaN is the worst."""
    part = float(error) / max(float(bound), 1e-300)
    return np.inf if np.isnan(part) else part


def _of_whole(watch: np.record) -> str:
    """Return the sentence about time-stepping steps of a few bodies."""
    why = _WHY.get(int(watch.whole_code), _OTHER)
    return (
        f"{watch.whole} time-stepping (Moreau) steps of up to {watch.whole_length:.3g} s, the first at t = "
        f"{watch.whole_at:.6g} s of {watch.whole_bodies} bodies: {why}. Their "
        f"impacts are at the ends of these steps: a body is misplaced by up to {watch.whole_error:.2g} of its "
        "size. {finer}."
    )


def _of_crowd(watch: np.record) -> str:
    """Return the sentence about time-stepping steps of many bodies."""
    return (
        "Bodies that touch at many points took time-stepping (Moreau) steps, with impacts at their ends: by "
        f"the changes of their forces from step to step a body is misplaced by up to {watch.astray_size:.2g} "
        f"of its size, {watch.astray:.2g} times the tolerance. This falls in proportion to Options.max_step."
    )


def _of_contacts(watch: np.record) -> str:
    """Return the sentence about contact problems that were not solved."""
    return (
        f"A contact problem was solved with an error of {watch.unsolved:.2g} m/s at t = "
        f"{watch.unsolved_at:.6g} s (greatest speed: {watch.speed:.2g} m/s): closed points may approach or "
        f"slip at this speed although they should not. Up to {TOO_POOR:g} of the greatest speed is allowed. "
        "{finer}."
    )


def _of_depth(watch: np.record, scene: Scene, pairs: PairTable | None) -> str:
    """Return the sentence about a body that penetrates another one, or a joint beyond its stop."""
    why = "events follow each other too fast to be located"
    number, pairs = int(watch.deep_contact), touching_pairs(scene) if pairs is None else pairs
    if number < len(pairs.body):
        other, plane = pairs.other[number], pairs.plane[number]
        what = scene.bodies[pairs.body[number]]
        where = scene.bodies[other] if other >= 0 else scene.fixed[plane]
        said = f"Body {what.name!r} penetrates {where.name!r} by {watch.depth:.2g} of its size"
        if isinstance(getattr(where, "shape", None), SurfaceDefinition):
            why += ", or a bump reaches into a face, which touches it at vertices and edges only"
    else:
        stop = scene.stops[number - len(pairs.body)]
        beyond = "penetrates its rail" if stop.joint.can_be_left else "exceeds its stop"
        said = f"Joint {stop.joint.name!r} {beyond} by {watch.depth:.2g} of the size of its body"
    return f"{said} at t = {watch.deep_at:.6g} s ({TOO_DEEP:g} is allowed): {why}. {{finer}}."


def _of_energy(i: int, watch: np.record) -> str:
    """Return the sentence about an energy error."""
    what, cure = _WHAT[i]
    amount, of, bound = float(watch.amount[i]), float(watch.exchanged), float(watch.tolerance)
    part = abs(amount) / of if of > 0.0 else np.inf
    return (
        f"{what} {amount:.3g} J at t = {watch.time[i]:.6g} s, {part:.2g} of the largest energy exchanged "
        f"({of:.3g} J); the tolerance is Options.energy_tolerance = {bound:g}. {cure}."
    )


def watched(t, ledger: Ledger, given, exchanged: float, tolerance: float) -> np.record:
    """Return the record of energy errors from a ledger at saved times t, for loops that do not write one.

    `given` is the energy that impacts have added up to these times by Newton's law with friction, `exchanged`
    the greatest kinetic energy and the greatest work of all steps.
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
    watch.exchanged = max(exchanged, float(np.max(np.abs(change))))
    watch.size = float(np.max(ledger.kinetic + np.abs(ledger.potential)))
    return watch


def energy_error(watch: np.ndarray) -> np.ndarray:
    """Return largest energy errors as fractions of the largest energies exchanged; round-off counts as 0."""
    amount, of = np.abs(watch["amount"][..., ALL]), watch["exchanged"]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.where(of > 0.0, amount / of, np.inf)
    return np.where(amount <= ENERGY_ROUND_OFF * watch["size"], 0.0, error)


def taken_whole(stats: dict) -> tuple[str, ...]:
    """Return a sentence about time-stepping (Moreau) steps without event detection, if there were any."""
    whole, steps = stats["whole_steps"], stats["steps"]
    if whole == 0:
        return ()
    return (
        f"In {whole} of {steps} steps touching bodies took a time-stepping (Moreau) step without event "
        "detection: their impacts are at the ends of these steps, or of parts of them.",
    )


def too_long(solution: Solution, bodies, step: float, method: str) -> tuple[str, ...]:
    """Return a sentence if a given step is far too long for the motion of joined or loaded bodies.

    The displacement of such a body in a step is compared with the trapezoidal rule: for an angular frequency
    omega the two differ by (omega h)^2 / 12 of the displacement. Free flight is exact with any step, and steps
    with impacts are left out because the velocity jumps.

    Parameters
    ----------
    solution
        A solution in which each step is saved.
    bodies : (N,) BODY
        The records of the bodies in the kernels: sizes, and which bodies are neither joined nor loaded.
    step : float
        Length of a step [s].
    method : str
        Method of the run.
    """
    t, bound, sizes = solution.t, np.flatnonzero(bodies["ballistic"] == 0), bodies["extent"]
    if len(t) < 3 or not len(bound):
        return ()
    x, v = solution.position[:, bound], solution.velocity[:, bound]
    h = np.diff(t)[:, None, None]
    off = np.linalg.norm(np.diff(x, axis=0) - 0.5 * h * (v[1:] + v[:-1]), axis=-1)
    fastest = np.linalg.norm(v, axis=-1).max(axis=0)
    strikes = np.searchsorted(t, solution.impacts.time)
    smooth = np.ones(len(t) - 1, dtype=bool)
    for k in (strikes - 1, strikes):
        smooth[np.clip(k, 0, len(smooth) - 1)] = False
    if not smooth.any():
        return ()
    # a quarter of all steps differ by more; the few first steps in which a stiff damper acts do not count
    most = np.quantile(off[smooth], 0.75, axis=0)
    part = np.where(most > SEEN * sizes[bound], most, 0.0) / np.maximum(step * fastest, 1e-300)
    worst = int(np.argmax(part))
    if not part[worst] > (OF_ORDER_8 if method == "rk8" else COARSE):
        return ()
    name, good = solution.scene.bodies[bound[worst]].name, step * np.sqrt(GOOD / part[worst])
    return (
        f"step={step:g} s is far too long for the motion of {name!r}: its velocity changes too much in one "
        f"step. Take step={good:.1g} or less, or leave step out.",
    )
