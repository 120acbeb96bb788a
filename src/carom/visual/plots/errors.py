"""Plot of the errors of joints and constraints."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

ORDER = ("m", "rad", "")  # of the units


@known
def constraint_errors(solution, *, ax=None, figsize=None, style="carom"):
    """Draw the greatest errors of position and velocity of joints and constraints over time.

    Lengths and angles have separate curves. The axis is logarithmic; errors of exactly zero are not shown.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        A run with joints or constraints.
    ax : Axes, optional
        Axes to draw into. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ValueError
        If there are no joints and no constraints.
    """
    whole = figure.is_bodies(solution)
    if whole and not (solution.scene.joints or solution.scene.constraints):
        raise ValueError(f"the scene must have a joint or a constraint, got {solution!r}")
    position, velocity = solution.constraint_errors
    if not whole and not np.any(position) and not np.any(velocity):
        raise ValueError(f"the system must have constraints, got {solution!r}")
    units = solution.constraint_rows.unit if whole else np.array([""])
    with figure.drawing(figure.Canvas(ax, figsize, style), 1, (looks.COLUMN, 2.0)) as axes:
        for unit, dashes in zip(sorted(set(units.tolist()), key=ORDER.index), ("-", "--", ":")):
            for of, error, colour, end in (
                ("position", position, looks.BLUE, ""),
                ("velocity", velocity, looks.RED, "/s"),
            ):
                greatest = error.reshape(len(solution.t), -1)[:, units == unit].max(axis=1)
                shown = np.where(greatest > 0.0, greatest, np.nan)
                label = f"{of} [{unit}{end}]" if unit else of
                axes.plot(solution.t, shown, dashes, color=colour, lw=0.9, label=label)
        axes.set(xlabel="time [s]", ylabel="error", xlim=solution.t[[0, -1]])
        if np.any(position > 0.0) or np.any(velocity > 0.0):
            axes.set_yscale("log")
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, columnspacing=1.0)
    return axes
