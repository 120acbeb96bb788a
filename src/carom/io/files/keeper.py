"""Saving a run as it goes."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from time import perf_counter

from carom import checks
from carom.io.files.checkpoint import Checkpoint, capture
from carom.io.files.needs import need
from carom.io.files.scene_parts import scene_to_text
from carom.io.files.tables import RUN, TABLES
from carom.io.files.writing import write
from carom.results.solution import Solution
from carom.status import Status

SHARE = 10.0  # a run goes on at least this many times as long as it took to write it


class Keeper:
    """Writes a run to its file every `seconds` of time on the clock on the wall, and at its end."""

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
        """Write the run between two steps, if it is time."""
        begin = perf_counter()
        if begin - self.written < self.interval:
            return
        self.checkpoint = capture(self.run)
        try:
            so_far = Solution._from_run(self.run, Status.INTERRUPTED)
            write(self.path, so_far, self.checkpoint, whole=False)
        except Exception as error:  # a full disk, or whatever else, is no reason to lose the run
            warnings.warn(
                f"the run could not be saved to {str(self.path)!r} and goes on: {error}",
                RuntimeWarning,
                stacklevel=2,
            )
        self.written = perf_counter()
        self.took = self.written - begin

    def stop(self) -> None:
        """Keep where the run stands, before its end is written down, if that is between two steps."""
        self.checkpoint = capture(self.run) or self.checkpoint

    def finish(self, solution: Solution) -> Exception | None:
        """Write the end, with where the run stands unless it failed; return what went wrong."""
        going_on = solution.status is Status.INTERRUPTED or solution.status.ended
        try:
            write(self.path, solution, self.checkpoint if going_on else None)
        except Exception as error:
            return error
        return None


def checked_path(path: str | os.PathLike) -> Path:
    """Return the path of a file that a run is saved to as it goes; refuse another before anything runs."""
    need("h5netcdf", "saving a run")
    where = checks.file_to_write("save", path)
    if where.suffix.lower() not in RUN:
        tables = f"; tables are written at the end: Solution.save({str(where)!r})"
        raise ValueError(
            f"save must end in {', '.join(RUN)}, got {str(where)!r}"
            f"{tables if where.suffix.lower() in TABLES else ''}"
        )
    return where
