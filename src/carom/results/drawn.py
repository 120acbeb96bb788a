"""The method of a solution that draws it."""

from __future__ import annotations

KINDS = (
    "overview", "trajectory", "phase", "energy", "impacts", "impact_inside", "hodograph", "contacts",
    "constraint_errors",
)  # fmt: skip

#: which argument of a plot says of what it is
WHAT = {
    "trajectory": "bodies", "phase": "of", "impacts": "contacts", "contacts": "contacts", "impact_inside": "k",
    "hodograph": "k",
}  # fmt: skip


class Drawn:
    """Drawing a solution; needs ``carom[plot]``."""

    def plot(self, kind: str = "overview", what=None, **options):
        """Draw one of the plots of `carom.plots` and return its axes.

        Parameters
        ----------
        kind : str
            "overview" (default), "trajectory", "phase", "energy", "impacts", "impact_inside", "hodograph",
            "contacts" or "constraint_errors": the function of `carom.plots` of this name.
        what : optional
            Of what: bodies by name for "trajectory", a body, coordinate or joint for "phase", contacts by name
            for "impacts" and "contacts", the number of an impact for "impact_inside" and "hodograph".
        **options
            Other arguments of that function, among them ``ax`` to draw into axes that there are.

        Raises
        ------
        ImportError
            Without matplotlib.
        ValueError
            If `kind` is another word, or there is nothing of the kind to draw; for `what` of other kinds.
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
