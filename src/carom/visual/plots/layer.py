"""Plot of one impact inside its boundary layer."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

LAYER_KNOTS = 64  # steps of the spline: so many that a force, given at its knots, is a curve


@known
def impact_inside(
    solution,
    k: int = 0,
    *,
    steps: int = LAYER_KNOTS,
    panel: str | None = None,
    ax=None,
    figsize=None,
    style="carom",
):
    """Draw one impact inside its boundary layer: normal coordinate, velocities and forces.

    There are three axes over the time since entry. The normal velocity is that of the flat coordinate: it is
    minus the approach speed at entry, and the rebound speed at exit. It is zero at the end of compression
    (dotted line).

    Parameters
    ----------
    solution : Solution or LayerHistory
        A run, or a single impact (`carom.impact_layer`).
    k : int
        Index of the impact; negative indices count from the end. Default 0.
    steps : int
        Number of spline steps through the layer. Default 64; a `LayerHistory` has its own.
    panel : {"position", "velocity", "force"}, optional
        Draw only these axes. Default: all; the first if `ax` is a single Axes.
    ax : Axes or sequence of 3 Axes, optional
        Axes to draw into. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    ndarray of 3 Axes
        Axes of the normal coordinate, the velocities and the forces; of one panel its Axes.

    Raises
    ------
    ValueError
        If there is no impact k, or it is part of a multiple impact and has no boundary layer of its own.
    """
    from carom.impact.history import LayerHistory

    history = solution if isinstance(solution, LayerHistory) else _history(solution, k, steps)
    t = np.linspace(0.0, history.duration, 600)
    x, u = history.evaluate(t)
    time, short = figure.readable(history.duration, "s")
    length, unit = figure.readable(history.width, "m")
    only = figure.only(panel, ("position", "velocity", "force"), ax)
    look = figure.Canvas(ax, figsize, style)
    with figure.drawing(look, 3, (looks.COLUMN, 4.2), only=only) as axes:
        gap, speed, force = axes
        gap.plot(time * t, length * x, color=looks.BLUE)
        gap.axhline(length * history.width, color=looks.BLACK, lw=0.5, ls=":")
        gap.set(ylabel=f"normal coordinate\n[{unit}]", ylim=(0, 1.1 * length * history.width))
        names, hues = ("n", "t1", "t2"), (looks.BLUE, looks.RED, looks.GREEN)
        forces = (history.normal_force, *history.friction_force.T)
        last = int(np.argmin(history.x))  # knot at the end of compression
        times = np.insert(history.t, last, history.t[last])
        strong, newton = figure.readable(float(np.max(np.abs(history.normal_force))), "N")
        slides = [0, *(i for i in (1, 2) if np.any(u[:, i]) or np.any(forces[i]))]
        for i in slides:
            speed.plot(time * t, u[:, i], color=hues[i], label=f"$u_{{{names[i]}}}$")
            force.plot(
                time * times,
                strong * _jump(forces[i], history, last),
                color=hues[i],
                label=f"$F_{{{names[i]}}}$",
            )
        force.set(ylabel=f"force [{newton}]", xlabel=f"time in the layer [{short}]")
        force.set_xlim(0, time * history.duration)
        speed.set(ylabel="velocity [m/s]")
        turn = time * t[np.argmin(x)]
        for one in axes:
            one.axvline(turn, color=looks.GREY, lw=0.6, ls=":")
        for one in (speed, force):
            one.axhline(0.0, color=looks.BLACK, lw=0.4)
            one.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes if only is None else axes[only]


def _jump(force, history, last: int) -> np.ndarray:
    """Return forces at the knots, and twice where compression ends, at which they jump.

    A knot has the force just after it; the force just before it is extrapolated from the two knots before.
    """
    if last < 2:
        return np.insert(force, last, force[last - 1])
    t = history.t[last - 2 : last + 1]
    slope = (force[last - 1] - force[last - 2]) / (t[1] - t[0])
    return np.insert(force, last, force[last - 1] + slope * (t[2] - t[1]))


def _history(solution, k, steps):
    """Return the course of impact k of a run."""
    figure.need_bodies(solution, "impact_inside")
    figure.impact(solution, k)
    return solution.impact_history(k, steps=steps)
