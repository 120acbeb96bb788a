"""The records of a run in a solution from a file, instead of the run itself."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from carom.dynamics.methods import METHODS
from carom.io.files.checkpoint import Checkpoint, restore
from carom.model import records as r
from carom.model.compile import Compiled, with_pairs
from carom.model.contact_rows import first_pairs, touching_pairs
from carom.model.method import IMPLICIT, THREE_FIELD
from carom.model.switched import NOTHING_SWITCHED
from carom.options import Options
from carom.results.set_forces import History, rows_of_forces
from carom.scene.all_pairs import PairTable, joined_tables, may_touch, some_pairs
from carom.scene.scene import Scene


def run_again(scene: Scene, settings: dict, options: Options):
    """Return a new run with the settings of another one."""
    from carom.generalized.run import CoordinateRun
    from carom.run import Run
    from carom.stepping.settings import settings_of

    kind = Run if scene._chart is None else CoordinateRun
    return kind(scene, settings_of(settings, options))


class KeptRun:
    """The records of a run that has ended; its scene is compiled again only when it is needed."""

    def __init__(
        self, scene: Scene, settings: dict, options: Options, records: r.Records,
        checkpoint: Checkpoint | None, missing: list[str], attributes: dict, found: np.ndarray | None,
        history: History | None = None, switched: np.ndarray = NOTHING_SWITCHED,
    ):  # fmt: skip
        self.attributes, self.found, self.switched = attributes, found, switched
        self.history = history  # of a `carom.Run`: what its forces were set to
        self.scene, self.settings, self.options = scene, settings, options
        self.records, self.checkpoint, self.missing = records, checkpoint, missing
        self.clock = r.new_clock()
        clock = self.clock[0]
        clock.saved, clock.touched = len(records.series), len(records.touch)
        clock.struck, clock.event = len(records.impact), len(records.event)
        clock.snapped = len(records.snapshot)

    def revived(self, duration: float | None = None, stand: bool = True):
        """Return a run at its checkpoint, or (if not `stand`) at its start.

        With a duration, the run continues to that time.
        """
        settings = self.settings
        if duration is not None:
            earlier = (*settings.get("earlier", ()), settings["duration"])
            settings = {**settings, "earlier": earlier, "duration": duration}
        run = run_again(self.scene, settings, self.options)
        if (run.found is None) != (self.found is None):
            raise ValueError("the file was written by another version of carom")
        if self.found is not None:  # it may have stood where it is earlier than the records end
            known = self.checkpoint.found["pairs"] if self.checkpoint and stand else None
            run.add_pairs(self.found[:known])
        if self.checkpoint is not None and stand:
            run.stand_at_end_of(self.switched)
            restore(run, self.checkpoint, self.records)
        return run

    def rows_of_forces(self, compiled: Compiled, saved: int):
        """Go through ranges of saved rows in which forces stay as they are; write them into the arrays."""
        if self.history is None:
            return [(0, saved)]
        return rows_of_forces(self.history, self.scene, compiled, saved)

    def need_functions(self, where: str) -> None:
        """Refuse what cannot be done without the functions that a file cannot contain."""
        if self.missing:
            names = ", ".join(map(repr, self.missing))
            raise ValueError(f"functions must be given for {names}, {where}, got none")

    @cached_property
    def _run(self):
        # of one that has ended what is compiled is enough, by any version of carom
        return self.revived(stand=self.attributes["status"] == "INTERRUPTED")

    @cached_property
    def compiled(self):
        """The compiled scene; if functions are missing, the run cannot continue."""
        if self.missing:
            return self._as_at_start
        made = self._run.compiled
        if self.found is None:
            return made
        rest = self.found[len(made.pairs.body) - len(self.pairs.body) + len(self.found) :]
        return with_pairs(made, self.scene, self.options, rest) if len(rest) else made

    @cached_property
    def _as_at_start(self):
        from carom.model.compile import compile_scene

        kind = METHODS[self.settings["method"]].kind
        return compile_scene(self.scene, self.options, kind == THREE_FIELD, kind == IMPLICIT)

    @property
    def bodies(self):
        """The records of the bodies in the kernels, (N,) BODY."""
        return self._as_at_start.system.bodies

    @property
    def method(self):
        """Settings of the method, for which the run is made again."""
        self.need_functions("by Solution.load to compute this")
        return self._run.method

    @cached_property
    def to_principal(self) -> np.ndarray:
        """Quaternions (N, 4) from principal axes to the scene's body axes."""
        from carom.model.compile import principal

        return np.array([principal(body.inertia)[1] for body in self.scene.bodies])

    @cached_property
    def pairs(self) -> PairTable:
        """The pairs of the contacts, by number of the contact.

        Raises
        ------
        ValueError
            If the file names a contact of two bodies that may not touch in the scene.
        """
        if self.found is None:
            return touching_pairs(self.scene)
        first, later = first_pairs(self.scene, True)
        if later is None:
            raise ValueError("all pairs of the scene have contacts from the start")
        body, other = self.found.T
        inside = (body >= 0) & (body < other) & (other < len(self.scene.bodies))
        keys = np.append(first.body, body) * len(self.scene.bodies) + np.append(first.other, other)
        keys = keys[np.append(first.other, other) >= 0]
        once = len(np.unique(keys)) == len(keys)
        if not (once and inside.all() and may_touch(later, body, other).all()):
            raise ValueError("it has contacts of bodies that may not touch")
        return joined_tables(first, some_pairs(later, body, other))
