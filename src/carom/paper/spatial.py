"""Figs. 6a, 6b: the die that turns in space (section 4.2)."""

from __future__ import annotations

import numpy as np

from carom import impact_layer
from carom.geometry import quaternion
from carom.paper import style
from carom.paper.figure import FigureOfPaper
from carom.paper.references import die_after
from carom.paper.runs import DIE_DELTA, DIE_E, EDGE, FRICTIONS, die_run, with_jumps

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
    figure, (side, top) = style.new(style.PAGE, 3.3, 1, 2)
    for mu in FRICTIONS:
        run = die_run(mu, "spatial")
        t, x, *_ = with_jumps(run, END)
        for axes, up in ((side, 2), (top, 1)):
            axes.plot(x[:, 0], x[:, up], color=COLOURS[mu], label=rf"$\mu = {mu:.2f}$", zorder=4)
            shown = np.array([0.25, 0.3, 0.34, END])
            _outlines(axes, run, shown, up, COLOURS[mu])
    before = np.array([0.0, 0.06, 0.12, 0.16, run.impacts.time[0]])
    _outlines(side, run, before, 2, style.GREY)
    _outlines(top, run, before, 1, style.GREY)
    side.axhline(0.0, color=style.BLACK, lw=0.6)
    side.axhspan(-0.012, 0.0, color="#e6e6e6", lw=0)
    side.set(xlabel="$x$ [m]", ylabel="$z$ [m]", aspect="equal")
    top.set(xlabel="$x$ [m]", ylabel="$y$ [m]", aspect="equal")
    side.legend(loc="upper right")
    style.panel(side, "side view")
    style.panel(top, "from above")
    return figure


def stick_limit(W) -> float:
    """Return mu_crit = |W_tt^-1 W_tn|: friction above it can hold the corner."""
    return float(np.linalg.norm(np.linalg.solve(W[1:, 1:], W[1:, 0])))


def invariant_rays(W, friction) -> list[tuple[float, bool]]:
    """Return the directions of slip that do not turn: angle [rad], and whether slip grows along it.

    Roots of ``e x (W_tn - mu W_tt e)`` over the angle of e.
    """
    from scipy.optimize import brentq

    def rate(angle):
        e = np.array([np.cos(angle), np.sin(angle)])
        return W[1:, 0] - friction * W[1:, 1:] @ e, e

    def turn(angle):
        r, e = rate(angle)
        return e[0] * r[1] - e[1] * r[0]

    grid = np.linspace(0.0, 2.0 * np.pi, 721) + 1e-3
    found = []
    for a, b in zip(grid[:-1], grid[1:]):
        if turn(a) * turn(b) < 0.0:
            angle = float(brentq(turn, a, b, xtol=1e-14))
            r, e = rate(angle)
            found.append((angle, bool(r @ e > 0.0)))
    return found


def _hodograph():
    figure, (axes, spin) = style.new(style.PAGE, 2.9, 1, 2, width_ratios=(1, 1.25))
    record = die_run(FRICTIONS[0], "spatial").impacts[0]
    W, u = record.inverse_mass, record.relative_velocity_before
    reach = 2.5
    for mu, colour, turned in (
        (0.05, style.BLUE, (8, 6)), (0.2, style.RED, (-66, -4)), (0.6, style.GREEN, (6, -12)),
    ):  # fmt: skip
        history = impact_layer(W, u, mu, DIE_E, penetration=DIE_DELTA, width=1e-6, steps=64)
        t = np.linspace(0.0, history.duration, 400)
        path = history.evaluate(t)[1]
        axes.plot(path[:, 1], path[:, 2], color=colour, lw=1.4, zorder=3)
        axes.plot(*path[-1, 1:], "o", color=colour, zorder=4)
        axes.annotate(rf"$\mu = {mu:.2f}$", path[-1, 1:], turned, textcoords="offset points",
                      color=colour)  # fmt: skip
        if mu < 0.6:
            for angle, grows in invariant_rays(W, mu):
                ray = reach * np.array([np.cos(angle), np.sin(angle)])
                line = "--" if grows else ":"
                axes.plot([0, ray[0]], [0, ray[1]], line, color=colour, lw=0.7)
    axes.plot(*u[1:], "s", color=style.BLACK, zorder=5)
    axes.annotate("start", u[1:], (6, 2), textcoords="offset points")
    axes.axhline(0, color=style.BLACK, lw=0.4)
    axes.axvline(0, color=style.BLACK, lw=0.4)
    axes.set(xlabel="slip velocity $u_{t1}$ [m/s]", ylabel="slip velocity $u_{t2}$ [m/s]",
             aspect="equal", xlim=(-2.3, 0.9), ylim=(-0.6, 2.4))  # fmt: skip
    for mu in FRICTIONS:
        t, _, _, _, w = with_jumps(die_run(mu, "spatial"), END)
        for k, line in enumerate(("-", "--", ":")):
            spin.plot(t, w[:, k], line, color=COLOURS[mu])
    for k, line in enumerate(("-", "--", ":")):
        spin.plot([], [], line, color=style.BLACK, label=rf"$\omega_{'xyz'[k]}$")
    spin.legend(ncols=1, loc="upper left")
    spin.set(xlabel="time $t$ [s]", ylabel="angular velocity [rad/s]", xlim=(0, END))
    style.panel(axes, "first impact")
    style.panel(spin, "motion")
    return figure


def _second() -> str:
    return " and ".join(
        f"{1e3 * np.diff(die_run(mu, 'spatial').impacts.time[:2])[0]:.2f} ms (mu = {mu:g})"
        for mu in FRICTIONS
    )


def _error(steps: int) -> float:
    worst = 0.0
    for mu in FRICTIONS:
        run = die_run(mu, "spatial", layer_steps=steps)
        _, _, v, w = run.evaluate(run.impacts.time[0])
        found = np.concatenate([v[0], w[0]])
        worst = max(worst, float(np.max(np.abs(found / die_after("spatial", mu) - 1.0))))
    return worst


def _limit() -> float:
    return stick_limit(die_run(FRICTIONS[0], "spatial").impacts[0].inverse_mass)


FIGURES = (
    FigureOfPaper(
        "fig6a",
        "Die, spatial (section 4.2): as the planar one, but w = (10, 10, 0) rad/s. Path of the centre and "
        "outlines of the die, seen from the side and from above (grey: before the first impact).",
        "The die strikes with a corner and leaves the plane of its throw.",
        _trajectory,
        lambda: (
            "The first impact does not turn the centre round: another corner strikes "
            f"{_second()} later. The die leaves the plane y = 0 sideways."
        ),
    ),
    FigureOfPaper(
        "fig6b",
        "Die, spatial. Left: slip velocity of the corner during the first impact (hodograph), with the "
        "invariant directions of slip (dashed: outgoing, dotted: incoming) for mu = 0.05 and 0.20, and, to "
        "compare, mu = 0.60. Right: angular velocity in world axes against time (blue mu = 0.05, red 0.20).",
        "The direction of slip changes during the impact.",
        _hodograph,
        lambda: (
            "Slip bends towards the outgoing invariant direction. The friction that can hold the corner is "
            f"{_limit():.6f}: for both mu of the paper slip goes on, for 0.60 it stops and the corner "
            "sticks. Because slip turns, two spline steps are no longer exact: greatest relative error "
            f"after the first impact {_error(2):.0e} with 2 steps, {_error(16):.0e} with 16, {_error(64):.0e} "
            "with 64."
        ),
    ),
)
