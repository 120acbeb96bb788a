"""Saving a run repeatedly to its file."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from time import perf_counter

from carom import checks
from carom.io.files.checkpoint import Checkpoint, capture
from carom.io.files.convert import RUN, TABLES
from carom.io.files.scene_parts import scene_to_text
from carom.io.files.writing import write
from carom.results.solution import Solution
from carom.status import Status

SHARE = 10.0  # a run goes on at least this many times as long as it took to write it


class Keeper:
    """Writer of a run to its file, every `seconds` of real time and at its end."""

    def __init__(self, run, path: str | os.PathLike, seconds: float):
        self.run, self.path = run, checked_path(path)
        scene_to_text(run.scene)  # what no file can hold is refused before anything runs
        self.seconds = checks.number("save_seconds", seconds, least=0.0, unit="s")
        self.checkpoint: Checkpoint | None = None
        self.written, self.took = perf_counter(), 0.0

    @property
    def interval(self) -> float:
        """Time between two savings [s]."""
        return max(self.seconds, SHARE * self.took)

    def look(self) -> None:
        """Write the run, if the interval since the last saving has passed; called between two steps."""
        begin = perf_counter()
        if begin - self.written < self.interval:
            return
        self.checkpoint = capture(self.run)
        try:
            so_far = Solution._from_run(self.run, Status.INTERRUPTED)
            write(self.path, so_far, self.checkpoint, whole=False)
        except Exception as error:  # a full disk, or whatever else, is no reason to lose the run
            warnings.warn(
                f"the run could not be saved to {str(self.path)!r} and continues: {error}",
                RuntimeWarning,
                stacklevel=2,
            )
        self.written = perf_counter()
        self.took = self.written - begin

    def stop(self) -> None:
        """Store the checkpoint of the run before its end is recorded, if it is between two steps."""
        self.checkpoint = capture(self.run) or self.checkpoint

    def finish(self, solution: Solution) -> Exception | None:
        """Write the end of the run, with its checkpoint unless it failed; return an error of writing."""
        going_on = solution.status is Status.INTERRUPTED or solution.status.ended
        try:
            write(self.path, solution, self.checkpoint if going_on else None)
        except Exception as error:
            return error
        return None


def checked_path(path: str | os.PathLike) -> Path:
    """Return the path of the file of a run; refuse an invalid one before the run starts."""
    checks.need("h5netcdf", "saving a run", "files")
    where = checks.file_to_write("save", path)
    if where.suffix.lower() not in RUN:
        tables = f"; tables are written at the end: Solution.save({str(where)!r})"
        raise ValueError(
            f"save must end in {', '.join(RUN)}, got {str(where)!r}"
            f"{tables if where.suffix.lower() in TABLES else ''}"
        )
    return where
