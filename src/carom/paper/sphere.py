"""Figs. 2a, 2b: the bouncing sphere of section 4.1."""

from __future__ import annotations

import numpy as np

from carom.paper.figure import FigureOfPaper
from carom.paper.references import Bounce
from carom.paper.runs import sphere_run, with_jumps
from carom.visual.plots import style

CASES = ((1.0, style.BLUE), (0.8, style.RED))
_MARKS = np.linspace(0.0, 3.0, 61)


def _draw(column: int, label: str):
    figure, axes = style.new(style.COLUMN, 2.4)
    for e, colour in CASES:
        t, x, _, v, _ = with_jumps(sphere_run(e))
        computed = (x[:, 2] - 0.1, v[:, 2])[column]
        axes.plot(t, computed, color=colour, label=f"$e = {e:g}$")
        axes.plot(_MARKS, Bounce(e).motion(_MARKS)[column], "o", color=colour, mfc="white",
                  mew=0.7, ms=2.8)  # fmt: skip
    axes.plot([], [], "o", color=style.BLACK, mfc="white", mew=0.7, ms=2.8, label="exact")
    axes.set(xlabel="time $t$ [s]", ylabel=label, xlim=(0, 3))
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return figure


def _height():
    figure = _draw(0, "gap [m]")
    figure.axes[0].set_ylim(0, None)
    return figure


def _velocity():
    return _draw(1, "velocity [m/s]")


def _errors(column: int) -> float:
    """Return the greatest error of the computed motion at times without an impact."""
    worst = 0.0
    for e, _ in CASES:
        run = sphere_run(e)
        t = run.t[run.t < min(3.0, 0.98 * Bounce(e).rest)]
        x, _, v, _ = run.evaluate(t)
        value = (x[:, 0, 2] - 0.1, v[:, 0, 2])[column]
        worst = max(worst, float(np.max(np.abs(value - Bounce(e).motion(t)[column]))))
    return worst


FIGURES = (
    FigureOfPaper("fig2a", _height, lambda: {"error": _errors(0), "rest": Bounce(0.8).rest}),
    FigureOfPaper("fig2b", _velocity, lambda: {"error": _errors(1)}),
)
