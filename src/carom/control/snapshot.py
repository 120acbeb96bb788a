"""A snapshot: puts a run back to where it stood a step before."""

from __future__ import annotations

from carom.model.kept import Kept


class Snapshot:
    """Everything that the next step depends on: taken between two steps, put back after a trial.

    The records of a run are not kept: its clock says how many of their rows are valid.
    """

    def __init__(self, run):
        self.run = run
        self.parts, self.kept = self.present(), Kept(run.memory)

    def take(self) -> None:
        """Keep where the run stands."""
        if self.kept.is_of(self.run.memory):
            self.kept.take()
        else:  # it has grown
            self.kept = Kept(self.run.memory)
        self.parts = self.present()

    def put_back(self) -> None:
        """Put the run back to where it stood."""
        run = self.run
        run.compiled, run.now, run.active, run.islands = self.parts
        self.kept.restore()

    def present(self) -> tuple:
        """Return the parts of the run that are replaced when they grow."""
        run = self.run
        return run.compiled, run.now, run.active, run.islands
