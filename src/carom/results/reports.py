"""What forces exert and how joints have moved: evaluated by the kernels of a run at saved states.

A run adds all forces up and keeps none of them. A report makes the arrays of the scene once more, without
contacts and with all coordinates of joints. Nothing of them is shared with the run, which may go on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from carom._compiled.record_arrays import table
from carom.dynamics.reports import (
    EXERTED,
    MOTION,
    REPORTED,
    write_coordinates,
    write_exerted,
    write_loads,
)
from carom.model import records as r
from carom.model.compile import compile_for_reports
from carom.results.exerted import bodies_of, rubs
from carom.results.set_forces import places, put, stated
from carom.scene.coordinates import Combination
from carom.scene.forces import AppliedForce
from carom.scene.switches import is_off


class Reports:
    """A scene as kernels read it for reports."""

    def __init__(self, scene):
        self.scene, self.compiled = scene, compile_for_reports(scene)
        self.work = r.new_work(self.compiled.system, 1)
        self.set_forces = places(scene, self.compiled)

    def motion(self, joint, states: r.Records, k: int | str | None = None) -> np.recarray:
        """Return the motion, (T, n) MOTION, of all coordinates of a joint, or of one, at saved states."""
        if isinstance(joint, Combination):
            return self._sum(joint, states)
        own = range(len(joint.definition.measured)) if k is None else (k,)
        chosen = np.array([self.compiled.numbers[joint.index, one] for one in own], dtype=np.int64)
        out = table(MOTION, len(states.state), len(chosen))
        if len(chosen):
            write_coordinates(self.compiled.system, states, chosen, out)
            # some are measured from the child
            turned = (
                self.compiled.system.relations.coordinates["child"][chosen] != joint.child.index
            )
            out["along"][:, turned] *= -1.0
        if is_off(self.scene, joint):
            out["value"] = out["rate"] = np.nan
        return out

    def _sum(self, combination: Combination, states: r.Records) -> np.recarray:
        """Return the motion (T, 1) of a combination; direction and arm are those of its first coordinate."""
        factors = [factor for _, _, factor in combination.terms]
        own = [self.motion(joint, states, k) for joint, k, _ in combination.terms]
        for name in ("value", "rate"):
            own[0][name] = sum(factor * one[name] for factor, one in zip(factors, own))
        return own[0]

    def exerted(
        self, forces: Sequence[AppliedForce], states: r.Records, ranges, frictions: Mapping
    ) -> np.recarray:
        """Return what forces exert on their bodies, (T, R) EXERTED, at saved states.

        Inertias along coordinates have NaN: what they exert follows from accelerations, which nobody keeps.

        Parameters
        ----------
        forces : forces of the scene, whose rows come one after another
        states : series, state and turn
        ranges : ranges of rows in which the forces stay as they are, in which they were set
        frictions : values (T,) of dry friction by the index of the force; by default those of slip
        """
        slips, row = np.full(len(states.state), np.nan), 0
        bodies, listed, values, still = [], [], [], []
        for force in forces:
            own, place = bodies_of(force), self.compiled.places.get(force.index)
            if place is None and (rubs(force) or is_off(self.scene, force)):  # its bound is 0
                still.append(row)
            if place is not None:
                if rubs(force):
                    place = place._replace(last=len(values))
                    values.append(frictions.get(force.index, slips))
                touched = *own, force.parent
                listed.append((*place, len(bodies), len(bodies) + len(touched), row, len(own)))
                bodies += [body.index for body in touched]
            row += len(own)
        out = table(EXERTED, len(slips), row)
        numbers(out)[:] = np.nan
        numbers(out)[:, still] = 0.0
        made = table(REPORTED, len(listed))
        for field, column in zip(REPORTED, zip(*listed)):
            made[field[0]] = column
        stacked = np.stack(values, axis=1) if values else np.zeros((len(slips), 0))
        acting = made, np.array(bodies, dtype=np.int64), stacked
        self.compiled.functions.forget()
        for rows in ranges if listed else ():
            write_exerted(self.compiled.system, states, rows, acting, self.work, out)
        if self.compiled.functions.failed is not None:
            raise self.compiled.functions.failed
        return out

    def loads(self, states: r.Records, reactions, forces, values) -> np.ndarray:
        """Return the loads (T, n) of joints that bound n frictions, 1 for constant bounds.

        Parameters
        ----------
        states : series, state and turn
        reactions : (T, E, 6) of elements on their children
        forces : the frictions
        values : (T, n) of them, along their surfaces
        """
        found = np.ones(np.shape(values))
        for k, force in enumerate(forces):
            place = self.compiled.places.get(force.index)
            if place is not None and force.definition.by_load:
                own, load = reactions[:, force.definition.joint.index], np.zeros(len(found))
                given = np.ascontiguousarray(own), np.ascontiguousarray(values[:, k])
                write_loads(self.compiled.system, states, place.first, *given, load)
                found[:, k] = load
        return found

    def set(self, given: dict[int, Any]) -> None:
        """Let forces have values that were set, by index; others those that the scene states."""
        for index, place in self.set_forces.items():
            value = given[index] if index in given else stated(self.scene, index)
            put(self.compiled.system, place, value)


def at_once(rows: np.ndarray, t: float, turns: np.ndarray | None = None) -> r.Records:
    """Return states (N,) as those of a run with one saved time; `turns` are coordinates that were counted."""
    turns = np.zeros(0) if turns is None else turns
    made = r.one_row(len(rows), len(turns))
    made.state[0], made.series["t"], made.turn["angle"] = rows, t, turns
    return made


def numbers(rows: np.recarray) -> np.ndarray:
    """Return the numbers (..., n) of rows whose columns are all of numbers."""
    return np.reshape(rows.view(np.ndarray).view(float), (*rows.shape, -1))
