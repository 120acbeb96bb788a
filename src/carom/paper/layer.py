"""Figs. 3a, 3b: the first impact of the sphere, resolved in time inside the boundary layer."""

from __future__ import annotations

from functools import cache

import numpy as np

from carom.baselines import first_completing_steps, hht_alpha_layer
from carom.impact.geometry import NormalMotion
from carom.paper.figure import FigureOfPaper
from carom.paper.runs import SPHERE_DELTA, sphere_run
from carom.visual.plots import style

_MORE = ((10, style.GREEN), (20, style.ORANGE), (40, style.PURPLE))


@cache
def first_impact():
    """Return the exact motion through the layer, and the two spline steps."""
    run = sphere_run(1.0)
    history = run.impact_history(0, steps=2)
    speed = -float(run.impacts[0].relative_velocity_before[0])
    return NormalMotion(speed, 1.0, history.width, SPHERE_DELTA), history


@cache
def hht(steps: int, alpha: float = 0.0):
    """Return the run of HHT-alpha through the same layer."""
    exact, _ = first_impact()
    return hht_alpha_layer(
        exact.approach_speed, exact.restitution, mass=1.0, width=exact.width,
        penetration=exact.penetration, steps=steps, alpha=alpha,
    )  # fmt: skip


@cache
def least_steps(alpha: float = 0.0) -> int | None:
    """Return the least number of steps with which HHT-alpha passes the layer."""
    exact, _ = first_impact()
    return first_completing_steps(
        exact.approach_speed, exact.restitution, penetration=exact.penetration, alpha=alpha
    )


def _draw(column: int):
    """Draw x [um] (column 0) or xdot [m/s] (column 1) against t [us]."""
    exact, spline = first_impact()
    figure, axes = style.new(style.COLUMN, 2.7)
    t = np.linspace(0.0, spline.duration, 600)
    scale = (1e6, 1.0)[column]
    true = (exact.x(t), exact.x_rate(t))[column]
    x, u = spline.evaluate(t)
    computed = (x, u[:, 0] * x / exact.width)[column]
    knots = (spline.x, spline.velocity[:, 0] * spline.x / exact.width)[column]
    axes.plot(1e6 * t, scale * true, color=style.GREY, lw=3.2, alpha=0.6, label="exact")
    axes.plot(1e6 * t, scale * computed, color=style.BLUE)
    axes.plot(1e6 * spline.t, scale * knots, "s", color=style.BLUE, ms=4.5, clip_on=False, zorder=5)
    axes.plot([], [], "s-", color=style.BLUE, ms=4.5, label="spline, 2 steps")
    first = least_steps()
    assert first is not None
    for steps, colour in ((first, style.RED), *_MORE):
        run = hht(steps)
        value = (run.x, run.velocity)[column]
        label = rf"HHT-$\alpha$, {steps} steps"
        axes.plot(1e6 * run.t, scale * value, "o--", color=colour, lw=0.8, ms=2.4, label=label)
    axes.set(xlabel=r"time in the layer $t$ [$\mu$s]", xlim=(0, 1.02e6 * t[-1]))
    axes.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.2)
    return figure, axes, exact


def _position():
    figure, axes, exact = _draw(0)
    axes.set(ylabel=r"normal coordinate $x^1$ [$\mu$m]", ylim=(0, 1.06e6 * exact.width))
    axes.axhline(1e6 * exact.width, color=style.BLACK, lw=0.5, ls=":")
    return figure


def _velocity():
    figure, axes, exact = _draw(1)
    reach = 1.35 * exact.approach_speed
    axes.set(ylabel=r"normal velocity $v^1$ [m/s]", ylim=(-reach, reach))
    return figure


def _spline_errors() -> tuple[float, float]:
    exact, spline = first_impact()
    t = np.linspace(0.0, spline.duration, 2001)
    x, u = spline.evaluate(t)
    return (
        float(np.max(np.abs(x - exact.x(t)))) / exact.width,
        float(np.max(np.abs(u[:, 0] - exact.normal_velocity(t)))) / exact.approach_speed,
    )


def _hht_errors() -> str:
    return ", ".join(f"{hht(n).velocity_error:.2g} ({n} steps)" for n in (8, 20, 40, 80, 320))


FIGURES = (
    FigureOfPaper(
        "fig3a", _position, lambda: {"error": _spline_errors()[0], "steps": least_steps()}
    ),
    FigureOfPaper("fig3b", _velocity, lambda: {"error": _spline_errors()[1], "hht": _hht_errors()}),
)
