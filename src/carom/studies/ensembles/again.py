"""A run that is set up once and started many times, each time like a new run.

To set up a run takes as long as hundreds of its steps: the scene is compiled, arrays are made, compiled code is
loaded. Here all data that a run changes are reset to their values before the first step instead, so that no run
depends on the runs before it.
"""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import Columns
from carom.model.compile import attitudes
from carom.model.kept import Kept
from carom.run import Run, check_start, check_stops
from carom.scene.scene import Scene
from carom.stepping.settings import Settings
from carom.studies.ensembles.targets import Target, changed, check_places


class Again:
    """A `Run` with values that differ from one start to the next."""

    def __init__(self, scene: Scene, settings: Settings, targets: list[Target]):
        self.scene, self.settings, self.targets = scene, settings, targets
        projected = (
            settings.options.project_start and len(scene.joints) > 0
        )  # each run has its own projected start
        self.light = all(target.light for target in targets) and not projected
        if self.light:
            self.run = Run(scene, settings)
            start = self.run.compiled.start.copy()
            self.first = start.view(Columns)  # `Run.now` is written to
            self.kept = Kept(self.run.memory)

    def start(self, values: dict[str, np.ndarray]) -> Run:
        """Return the run, prepared to start with these values, one for each name.

        Raises
        ------
        ValueError
            If bodies penetrate each other at the start, or the start violates a joint.
        """
        if not self.light:
            return Run(changed(self.scene, self.targets, values), self.settings)
        run = self.run
        # during a run contacts, or room for them, may have been added
        if self.kept.is_of(run.memory):
            self.kept.restore()
        else:
            run.compiled.start[:] = self.first
            run.renew()
            self.kept = Kept(run.memory)
        run.clock.saved = 0
        run.compiled.functions.failed = None  # the error of a user-defined function in the last run
        self.write(values)
        check_start(run.scene, run.compiled, run.now, run.work, run.options)
        check_stops(run.scene, run.compiled, run.now, run.work, run.options)
        run.note_modes()
        run.save_now()
        return run

    def write(self, values: dict[str, np.ndarray]) -> None:
        """Write the values into the arrays of the run."""
        run, contacts = self.run, self.run.compiled.system.contacts
        run.now[:] = self.first
        check_places(self.scene, self.targets, values)
        names = {target.name for target in self.targets}
        for target in self.targets:
            value, k = values[target.name], target.index
            if target.field == "position":
                run.now.x[k] = value
            elif target.field == "velocity":
                run.now.v[k] = value
            elif target.field == "angular_velocity":
                run.now.w[k] = value
            elif target.field == "orientation":
                unit = np.array(value) / np.linalg.norm(value)
                run.now.Q[k] = attitudes(unit[None], run.compiled.to_principal[k : k + 1])[0]
            else:
                rows = contacts.number == k
                if target.field == "rolling_friction":
                    contacts.turning[rows, 0] = value
                elif target.field == "pivoting_friction":
                    contacts.turning[rows, 1] = value
                else:
                    contacts[target.field][rows] = value
                law = self.scene.contacts[k]
                follows = target.field == "friction" and f"{target.part}.friction_held" not in names
                if follows and law.friction_held == law.friction:
                    contacts.friction_held[rows] = value
