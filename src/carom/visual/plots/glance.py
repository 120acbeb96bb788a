"""A whole run at a glance."""

from __future__ import annotations

import numpy as np

from carom.visual.plots import figure, style
from carom.visual.plots.balance import energy
from carom.visual.plots.errors import constraint_errors
from carom.visual.plots.paths import trajectory
from carom.visual.plots.timeline import contacts, touching

ROWS = 8  # contacts to draw


def overview(solution) -> dict:
    """Draw a run at a glance: the motion, the energies, the contacts, and how well joints are kept.

    Of a system in coordinates the motion is that of the coordinates over time. Contacts and constraints are
    there if the system has some (contacts: that touch).

    Parameters
    ----------
    solution : Solution or GeneralizedSolution

    Returns
    -------
    dict of str to Axes
        "motion", "energy", "error" (of the energy) and, where there are some, "contacts" and "constraints".
    """
    whole = figure.is_bodies(solution)
    held = solution.scene if whole else None
    touched = len(solution.impacts) > 0 or len(solution.events.time) > 0
    kept = bool(held.joints or held.constraints) if held else np.any(solution.constraint_errors)
    rows = [["motion", "energy"], ["motion", "error"]]
    heights = [2.3, 1.1]  # [in]
    below = [name for name, there in (("contacts", touched), ("constraints", kept)) if there]
    if below:
        rows.append([below[0], below[-1]])
        heights.append(1.2 if not touched else 0.8 + 0.16 * min(ROWS, touching(solution)))
    with figure.drawing_mosaic(rows, (style.PAGE, sum(heights)), heights) as axes:
        if whole:
            trajectory(solution, ax=axes["motion"])
        else:
            _coordinates(solution, axes["motion"])
        energy(solution, ax=[axes["energy"], axes["error"]])
        axes["energy"].tick_params(labelbottom=False)
        if "contacts" in axes:
            contacts(solution, most=ROWS, ax=axes["contacts"])
        if "constraints" in axes:
            constraint_errors(solution, ax=axes["constraints"])
    return axes


def _coordinates(solution, axes) -> None:
    """Draw the coordinates over time."""
    t = figure.with_impacts(solution)
    q, _ = solution.evaluate(t)
    for k, (colour, line) in zip(range(q.shape[1]), figure.colours()):
        axes.plot(t, q[:, k], line, color=colour, lw=1.0, label=f"$q_{{{k}}}$")
    axes.set(xlabel="time [s]", ylabel="coordinates", xlim=t[[0, -1]])
    figure.legend(axes, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=6)
