"""Overview plot of a run."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks
from carom.visual.plots.balance import energy
from carom.visual.plots.errors import constraint_errors
from carom.visual.plots.paths import trajectory
from carom.visual.plots.timeline import contacts, touching

CONTACTS_DRAWN = 8  # contacts to draw
LETTERS = 20  # of the name of a contact


@known
def overview(solution, *, figsize=None, style="carom") -> dict:
    """Draw an overview of a run: motion, energies, contacts, and errors of joints.

    The motion of a `GeneralizedSystem` is drawn as coordinates over time. Contacts are drawn if some touch, and
    constraint errors if there are joints or constraints.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        The run.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    dict of str to Axes
        "motion", "energy", "error" (of the energy) and, if drawn, "contacts" and "constraints".
    """
    whole = figure.is_bodies(solution)
    scene = solution.scene if whole else None
    touched = len(solution.impacts) > 0 or len(solution.events.time) > 0
    kept = bool(scene.joints or scene.constraints) if scene else np.any(solution.constraint_errors)
    rows = [["motion", "energy"], ["motion", "error"]]
    heights = [2.3, 1.1]  # [in]
    below = [name for name, there in (("contacts", touched), ("constraints", kept)) if there]
    if below:
        rows.append([below[0], below[-1]])
        heights.append(1.2 if not touched else 0.8 + 0.16 * min(CONTACTS_DRAWN, touching(solution)))
    figure.pyplot()
    with looks.style(style):
        size = (looks.PAGE, sum(heights))
        new = figure.Canvas(None, figsize, style).new(size, layout="constrained")
        axes = new.subplot_mosaic(rows, height_ratios=heights)
        if whole:
            trajectory(solution, ax=axes["motion"], style=style)
        else:
            _coordinates(solution, axes["motion"])
        energy(solution, ax=[axes["energy"], axes["error"]], style=style)
        axes["energy"].tick_params(labelbottom=False)
        if "contacts" in axes:
            contacts(solution, most=CONTACTS_DRAWN, ax=axes["contacts"], style=style)
            labels = [_short(label.get_text()) for label in axes["contacts"].get_yticklabels()]
            axes["contacts"].set_yticks(axes["contacts"].get_yticks(), labels)
        if "constraints" in axes:
            constraint_errors(solution, ax=axes["constraints"], style=style)
    return axes


def _short(name: str) -> str:
    """Return a name without its middle if it is long: the labels of one plot narrow all others."""
    return (
        name if len(name) <= LETTERS else f"{name[: LETTERS // 2]}\u2026{name[-LETTERS // 2 + 1 :]}"
    )


def _coordinates(solution, axes) -> None:
    """Draw the coordinates over time."""
    t = figure.with_impacts(solution)
    q, _ = solution.evaluate(t)
    for k, (colour, line) in zip(range(q.shape[1]), figure.colours()):
        axes.plot(t, q[:, k], line, color=colour, lw=1.0, label=f"$q_{{{k}}}$")
    axes.set(xlabel="time [s]", ylabel="coordinates", xlim=t[[0, -1]])
    figure.legend(axes, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=6)
