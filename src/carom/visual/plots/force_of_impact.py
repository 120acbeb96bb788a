"""Plot of the force of one impact in time."""

from __future__ import annotations

from carom.arguments import known
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
    that does not give all back.

    Parameters
    ----------
    solution : Solution, Impact or carom.impact.ImpactForce
        A run, a single impact (`carom.resolve_impact`), or its force.
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
    strong, newton = figure.readable(force.peak_force, "N")
    length, unit = figure.readable(float(force.depth.max()), "m")
    only = figure.only(panel, ("force", "depth"), ax)
    with figure.drawing(
        figure.Canvas(ax, figsize, style), 2, (looks.COLUMN, 3.2), only=only
    ) as axes:
        upper, lower = axes
        names, hues = ("n", "t1", "t2"), (looks.BLUE, looks.RED, looks.GREEN)
        parts = (force.normal_force, *force.friction_force.T)
        for i in (0, *(i for i in (1, 2) if abs(parts[i]).max() > 0.0)):
            upper.plot(
                time * force.t, strong * parts[i], color=hues[i], label=f"$F_{{{names[i]}}}$"
            )
        upper.axhline(0.0, color=looks.BLACK, lw=0.4)
        upper.set(ylabel=f"force [{newton}]")
        upper.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        lower.plot(time * force.t, length * force.depth, color=looks.BLUE)
        lower.set(
            ylabel=f"depth [{unit}]", xlabel=f"time [{short}]", xlim=(0, time * force.duration)
        )
        for one in axes:
            one.axvline(time * force.compression_time, color=looks.GREY, lw=0.6, ls=":")
    return axes if only is None else axes[only]


def _force(solution, k, stiffness):
    """Return the force of a single impact, or of impact k of a run."""
    from carom.impact import Impact, ImpactForce
    from carom.results.stiff_impacts import stiffness_of

    if isinstance(solution, ImpactForce):
        return solution
    if isinstance(solution, Impact):
        return solution.force(stiffness)
    figure.need_bodies(solution, "impact_force")
    figure.impact(solution, k)
    record = solution.impacts[int(k)]
    return record.force(
        stiffness_of(solution, int(record.contact)) if stiffness is None else stiffness
    )
