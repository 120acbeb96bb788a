"""A run of a `GeneralizedSystem`: the run of its scene, with checks and a solution in coordinates."""

from __future__ import annotations

import numpy as np

from carom.generalized.scene import CoordinateScene
from carom.generalized.solution import GeneralizedSolution
from carom.generalized.state import CoordinateState
from carom.generalized.thresholds import INSIDE
from carom.geometry.thresholds import SMALLEST
from carom.model.chart import Chart
from carom.run import Run
from carom.status import Status

#: how a run ends whose metric is singular, among other reasons
LOST = Status.NOT_FINITE, Status.CONSTRAINTS_LOST, Status.NO_CONVERGENCE


class CoordinateRun(Run):
    """A run of the scene of a system in coordinates of the user's own."""

    scene: CoordinateScene

    def check(self, scene: CoordinateScene) -> None:
        """Refuse a start that violates constraints or contacts."""
        options, system = self.options, scene.system
        here = system.evaluation().look(np.append(system.position, system.velocity))
        check_constraints(system, here, options)
        sizes = np.abs(here.G[:, 0]) @ np.abs(system.position)
        for contact in np.flatnonzero(here.gap < -INSIDE * sizes):
            name = system.contacts[contact].name
            raise ValueError(
                f"position must not be inside a contact, got the gap {here.gap[contact]:.6g} of {name!r}"
            )

    def state(self, known: dict | None = None) -> CoordinateState:
        """Return the present state, for user-defined functions."""
        return CoordinateState._of(super().state(known), self.compiled.system.chart.scale)

    def ending(self, status: Status) -> Status:
        """Return that the metric is singular, if this is why the run ends."""
        singular = self.compiled.system.chart.singular[0] == 1.0
        return Status.SINGULAR_METRIC if status in LOST and singular else status

    def solution(self, status: Status, **watched) -> GeneralizedSolution:
        """Return the solution; after a failure it ends with the last state, saved or not."""
        if "state_events" in watched:
            watched["state_events"] = [
                [one._state for one in some] for some in watched["state_events"]
            ]
        return GeneralizedSolution._of(super().solution(status, **watched))


def check_constraints(system, here: Chart, options) -> None:
    """Refuse a start beside its constraints; `Options.project_start` projects velocities."""
    q, v, tolerance = system.position, system.velocity, options.constraint_tolerance
    rates, speeds = here.A @ v, np.abs(here.A) @ np.abs(v)
    sizes = np.abs(here.A[: len(here.phi)]) @ np.abs(q)
    if not np.all(np.abs(here.phi) <= tolerance * np.maximum(sizes, 1.0)):
        raise ValueError(
            f"position must satisfy the constraints, got phi(q) = {here.phi.tolist()} at the start"
        )
    right = np.all(np.abs(rates) <= tolerance * np.maximum(speeds, SMALLEST))
    if not (right or options.project_start):
        raise ValueError(
            f"velocity must satisfy the constraints, got A v = {rates.tolist()} at the start; use "
            "Options(project_start=True)"
        )
