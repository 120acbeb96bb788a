"""The records of a run that a solution from a file holds in the place of the run itself."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from carom.io.files.checkpoint import Checkpoint, restore
from carom.model import records as r
from carom.options import Options
from carom.scene.scene import Scene


def run_again(scene: Scene, settings: dict, options: Options):
    """Return a run that has not begun, from the settings of another one."""
    from carom.run import Run
    from carom.stepping.settings import spacing

    adapts = settings["step"] == "auto"
    h, steps = spacing(settings["duration"], settings["step"], options)
    tolerances = (settings["rtol"], settings["atol"]) if adapts else None
    return Run(
        scene, settings["duration"], h, steps, settings["method"], settings["impact_location"],
        settings["save_every"], options, tolerances,
    )  # fmt: skip


class KeptRun:
    """The records of a run that has ended; compiled again only where something is worked out from them."""

    def __init__(
        self, scene: Scene, settings: dict, options: Options, records: r.Records,
        checkpoint: Checkpoint | None, missing: list[str], attributes: dict,
    ):  # fmt: skip
        self.attributes = attributes
        self.scene, self.settings, self.options = scene, settings, options
        self.records, self.checkpoint, self.missing = records, checkpoint, missing
        self.clock = r.new_clock()
        clock = self.clock[0]
        clock.saved, clock.touched = len(records.series), len(records.touch)
        clock.struck, clock.event = len(records.impact), len(records.event)
        clock.snapped = len(records.snapshot)

    def revived(self):
        """Return a run that stands where the checkpoint says."""
        run = run_again(self.scene, self.settings, self.options)
        if self.checkpoint is not None:
            restore(run, self.checkpoint, self.records)
        return run

    @cached_property
    def _run(self):
        return self.revived()

    @cached_property
    def compiled(self):
        """The compiled scene; with functions missing it cannot stand where the run did."""
        return self._as_at_start if self.missing else self._run.compiled

    @cached_property
    def _as_at_start(self):
        from carom.dynamics.methods import METHODS
        from carom.model.compile import compile_scene
        from carom.model.method import IMPLICIT, THREE_FIELD

        kind = METHODS[self.settings["method"]].kind
        return compile_scene(self.scene, self.options, kind == THREE_FIELD, kind == IMPLICIT)

    @property
    def bodies(self):
        """What kernels know about the bodies, (N,) BODY."""
        return self._as_at_start.system.bodies

    @property
    def method(self):
        """Settings of the method, for which the run is made again."""
        if self.missing:
            names = ", ".join(map(repr, self.missing))
            raise ValueError(
                f"functions must be given to Solution.load to work this out, got none for {names}"
            )
        return self._run.method

    @cached_property
    def to_principal(self) -> np.ndarray:
        """Quaternions (N, 4) from principal axes to the scene's body axes."""
        from carom.model.compile import principal

        return np.array([principal(body.inertia)[1] for body in self.scene.bodies])

    @cached_property
    def contact_count(self) -> int:
        """Number of contacts and stops."""
        scene = self.scene
        return (
            len(scene.contacts)
            + scene._pairs.count(scene.bodies, scene.half_spaces)
            + len(scene.stops)
        )
