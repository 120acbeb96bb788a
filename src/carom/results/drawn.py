"""What the solutions of scenes and of systems in coordinates share: how they ended, energy, `plot`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from carom import arguments
from carom.hints import ending
from carom.scene.shown import Shown
from carom.status import Status

KINDS = (
    "overview", "trajectory", "phase", "energy", "impacts", "impact_force", "impact_inside", "hodograph",
    "contacts", "joints", "forces", "constraint_errors",
)  # fmt: skip

#: argument of each plot function that `what` is passed to
WHAT = {
    "trajectory": "bodies", "phase": "of", "impacts": "contacts", "contacts": "contacts", "impact_inside": "k",
    "impact_force": "k", "hodograph": "k", "joints": "joints", "forces": "forces",
}  # fmt: skip


class Drawn(Shown):
    """Base class of solutions. Its method `plot` needs ``carom[plot]``."""

    status: Status
    kinetic_energy: Any
    potential_energy: Any

    @property
    def success(self) -> bool:
        """Whether the run reached its end, or an event that ends it, with the required accuracy."""
        return self.status in (Status.SUCCESS, Status.STOPPED)

    @property
    def total_energy(self) -> np.ndarray:
        """Kinetic plus potential energy (T,) [J]."""
        return self.kinetic_energy + self.potential_energy

    def plot(self, kind: str = "overview", what=None, **options):
        """Draw one of the plots of `carom.plots` and return its axes.

        Parameters
        ----------
        kind : str
            "overview" (default), "trajectory", "phase", "energy", "impacts", "impact_force", "impact_inside",
            "hodograph", "contacts", "joints", "forces" or "constraint_errors": the function of `carom.plots` of
            this name.
        what : optional
            The parts to draw: names of bodies for "trajectory"; a body, coordinate or joint for "phase"; names
            of contacts for "impacts" and "contacts", of joints for "joints", of forces, motors and contacts for
            "forces"; the index of an impact for "impact_force",
            "impact_inside" and "hodograph". The other kinds do not use it.
        **options
            Other arguments of that function, for example ``ax`` to draw into existing axes.

        Raises
        ------
        ImportError
            If matplotlib is missing.
        ValueError
            If `kind` is invalid, there is nothing to draw, or `what` is given for a kind that does not use it.
        """
        from carom import checks
        from carom.visual import plots

        kind = kind.replace(" ", "_") if isinstance(kind, str) else kind
        if isinstance(kind, str) and kind not in KINDS and (hint := ending("plot", kind, KINDS)):
            raise ValueError(
                f"kind must be one of {', '.join(map(repr, KINDS))}, got {kind!r}{hint}"
            )
        draw = getattr(plots, checks.choice("kind", kind, KINDS))
        if what is not None:
            if kind not in WHAT:
                raise ValueError(
                    f"what must be left out with kind {kind!r}, got {checks.shown(what)}"
                )
            options = {WHAT[kind]: what, **options}
        return draw(self, **options)

    @arguments.known
    def export(
        self,
        path: str | os.PathLike,
        *,
        fps: float | None = None,
        speed: float = 1.0,
        start: float | None = None,
        end: float | None = None,
    ) -> Path:
        """Write the motion for another program: Blender, PowerPoint, a browser, ParaView.

        ``.glb``: glTF 2.0, one file with meshes, colours, and an animation of each body, spring and rod. Bodies
        look as in `carom.view` and `carom.film`; nodes have the names of the bodies. Lengths are in metres. In
        glTF y is up: the root node turns the vertical of the scene (opposite to gravity, or z without gravity)
        to y.

        ``.pvd``: a list of times for ParaView, and beside it a folder of VTK files (``.vtu``). Part 0 of each
        time has the surfaces of the bodies in the world, with the velocity of each point, and for each cell the
        index of its body, and velocity of the mass centre and angular velocity of this body. Part 1 has contact
        points: persistent contacts with their forces [N] on the body at the last saved time, and the impacts
        since the frame before with their impulses [N s], world axes. Part 2 has half-spaces (drawn as far as
        the motion goes) and static bodies.

        Parameters
        ----------
        path : str or path
            Path of the file with one of these suffixes, in a folder that exists.
        fps : float, optional
            Frames per second. Default: the saved times; for ``.glb`` at most 5000 and with states between few
            saved times, for ``.pvd`` at most 1000. The times of impacts are added in ``.glb``, in which bodies
            move on straight lines and turn steadily from frame to frame: a turn between two frames must be less
            than half a rotation.
        speed : float
            Seconds of the run per second of the animation; below 1 is slow motion. Default 1. Times in ``.pvd``
            are those of the run.
        start, end : float, optional
            Start and end of the exported part of the run [s]. Default: the whole run.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        ImportError
            If a package is missing: pygltflib (``.glb``) or meshio (``.pvd``).
        ValueError
            If an argument is invalid, or the solution is of a `GeneralizedSystem`.
        """
        from carom.visual.exports import export

        return export(self, path, fps, speed, start, end)
