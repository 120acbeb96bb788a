"""Plot of the energy balance."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure, style

_ENTRIES = {
    "loads": ("work of forces", style.GREEN),
    "impacts": ("impacts", style.RED),
    "friction": ("friction", style.ORANGE),
    "bounces": ("unresolved", style.PURPLE),
}
NOTHING = 1e-6  # of the greatest energy: an entry that stays below cannot be seen


@known
def energy(solution, *, ax=None):
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
    ax : sequence of 2 Axes, optional
        Axes to draw into. Default: a new figure.

    Returns
    -------
    ndarray of 2 Axes
        Upper and lower axes.
    """
    figure.is_bodies(solution)
    t, ledger = solution.t, solution.ledger
    with figure.drawing(
        ax, 2, (style.COLUMN, 3.2), nrows=2, sharex=True, height_ratios=(2.2, 1)
    ) as axes:
        above, below = axes
        above.plot(t, ledger.kinetic, color=style.BLUE, label="kinetic")
        above.plot(t, ledger.potential, color=style.SKY, label="potential")
        above.plot(t, ledger.kinetic + ledger.potential, color=style.BLACK, label="sum")
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
        below.plot(t, np.where(error > 0.0, error, np.nan), color=style.BLACK, lw=0.8)
        below.set(xlabel="time [s]", ylabel="error of the\nsum [J]", xlim=(t[0], t[-1]))
        if np.any(error > 0.0):
            below.set_yscale("log")
    return axes
