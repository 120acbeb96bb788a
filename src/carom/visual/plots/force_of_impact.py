"""Plot of the force of one impact in time."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.impact import Impact, ImpactForce, ImpactForces
from carom.impact.multiple.api import CornerImpact
from carom.scene.stiffness import Stiffness
from carom.visual.plots import figure
from carom.visual.plots import style as looks


@known
def impact_force(
    solution,
    k: int = 0,
    *,
    stiffness=None,
    panel: str | None = None,
    ax=None,
    figsize=None,
    style="carom",
):
    """Draw the force of one impact over time, by the stiffness of its contact, and the depth.

    The dotted line is the end of compression. What is left of the depth at the end is the dent of an impact
    that does not give all back. Of contacts that strike together all normal forces are drawn, with their
    numbers; of a run those of `Solution.impacts`.

    Parameters
    ----------
    solution : Solution, Impact, CornerImpact, carom.impact.ImpactForce or carom.impact.ImpactForces
        A run, a single impact (`carom.resolve_impact`), one of several contacts (`carom.resolve_impacts`), or
        the force of one.
    k : int
        Index of the impact of a run; negative indices count from the end. Default 0.
    stiffness : Stiffness or Hertz, optional
        Stiffness of the contact. Default: that which was stated.
    panel : {"force", "depth"}, optional
        Draw only these axes. Default: both; the first if `ax` is a single Axes.
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
        Axes of the forces and of the depth; of one panel its Axes.

    Raises
    ------
    TypeError, ValueError
        If there is no impact k, no stiffness, or the force of the impact is not known (`ImpactRecord.force`).
    """
    force = _force(solution, k, stiffness)
    time, short = figure.readable(force.duration, "s")
    strong, newton = figure.readable(float(np.max(force.peak_force)), "N")
    length, unit = figure.readable(float(force.depth.max()), "m")
    only = figure.only(panel, ("force", "depth"), ax)
    with figure.drawing(
        figure.Canvas(ax, figsize, style), 2, (looks.COLUMN, 3.2), only=only
    ) as axes:
        upper, lower = axes
        for values, depth, colour, label in _curves(force):
            upper.plot(time * force.t, strong * values, color=colour, label=label)
            if depth is not None:
                lower.plot(time * force.t, length * depth, color=colour)
        upper.axhline(0.0, color=looks.BLACK, lw=0.4)
        upper.set(ylabel=f"force [{newton}]")
        upper.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        lower.set(
            ylabel=f"depth [{unit}]", xlabel=f"time [{short}]", xlim=(0, time * force.duration)
        )
        if isinstance(force, ImpactForce):
            for one in axes:
                one.axvline(time * force.compression_time, color=looks.GREY, lw=0.6, ls=":")
    return axes if only is None else axes[only]


def _curves(force) -> list[tuple]:
    """Return force, depth (None where it is drawn already), colour and label of each curve."""
    hues = (looks.BLUE, looks.RED, looks.GREEN, looks.ORANGE, looks.SKY, looks.PURPLE, looks.BLACK)
    if isinstance(force, ImpactForces):
        parts = list(zip(force.normal_force.T, force.depth.T))
        numbers = force.impacts or range(len(parts))  # of a run those of its table
        return [
            (N, d, hues[i % len(hues)], f"$F_{{{number}}}$")
            for i, (number, (N, d)) in enumerate(zip(numbers, parts))
        ]
    parts = (force.normal_force, *force.friction_force.T)
    drawn = [(parts[0], force.depth, hues[0], "$F_{n}$")]
    for i, name in ((1, "t1"), (2, "t2")):
        if abs(parts[i]).max() > 0.0:
            drawn.append((parts[i], None, hues[i], f"$F_{{{name}}}$"))
    return drawn


def _force(solution, k, stiffness):
    """Return the force of a single impact, of one of several contacts, or of impact k of a run."""
    from carom.results.stiff_impacts import stiffness_of

    if isinstance(solution, (ImpactForce, ImpactForces)):
        return solution
    if isinstance(solution, (Impact, CornerImpact)):
        return solution.force(stiffness)
    figure.need_bodies(solution, "impact_force")
    figure.impact(solution, k)
    record, rows = solution.impacts[int(k)], solution._written.impact
    if record.together > 1:
        return solution.impact_forces(int(k), stiffness)
    if stiffness is None:
        place = range(len(rows))[int(k)]
        own = rows[place : place + 1]
        stated = stiffness_of(solution, int(record.contact), own)
        stiffness = None if stated is None else Stiffness(float(np.ravel(stated[0])[0]), stated[1])
    return record.force(stiffness)
