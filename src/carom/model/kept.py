"""A copy of the contents of arrays, from which they can be restored; and a run that is put back."""

from __future__ import annotations

import numpy as np

from carom._compiled.template import arrays_of


class Kept:
    """A copy of the contents of all arrays in nested tuples, as bytes: records are slow to copy by fields.

    A run has fifty arrays. The copy of one takes .1 microseconds as a memoryview, and .3 as an array.
    """

    def __init__(self, parts: tuple):
        self.parts = parts
        flat = [array.reshape(-1).view(np.uint8) for array in arrays_of(parts)]
        self.content = [(there.data, there.copy().data) for there in flat]

    def take(self) -> None:
        """Store the present contents of the arrays."""
        for there, kept in self.content:
            kept[:] = there

    def restore(self) -> None:
        """Write the contents back."""
        for there, kept in self.content:
            there[:] = kept

    def is_of(self, parts: tuple) -> bool:
        """Return whether these are the same tuples; when an array is lengthened, its tuple is replaced."""
        return all(a is b for a, b in zip(parts, self.parts))


class Snapshot:
    """The place where a run stood between two steps, and to which it can be put back.

    It has all that the next step depends on. The records of a run are not kept: its clock says how many of
    their rows are valid.
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
        run.compiled, run.now, run.active, run.islands, *more = self.parts
        run.work, run.group, run.stands, run.switched = more
        self.kept.restore()

    def present(self) -> tuple:
        """Return the parts of the run that are replaced when they grow, or by a switch."""
        run = self.run
        own = run.compiled, run.now, run.active, run.islands
        return *own, run.work, run.group, run.stands, run.switched
