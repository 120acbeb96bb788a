"""`Solution.export`: the times that a file has, and who writes it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from carom import checks
from carom.visual.exports.gltf import write_glb
from carom.visual.exports.paraview import write_pvd
from carom.visual.films.film import frame_times, span_of
from carom.visual.plots.figure import need_bodies
from carom.visual.viewer.frames import moments_of_impacts, thinned, times_of
from carom.visual.viewer.show import Show, show_of

#: who writes a file, by its suffix: what to show, the path, and seconds of the run per second of an animation
WRITERS: dict[str, Callable[[Show, Path, float], None]] = {".glb": write_glb, ".pvd": write_pvd}
MOST_FILES = (
    1000  # frames of a run for ParaView, each in files of its own, if nothing else is asked for
)
MOST_NUMBERS = 50_000_000  # of all poses together: 200 MB in single precision


def export(solution, path, fps: float | None, speed: float, start, end) -> Path:
    """Write a run for another program; the arguments are those of `Solution.export`."""
    need_bodies(solution, "export")
    where = checks.file_to_write("path", path)
    suffix = where.suffix.lower()
    if suffix not in WRITERS:
        raise ValueError(
            f"path must end in {', '.join(WRITERS)}, got {checks.shown(str(where))}; a page (.html) is made "
            "by carom.view(solution, export=path), a film (.mp4, .gif) by carom.film"
        )
    speed = checks.scale("speed", speed)
    span = span_of(solution, start, end)
    show = show_of(solution, where.stem, times=_times(solution, suffix, fps, speed, *span))
    WRITERS[suffix](show, where, speed)
    return where


def _times(solution, suffix: str, fps, speed: float, begin: float, end: float) -> np.ndarray:
    """Return the times of the frames [s]; an animation has those of impacts too, where paths have corners."""
    bodies, table = len(solution.scene.bodies), suffix == ".pvd"
    if fps is None:
        times = thinned(solution.t, MOST_FILES) if table else times_of(solution)
        return np.union1d(times[(times > begin) & (times < end)], [begin, end])
    fps = checks.scale("fps", fps)
    times = frame_times(begin, end, fps, speed)
    if 7 * bodies * len(times) > MOST_NUMBERS:
        raise ValueError(
            f"fps must give at most {MOST_NUMBERS // (7 * bodies)} frames of {bodies} bodies, got "
            f"{len(times)} with fps={fps:g}"
        )
    struck = moments_of_impacts(solution.impacts, 0 if table else len(times))
    return np.union1d(times, struck[(struck > begin) & (struck < end)])
