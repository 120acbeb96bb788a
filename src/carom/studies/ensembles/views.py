"""What an ensemble has of one body, joint or coordinate, a row for each run; and of one run."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.generalized.state import CoordinateState
from carom.generalized.system import GeneralizedSystem
from carom.io.run_to_end import finish
from carom.results.state import SystemState
from carom.studies.ensembles.plan import Plan
from carom.studies.ensembles.table import layout_of


class BodyEnds(NamedTuple):
    """A body at the ends of all runs, in world axes."""

    position: np.ndarray  #: (R, 3) mass centre [m]
    orientation: np.ndarray  #: (R, 4) unit quaternion (w, x, y, z), body to world
    velocity: np.ndarray  #: (R, 3) [m/s]
    angular_velocity: np.ndarray  #: (R, 3) [rad/s]


class Ends(NamedTuple):
    """Coordinates and rates at the ends of all runs, (R,), or (R, n) of a joint with several."""

    coordinate: np.ndarray  #: angles are from -pi to pi [rad], others in [m]
    rate: np.ndarray


def view(ensemble, key) -> Any:
    """Return the results of one thing, given by name or as a part."""
    name, layout = getattr(key, "name", key), layout_of(ensemble)
    if name in layout.names:
        at = layout.names.index(name)
        kind = {"bodies": BodyEnds, "coordinates": Ends}[layout.of]
        return kind(*(ensemble.outcomes[field][:, at] for field in layout.fields))
    for found in (ensemble.inputs, ensemble.observed):
        if name in found:
            return found[name]
    if isinstance(name, str) and name in (ensemble.outcomes.dtype.names or ()):
        return ensemble.outcomes[name]
    joints = _joints(ensemble)
    if name in joints:
        return _ends(ensemble, name)
    known = [*layout.names, *joints, *ensemble.inputs, *ensemble.observed]
    known += ensemble.outcomes.dtype.names or ()
    near = checks.nearest(str(name), known) or f"; it has {', '.join(map(repr, known[:12]))}"
    raise KeyError(f"the ensemble has no {checks.shown(name)}{near}")


def state_of(ensemble, run: int) -> Any:
    """Return the state at the end of a run, of the scene or system of this run."""
    at = ensemble.outcomes[run]
    varied, values = known_plan(ensemble, "a state").one(ensemble.inputs, run)
    system, energy = varied.stated(values, 0), float(at["kinetic_energy"])
    motion = tuple(at[field] for field in varied.layout.fields)
    if isinstance(system, GeneralizedSystem):
        q, v = motion
        return CoordinateState(float(at["t"]), q, v, energy, float("nan"))
    return SystemState._of_file(system, float(at["t"]), energy, float("nan"), motion)


def solution_of(ensemble, run: int) -> Any:
    """Return the whole solution of a run, which is made again."""
    plan = known_plan(ensemble, "solution")
    varied, values = plan.one(ensemble.inputs, run)
    how = plan.settings._replace(save_every=1)
    return finish(varied.new_run(how, values, 0), None, None, False)


def known_plan(ensemble, what: str) -> Plan:
    """Return the plan, which an ensemble from disk does not have."""
    if ensemble._plan is None:
        raise ValueError(
            f"{what} needs the scene, but an ensemble from disk has none; call carom.ensemble with the same "
            "arguments and the same save"
        )
    return ensemble._plan


def _joints(ensemble) -> list[str]:
    plan = ensemble._plan
    joints = () if plan is None else getattr(plan.varied.source, "joints", ())
    return [joint.name for joint in joints]


def _ends(ensemble, name: str) -> Ends:
    states = [state_of(ensemble, k) for k in range(len(ensemble))]
    pairs = [(state[name].coordinate, state[name].rate) for state in states]
    return Ends(*(np.array(column) for column in zip(*pairs)))
