"""Putting a run back to where it stood a step before."""

from __future__ import annotations

import numpy as np

from carom.io.files.checkpoint import arrays_of


class Snapshot:
    """All that the loop goes on from, as bytes: taken between two steps, put back after a trial.

    What a run writes down need not be kept: how many rows are valid is in its clock.
    """

    def __init__(self, run):
        self.run = run
        self.parts: tuple = ()
        self.pairs: list[tuple[np.ndarray, np.ndarray]] = []

    def take(self) -> None:
        """Keep where the run stands."""
        parts = self.present()
        if len(self.parts) != len(parts) or any(a is not b for a, b in zip(parts, self.parts)):
            flat = [array.reshape(-1).view(np.uint8) for _, array in arrays_of(self.run)]
            self.parts, self.pairs = parts, [(there, np.empty_like(there)) for there in flat]
        for there, kept in self.pairs:
            kept[:] = there

    def put_back(self) -> None:
        """Put the run back to where it stood."""
        run = self.run
        run.compiled, run.now, run.active, run.islands = self.parts
        for there, kept in self.pairs:
            there[:] = kept

    def present(self) -> tuple:
        """Return the parts of the run that others take the place of when they grow."""
        run = self.run
        return run.compiled, run.now, run.active, run.islands
