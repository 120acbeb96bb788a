"""Plot of the energy balance."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

_ENTRIES = {
    "loads": ("work of forces", looks.GREEN),
    "impacts": ("impacts", looks.RED),
    "friction": ("friction", looks.ORANGE),
    "bounces": ("unresolved", looks.PURPLE),
}
NOTHING = 1e-6  # of the greatest energy: an entry that stays below cannot be seen


@known
def energy(solution, *, panel: str | None = None, ax=None, figsize=None, style="carom"):
    """Draw the energies, the entries of the ledger, and the error of the energy balance.

    Upper axes: kinetic, potential and total energy; dotted, the entries of the ledger, which are sums since the
    start (work of forces and dampers; impacts; friction of persistent contacts; dropped bounces). Entries below
    a millionth of the greatest energy are left out. Lower axes, logarithmic: the magnitude of
    `Ledger.residual`, i.e. the total energy minus its initial value minus all entries, which is the error of
    the time integration.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        The run.
    panel : {"energy", "error"}, optional
        Draw only these axes. Default: all; the first if `ax` is a single Axes.
    ax : Axes or sequence of 2 Axes, optional
        Axes to draw into. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    ndarray of 2 Axes
        Upper and lower axes; of one panel its Axes.
    """
    figure.is_bodies(solution)
    t, ledger = solution.t, solution.ledger
    only, look = figure.only(panel, ("energy", "error"), ax), figure.Canvas(ax, figsize, style)
    layout = {"nrows": 2, "sharex": True, "height_ratios": (2.2, 1)}
    with figure.drawing(look, 2, (looks.COLUMN, 3.2), only=only, **layout) as axes:
        above, below = axes
        above.plot(t, ledger.kinetic, color=looks.BLUE, label="kinetic")
        above.plot(t, ledger.potential, color=looks.SKY, label="potential")
        above.plot(t, ledger.kinetic + ledger.potential, color=looks.BLACK, label="sum")
        greatest = np.max(np.abs([ledger.kinetic, ledger.potential]))
        for name, (label, colour) in _ENTRIES.items():
            if np.max(np.abs(getattr(ledger, name))) > NOTHING * greatest:
                above.plot(t, getattr(ledger, name), ":", color=colour, lw=1.5, label=label)
        above.set(ylabel="energy [J]", xlim=(t[0], t[-1]))
        above.legend(
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            ncols=3,
            columnspacing=0.7,
            handlelength=1.3,
        )
        error = np.abs(ledger.residual)
        below.plot(t, np.where(error > 0.0, error, np.nan), color=looks.BLACK, lw=0.8)
        below.set(xlabel="time [s]", ylabel="error of the\nsum [J]", xlim=(t[0], t[-1]))
        if np.any(error > 0.0):
            below.set_yscale("log")
    return axes if only is None else axes[only]
