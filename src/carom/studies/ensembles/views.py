"""What an ensemble has of one body or joint: a row for each run."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.results.state import SystemState
from carom.scene.scene import Scene
from carom.studies.ensembles.plan import plain, plan_of
from carom.studies.values import changed

STATES = ("position", "orientation", "velocity", "angular_velocity")


class BodyEnds(NamedTuple):
    """A body at the ends of all runs, in world axes."""

    position: np.ndarray  #: (R, 3) mass centre [m]
    orientation: np.ndarray  #: (R, 4) unit quaternion (w, x, y, z), body to world
    velocity: np.ndarray  #: (R, 3) [m/s]
    angular_velocity: np.ndarray  #: (R, 3) [rad/s]


class Ends(NamedTuple):
    """Coordinates and rates of a joint at the ends of all runs, (R,), or (R, n) of a joint with several."""

    coordinate: np.ndarray  #: angles are from -pi to pi [rad], others in [m]
    rate: np.ndarray


def view(ensemble, key) -> Any:
    """Return the results of one thing, given by name or as a part."""
    name = getattr(key, "name", key)
    if name in ensemble.bodies:
        at = ensemble.bodies.index(name)
        return BodyEnds(*(ensemble.outcomes[field][:, at] for field in STATES))
    for found in (ensemble.inputs, ensemble.observed):
        if name in found:
            return found[name]
    if isinstance(name, str) and name in (ensemble.outcomes.dtype.names or ()):
        return ensemble.outcomes[name]
    joints = _joints(ensemble)
    if name in joints:
        return _ends(ensemble, name)
    known = [*ensemble.bodies, *joints, *ensemble.inputs, *ensemble.observed]
    known += ensemble.outcomes.dtype.names or ()
    near = checks.nearest(str(name), known) or f"; it has {', '.join(map(repr, known[:12]))}"
    raise KeyError(f"the ensemble has no {checks.shown(name)}{near}")


def state_of(ensemble, run: int) -> SystemState:
    """Return the state at the end of a run, of the scene of this run."""
    row = ensemble.outcomes[run]
    energies = float(row["kinetic_energy"]), float("nan")
    motion = tuple(row[field] for field in STATES)
    return SystemState._of_file(_scene(ensemble, run), float(row["t"]), *energies, motion)


def _joints(ensemble) -> list[str]:
    plan = ensemble._plan
    if plan is None or not isinstance(plan.scene, Scene):
        return []
    return [joint.name for joint in plan.scene.joints]


def _ends(ensemble, name: str) -> Ends:
    states = [state_of(ensemble, k) for k in range(len(ensemble))]
    pairs = [(state[name].coordinate, state[name].rate) for state in states]
    return Ends(*(np.array(column) for column in zip(*pairs)))


def _scene(ensemble, run: int) -> Scene:
    """Return the scene of a run."""
    plan = ensemble._plan
    if plan is None:
        raise ValueError(
            "a state needs the scene, but an ensemble from disk has none; call carom.ensemble with the same "
            "arguments and the same save"
        )
    if not isinstance(plan.scene, Scene):
        return plan.scene(**plain(ensemble.inputs, run))
    if all(
        target.light and target.field not in ("position", "orientation") for target in plan.targets
    ):
        return plan.scene
    one = {name: array[run : run + 1] for name, array in ensemble.inputs.items()}
    values = plan_of(plan.scene, plan.settings, one, {}, None)[1]
    return changed(plan.scene, plan.targets, {name: rows[0] for name, rows in values.items()})
