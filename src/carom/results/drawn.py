"""The method of a solution that draws it."""

from __future__ import annotations

KINDS = (
    "overview", "trajectory", "phase", "energy", "impacts", "impact_inside", "hodograph", "contacts",
    "constraint_errors",
)  # fmt: skip


class Drawn:
    """Drawing a solution; needs ``carom[plot]``."""

    def plot(self, kind: str = "overview", **options):
        """Draw one of the plots of `carom.plots` and return its axes.

        Parameters
        ----------
        kind : str
            "overview" (default), "trajectory", "phase", "energy", "impacts", "impact_inside", "hodograph",
            "contacts" or "constraint_errors": the function of `carom.plots` of this name.
        **options
            Its arguments, among them ``ax`` to draw into axes that there are.

        Raises
        ------
        ImportError
            Without matplotlib.
        ValueError
            If `kind` is another word, or there is nothing of the kind to draw.
        """
        from carom import checks
        from carom.visual import plots

        return getattr(plots, checks.choice("kind", kind, KINDS))(self, **options)
