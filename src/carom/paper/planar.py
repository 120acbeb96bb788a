"""Figs. 4a-d, 5a, 5b: the die that turns in a plane (section 4.2), and its first impact."""

from __future__ import annotations

import numpy as np

from carom.paper.figure import FigureOfPaper
from carom.paper.references import die_after
from carom.paper.runs import EDGE, FRICTIONS, after_first_impact, die_run, with_jumps
from carom.visual.plots import style

COLOURS = dict(zip(FRICTIONS, (style.BLUE, style.RED)))
END = 0.42  # [s]


def _squares(axes, run, times, colour):
    """Draw the outline of the die at some times."""
    x, Q, _, _ = run.evaluate(times)
    angle = 2.0 * np.arctan2(Q[:, 0, 2], Q[:, 0, 0])  # about y
    corner = 0.5 * EDGE * np.array([[-1, 1, 1, -1, -1], [-1, -1, 1, 1, -1]])
    for centre, a in zip(x[:, 0], angle):
        across = np.cos(a) * corner[0] + np.sin(a) * corner[1]
        up = -np.sin(a) * corner[0] + np.cos(a) * corner[1]
        axes.plot(centre[0] + across, centre[2] + up, color=colour, lw=0.7)


def _ground(axes):
    axes.axhspan(-0.012, 0.0, color="#e6e6e6", lw=0)
    axes.axhline(0.0, color=style.BLACK, lw=0.6)


def _trajectory():
    """Draw the whole throw on the left, and the bounces for each friction coefficient on the right."""
    figure, axes = style.mosaic(style.PAGE, 4.1, [["all", "0"], ["all", "1"]], (1, 1.4))
    whole = axes["all"]
    _ground(whole)
    for k, mu in enumerate(FRICTIONS):
        run, part = die_run(mu, "planar"), axes[str(k)]
        first = run.impacts.time[0]
        _, x, *_ = with_jumps(run, END)
        impacts = run.impacts.time[run.impacts.time < END]
        whole.plot(x[:, 0], x[:, 2], color=COLOURS[mu], label=rf"$\mu = {mu:.2f}$")
        _ground(part)
        _squares(part, run, np.linspace(first, END, 12)[1:], "#b8b8b8")
        _squares(part, run, impacts, style.BLACK)
        part.plot(x[:, 0], x[:, 2], color=COLOURS[mu])
        part.plot(*run.evaluate(impacts)[0][:, 0, [0, 2]].T, "o", color=COLOURS[mu], ms=3)
        part.set(aspect="equal", xlim=(0.058, 0.186), ylim=(-0.006, 0.066), ylabel="$z$ [m]")
        part.set_title(rf"$\mu = {mu:.2f}$, $t \leq {END:g}$ s", loc="left")
    _squares(whole, run, np.arange(0.0, first, 0.03), style.GREY)
    _squares(whole, run, [first], style.BLACK)
    whole.set(aspect="equal", xlim=(-0.02, 0.19), ylim=(-0.012, 0.32))
    whole.set(xlabel="$x$ [m]", ylabel="$z$ [m]")
    whole.legend(loc="upper right")
    axes["1"].set_xlabel("$x$ [m]")
    return figure


def _history(column, component, label):
    figure, axes = style.new(style.COLUMN, 2.2)
    for mu in FRICTIONS:
        t, *state = with_jumps(die_run(mu, "planar"), END)
        axes.plot(t, state[column][:, component], color=COLOURS[mu], label=rf"$\mu = {mu:.2f}$")
    axes.axhline(0.0, color=style.BLACK, lw=0.4)
    axes.set(xlabel="time $t$ [s]", ylabel=label, xlim=(0, END))
    axes.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return figure


def _inside(upper, lower, labels):
    """Draw two quantities of the first impact against time, one above the other."""
    figure, both = style.new(style.COLUMN, 3.6, 2, 1, sharex=True)
    for mu in FRICTIONS:
        history = die_run(mu, "planar").impact_history(0)
        for axes, values in zip(both, (upper, lower)):
            for name, line, t, value in values(mu, history):
                axes.plot(t, value, line, color=COLOURS[mu], label=name)
    turn = 1e9 * die_run(FRICTIONS[0], "planar").impact_history(0).t[1]
    for axes, label in zip(both, labels):
        axes.set_ylabel(label)
        axes.axvline(turn, color=style.BLACK, lw=0.4, ls=":")
    figure.align_ylabels(both)
    both[1].set_xlabel("time in the layer $t$ [ns]")
    both[0].set_xlim(0, 1e9 * history.duration)
    return figure, both


def _path(history, n=300):
    t = np.linspace(0.0, history.duration, n)
    x, u = history.evaluate(t)
    return t, x, u


def _normal():
    def gap(mu, history):
        t, x, _ = _path(history)
        line = "-" if mu == FRICTIONS[0] else "--"
        yield rf"$\mu = {mu:.2f}$", line, 1e9 * t, 1e9 * x

    def rate(mu, history):
        t, _, u = _path(history)
        yield None, "-" if mu == FRICTIONS[0] else "--", 1e9 * t, u[:, 0]

    labels = ("coordinate $x^1$ [nm]", "velocity $u_n$ [m/s]")
    figure, both = _inside(gap, rate, labels)
    both[0].legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    both[1].axhline(0.0, color=style.BLACK, lw=0.4)
    return figure


def _tangential():
    def slip(mu, history):
        t, _, u = _path(history)
        yield rf"$\mu = {mu:.2f}$", "-", 1e9 * t, u[:, 1]

    def force(mu, history):
        at = np.repeat(1e9 * history.t, 2)[1:-1]
        yield None, "-", at, np.repeat(history.normal_force[:-1], 2) * 1e-6
        yield None, "--", at, np.repeat(history.friction_force[:-1, 0], 2) * 1e-6

    figure, both = _inside(slip, force, ("slip velocity $u_{t}$ [m/s]", "force [MN]"))
    both[0].legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    both[1].axhline(0.0, color=style.BLACK, lw=0.4)
    both[1].plot([], [], "-", color=style.BLACK, label="normal force $N$")
    both[1].plot([], [], "--", color=style.BLACK, label="friction force $T$")
    both[1].legend(loc="upper right")
    return figure


def _after(mu: float) -> np.ndarray:
    return after_first_impact(die_run(mu, "planar"))


def _agreement() -> float:
    return max(float(np.max(np.abs(_after(mu) - die_after("planar", mu)))) for mu in FRICTIONS)


def _impacts(mu: float) -> str:
    times = die_run(mu, "planar").impacts.time
    return ", ".join(f"{t:.6f}" for t in times[times < END])


def _forces() -> str:
    return " and ".join(
        f"{die_run(mu, 'planar').impact_history(0).normal_force[0] * 1e-6:.3f} MN (mu = {mu:g})"
        for mu in FRICTIONS
    )


def _both(of, **more) -> dict:
    """Return a quantity for both friction coefficients."""
    low, high = map(of, FRICTIONS)
    return {"low": low, "high": high, **more}


FIGURES = (
    FigureOfPaper("fig4a", _trajectory, lambda: _both(_impacts)),
    FigureOfPaper(
        "fig4b", lambda: _history(2, 0, "$v_x$ [m/s]"), lambda: _both(lambda mu: _after(mu)[0])
    ),
    FigureOfPaper(
        "fig4c", lambda: _history(2, 2, "$v_z$ [m/s]"), lambda: _both(lambda mu: _after(mu)[2])
    ),
    FigureOfPaper(
        "fig4d", lambda: _history(3, 1, r"$\omega_y$ [rad/s]"),
        lambda: _both(lambda mu: _after(mu)[4], agreement=_agreement()),
    ),
    FigureOfPaper("fig5a", _normal),
    FigureOfPaper("fig5b", _tangential, lambda: {"forces": _forces()}),
)  # fmt: skip
