"""What the solutions of scenes and of systems in coordinates share: how they ended, energy, `plot`."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.status import Status

KINDS = (
    "overview", "trajectory", "phase", "energy", "impacts", "impact_inside", "hodograph", "contacts",
    "joints", "forces", "constraint_errors",
)  # fmt: skip

#: argument of each plot function that `what` is passed to
WHAT = {
    "trajectory": "bodies", "phase": "of", "impacts": "contacts", "contacts": "contacts", "impact_inside": "k",
    "hodograph": "k", "joints": "joints", "forces": "forces",
}  # fmt: skip


class Drawn:
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
            "overview" (default), "trajectory", "phase", "energy", "impacts", "impact_inside", "hodograph",
            "contacts", "joints", "forces" or "constraint_errors": the function of `carom.plots` of this name.
        what : optional
            The parts to draw: names of bodies for "trajectory"; a body, coordinate or joint for "phase"; names
            of contacts for "impacts" and "contacts", of joints for "joints", of forces, motors and contacts for
            "forces"; the index of an impact for "impact_inside" and
            "hodograph". The other kinds do not use it.
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

        draw = getattr(plots, checks.choice("kind", kind, KINDS))
        if what is not None:
            if kind not in WHAT:
                raise ValueError(
                    f"what must be left out with kind {kind!r}, got {checks.shown(what)}"
                )
            options = {WHAT[kind]: what, **options}
        return draw(self, **options)
