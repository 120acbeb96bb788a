"""Figs. 6a, 6b: the die that turns in space (section 4.2)."""

from __future__ import annotations

import numpy as np

from carom import impact_layer
from carom.geometry import quaternion
from carom.impact.slip_directions import critical_friction, invariant_directions
from carom.paper.figure import FigureOfPaper
from carom.paper.references import die_after
from carom.paper.runs import (
    DIE_DELTA,
    DIE_E,
    EDGE,
    FRICTIONS,
    after_first_impact,
    die_run,
    with_jumps,
)
from carom.visual.plots import style

COLOURS = dict(zip(FRICTIONS, (style.BLUE, style.RED)))
END = 0.4  # [s]
_CORNERS = 0.5 * EDGE * np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T


def _outlines(axes, run, times, up, colour):
    """Draw the outline of the cube, seen along the axis that is not shown."""
    from scipy.spatial import ConvexHull

    x, Q, _, _ = run.evaluate(times)
    for centre, q in zip(x[:, 0], Q[:, 0]):
        points = (centre + _CORNERS @ quaternion.matrix(q).T)[:, [0, up]]
        hull = points[ConvexHull(points).vertices]
        hull = np.vstack([hull, hull[:1]])
        axes.plot(hull[:, 0], hull[:, 1], color=colour, lw=0.6)


def _trajectory():
    """Draw the whole throw on the left, and the bounces from the side and from above on the right."""
    layout, heights = [["all", "side"], ["all", "top"]], (0.076, 0.093)
    figure, axes = style.mosaic(style.PAGE, 4.1, layout, (1, 1.4), heights)
    whole, side, top = axes["all"], axes["side"], axes["top"]
    for mu in FRICTIONS:
        run = die_run(mu, "spatial")
        first = run.impacts.time[0]
        _, x, *_ = with_jumps(run, END)
        for part, up in ((whole, 2), (side, 2), (top, 1)):
            part.plot(x[:, 0], x[:, up], color=COLOURS[mu], label=rf"$\mu = {mu:.2f}$", zorder=4)
            if part is not whole:
                _outlines(part, run, [0.24, 0.32, END], up, COLOURS[mu])
    _outlines(whole, run, np.arange(0.0, first, 0.03), 2, style.GREY)
    for part, up in ((whole, 2), (side, 2), (top, 1)):
        _outlines(part, run, [first], up, style.BLACK)
        if up == 2:
            part.axhline(0.0, color=style.BLACK, lw=0.6)
            part.axhspan(-0.012, 0.0, color="#e6e6e6", lw=0)
    whole.set(aspect="equal", xlim=(-0.02, 0.23), ylim=(-0.012, 0.32))
    whole.set(xlabel="$x$ [m]", ylabel="$z$ [m]")
    whole.legend(loc="upper right")
    side.set(aspect="equal", xlim=(0.075, 0.235), ylim=(-0.006, 0.07), ylabel="$z$ [m]")
    side.set_title("from the side", loc="left")
    top.set(aspect="equal", xlim=(0.075, 0.235), ylim=(-0.073, 0.02))
    top.set(xlabel="$x$ [m]", ylabel="$y$ [m]")
    top.set_title("from above", loc="left")
    figure.align_ylabels([side, top])
    return figure


def _hodograph():
    layout = [["slip", "x"], ["slip", "y"], ["slip", "z"]]
    figure, parts = style.mosaic(style.PAGE, 3.1, layout, (1, 1.1))
    _slip(parts["slip"])
    for k, name in enumerate("xyz"):
        axes = parts[name]
        for mu in FRICTIONS:
            t, _, _, _, w = with_jumps(die_run(mu, "spatial"), END)
            axes.plot(t, w[:, k], color=COLOURS[mu], lw=1.0)
        axes.axhline(0, color=style.BLACK, lw=0.4)
        axes.set(xlim=(0, END), ylabel=rf"$\omega_{name}$ [rad/s]")
        axes.tick_params(labelbottom=name == "z")
    parts["z"].set_xlabel("time $t$ [s]")
    figure.align_ylabels([parts[name] for name in "xyz"])
    return figure


def _slip(axes):
    """Draw the path of the slip velocity in the first impact, and the invariant directions."""
    record = die_run(FRICTIONS[0], "spatial").impacts[0]
    W, u = record.inverse_mass, record.relative_velocity_before
    for mu, colour, turned in (
        (0.05, style.BLUE, (6, 2)), (0.2, style.RED, (-40, -15)), (0.6, style.GREEN, (-50, -11)),
    ):  # fmt: skip
        history = impact_layer(W, u, mu, DIE_E, penetration=DIE_DELTA, width=1e-6, steps=64)
        path = history.evaluate(np.linspace(0.0, history.duration, 400))[1]
        axes.plot(path[:, 1], path[:, 2], color=colour, lw=1.4, zorder=3)
        axes.plot(*path[-1, 1:], "o", color=colour, zorder=4)
        axes.annotate(rf"$\mu = {mu:.2f}$", path[-1, 1:], turned, textcoords="offset points",
                      color=colour)  # fmt: skip
        rays = invariant_directions(W, mu)
        for angle, grows in zip(rays.angle, rays.outgoing) if mu in FRICTIONS else ():
            x, y = 4.0 * np.cos(angle), 4.0 * np.sin(angle)
            axes.plot([0, x], [0, y], "--" if grows else ":", color=style.GREY, lw=0.8)
    axes.plot(*u[1:], "s", color=style.BLACK, zorder=5)
    axes.annotate("start", u[1:], (2, 6), textcoords="offset points")
    axes.axhline(0, color=style.BLACK, lw=0.4)
    axes.axvline(0, color=style.BLACK, lw=0.4)
    axes.set(xlabel="slip velocity $u_{t1}$ [m/s]", ylabel="slip velocity $u_{t2}$ [m/s]",
             aspect="equal", xlim=(-2.1, 0.7), ylim=(-0.5, 2.3))  # fmt: skip


def _second() -> str:
    return " and ".join(
        f"{1e3 * np.diff(die_run(mu, 'spatial').impacts.time[:2])[0]:.2f} ms (mu = {mu:g})"
        for mu in FRICTIONS
    )


def velocity_error(steps: int, friction: float) -> float:
    """Return the greatest error of v and w L/2 [m/s] after the first impact with so many spline steps."""
    run = die_run(friction, "spatial", layer_steps=steps)
    error = np.abs(after_first_impact(run) - die_after("spatial", friction))
    return float(np.max(error * np.repeat((1.0, 0.5 * EDGE), 3)))


def _error(steps: int) -> float:
    return max(velocity_error(steps, mu) for mu in FRICTIONS)


def _limit() -> float:
    return critical_friction(die_run(FRICTIONS[0], "spatial").impacts[0].inverse_mass)


def _numbers() -> dict:
    """Return the numbers of the text of Fig. 6b."""
    return {"limit": _limit(), "two": _error(2), "sixteen": _error(16), "fine": _error(64)}


FIGURES = (
    FigureOfPaper("fig6a", _trajectory, lambda: {"second": _second()}),
    FigureOfPaper("fig6b", _hodograph, _numbers),
)
