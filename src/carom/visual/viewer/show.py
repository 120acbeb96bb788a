"""The contents of a viewer, common to the live view and the page."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from carom import checks
from carom.generalized.solution import GeneralizedSolution
from carom.results.solution import Solution
from carom.visual import bodies
from carom.visual.viewer import frames, planes, strikes

IMPULSE, FORCE = "#D55E00", "#0072B2"


class Show(NamedTuple):
    """The parts of a run that a viewer shows."""

    title: str
    solution: Solution
    frames: frames.Frames
    place: frames.Place
    sizes: np.ndarray  #: (N,) radii of the bodies [m]
    parts: list[bodies.Part]
    planes: list[planes.Plane]
    links: list[bodies.Link]
    strikes: strikes.Strikes
    persistent: strikes.PersistentForces

    @property
    def longest(self) -> float:
        """Length of the longest arrow [m]: a few times the size of a body, and visible in the whole region."""
        radius = self.place.radius
        return min(0.45 * radius, max(0.1 * radius, 8.0 * float(np.median(self.sizes))))

    @property
    def left_out(self) -> list[str]:
        """Descriptions of data that are not shown completely."""
        solution, words = self.solution, []
        saved, impacts = len(solution.t), len(solution.impacts)
        shown = int(np.sum(np.isin(solution.t, self.frames.time)))
        if shown < saved:
            words.append(f"{shown} of {saved} saved times")
        if len(self.strikes.number) < impacts:
            words.append(f"the {len(self.strikes.number)} strongest of {impacts} impacts")
        if len(self.persistent.point) < len(solution.forces.point):
            words.append(
                f"{len(self.persistent.point)} of {len(solution.forces.point)} forces of persistent contacts"
            )
        return words


def show_of(
    what,
    title: str | None = None,
    most: int = frames.MOST_FRAMES,
    times: np.ndarray | None = None,
) -> Show:
    """Return the show of a solution, or of the file of one: of `most` frames, or at some `times`."""
    solution = solution_of(what)
    if title is None:
        title = Path(what).stem if isinstance(what, (str, os.PathLike)) else "carom"
    scene = solution.scene
    outlines = [bodies.outline_of(scene, body) for body in scene.bodies]
    sizes = np.array([outline.radius for outline in outlines])
    most = checks.integer("frames", most, least=2)
    chosen = times is not None
    moments = frames.frames_at(solution, times) if chosen else frames.frames_of(solution, most)
    place = frames.place_of(solution, moments, outlines, bodies.ground_points(scene))
    return Show(
        title, solution, moments, place, sizes,
        bodies.parts_of(scene, place.radius, centre=place.centre),
        planes.planes_of(scene, place, moments.position),
        bodies.links_in(solution),
        strikes.strikes_of(solution),
        strikes.persistent_forces(solution, moments.time),
    )  # fmt: skip


def solution_of(what) -> Solution:
    """Return the solution that is to be shown, loaded if it is in a file."""
    if isinstance(what, GeneralizedSolution):
        raise TypeError(
            "solution must be of a Scene, got one of a GeneralizedSystem: its coordinates do not give the "
            "positions of bodies; use carom.plots, or describe the system as a Scene"
        )
    if isinstance(what, (str, os.PathLike)):
        return Solution.load(checks.path("solution", what))
    checks.instance("solution", what, (Solution,), "; the path of its file is also allowed")
    return what


def body_number(show: Show, follow: str | None) -> int:
    """Return which body to follow, by its name; -1 for none."""
    if follow is None:
        return -1
    names = [body.name for body in show.solution.scene.bodies]
    return names.index(checks.choice("follow", follow, names))


def playing_speed(duration: float) -> float:
    """Return a speed at which a run is played by default: real time, or slower if it lasts below 5 s."""
    speeds = [m * 10.0**e for e in range(-6, 0) for m in (1, 2, 5)] + [1.0]
    return max((s for s in speeds if duration >= 5.0 * s), default=speeds[0])
