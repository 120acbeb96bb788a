"""How well joints and constraints are kept."""

from __future__ import annotations

import numpy as np

from carom.visual.plots import figure, style


def constraint_errors(solution, *, ax=None):
    """Draw the greatest error of joints and constraints at each saved time, of positions and of velocities.

    Logarithmic; errors that are exactly zero do not show.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        With joints or constraints.
    ax : Axes, optional
        To draw into. Default: a new figure.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If there is nothing to be kept.
    """
    whole = figure.is_bodies(solution)
    if whole and not (solution.scene.joints or solution.scene.constraints):
        raise ValueError(f"the scene must have a joint or a constraint, got {solution!r}")
    position, velocity = solution.constraint_errors
    if not whole and not np.any(position) and not np.any(velocity):
        raise ValueError(f"the system must have constraints, got {solution!r}")
    units = (" [m]", " [m/s]") if whole else ("", "")
    with figure.drawing(ax, 1, (style.COLUMN, 2.0)) as axes:
        lines = (("positions", position, style.BLUE, "-"), ("velocities", velocity, style.RED, "-"))
        for (name, error, colour, line), unit in zip(lines, units):
            shown = np.where(error > 0.0, error, np.nan)
            axes.plot(solution.t, shown, line, color=colour, lw=0.9, label=f"of {name}{unit}")
        axes.set(xlabel="time [s]", ylabel="error", xlim=solution.t[[0, -1]])
        if np.any(position > 0.0) or np.any(velocity > 0.0):
            axes.set_yscale("log")
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    return axes
