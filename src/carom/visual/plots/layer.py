"""Plot of one impact inside its boundary layer."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure, style

LAYER_KNOTS = 64  # steps of the spline: so many that a force, given at its knots, is a curve


@known
def impact_inside(solution, k: int = 0, *, steps: int = LAYER_KNOTS, ax=None):
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
    ax : sequence of 3 Axes, optional
        Axes to draw into. Default: a new figure.

    Returns
    -------
    ndarray of 3 Axes
        Axes of the normal coordinate, the velocities and the forces.

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
    with figure.drawing(ax, 3, (style.COLUMN, 4.2)) as axes:
        gap, speed, force = axes
        gap.plot(time * t, length * x, color=style.BLUE)
        gap.axhline(length * history.width, color=style.BLACK, lw=0.5, ls=":")
        gap.set(ylabel=f"normal coordinate\n[{unit}]", ylim=(0, 1.1 * length * history.width))
        names, looks = ("n", "t1", "t2"), (style.BLUE, style.RED, style.GREEN)
        forces = (history.normal_force, *history.friction_force.T)
        last = int(np.argmin(history.x))  # knot at the end of compression
        times = np.insert(history.t, last, history.t[last])
        strong, newton = figure.readable(float(np.max(np.abs(history.normal_force))), "N")
        slides = [0, *(i for i in (1, 2) if np.any(u[:, i]) or np.any(forces[i]))]
        for i in slides:
            speed.plot(time * t, u[:, i], color=looks[i], label=f"$u_{{{names[i]}}}$")
            force.plot(
                time * times,
                strong * _jump(forces[i], history, last),
                color=looks[i],
                label=f"$F_{{{names[i]}}}$",
            )
        force.set(ylabel=f"force [{newton}]", xlabel=f"time in the layer [{short}]")
        force.set_xlim(0, time * history.duration)
        speed.set(ylabel="velocity [m/s]")
        turn = time * t[np.argmin(x)]
        for one in axes:
            one.axvline(turn, color=style.GREY, lw=0.6, ls=":")
        for one in (speed, force):
            one.axhline(0.0, color=style.BLACK, lw=0.4)
            one.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes


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
