"""Plot of slip in the tangent plane during an impact."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from carom import checks
from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

FLOW_STEPS = 128  # of the spline through the impact
FLOW = 0.7  # density of the lines of the flow


@known
def hodograph(
    solution,
    k: int = 0,
    *,
    flow: bool = True,
    panel: str | None = None,
    ax=None,
    figsize=None,
    style="carom",
):
    """Draw the slip velocity during one impact, and the friction force.

    Left axes: the path of the slip velocity from before the impact (square) to after it (dot), and its
    invariant rays (`invariant_directions`): slip grows along outgoing rays and decreases along incoming ones.
    Grey lines are the paths of slip velocities from other starts, along ``W_tn - mu W_tt e`` with the slip
    direction e (mathematics page, §1.9). Right axes: friction force divided by normal force; it is on the
    circle of radius mu while the contact slips, and inside while it sticks.

    Parameters
    ----------
    solution : Solution, GeneralizedSolution, Impact or ImpactRecord
        A run, or a single impact: the result of `carom.resolve_impact`, or ``solution.impacts[k]``.
    k : int
        Index of the impact of a run; negative indices count from the end. Default 0.
    flow : bool
        True (default): draw the grey lines.
    panel : {"slip", "friction"}, optional
        Draw only these axes. Default: all; the first if `ax` is a single Axes.
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
        Left and right axes; of one panel its Axes.

    Raises
    ------
    ValueError
        If there is no impact k, it is part of a multiple impact, or its contact has no tangents.
    """
    checks.flag("flow", flow)
    record = _record(solution, k)
    W, mu = record.inverse_mass, record.friction
    if record.together > 1:
        raise ValueError(
            f"impact {k} is part of a multiple impact ({record.together} closed points), where slip depends on "
            "the other points; draw an impact with impacts.together == 1"
        )
    if not np.any(W[1:, 1:]):
        raise ValueError(f"impact {k} must have tangential motion, got a contact without tangents")
    history = _course(record)
    path = history.evaluate(np.linspace(0.0, history.duration, 600))[1][:, 1:]
    path = np.vstack(
        [record.relative_velocity_before[1:], path, record.relative_velocity_after[1:]]
    )
    only, look = figure.only(panel, ("slip", "friction"), ax), figure.Canvas(ax, figsize, style)
    size = (looks.PAGE, 3.3)
    with figure.drawing(look, 2, size, compressed=True, only=only, ncols=2) as axes:
        _slip(axes[0], path, W, mu, flow)
        _friction(axes[1], history, mu)
    return axes if only is None else axes[only]


def _record(solution, k):
    """Return the record of an impact: of impact k of a run, or of a single one."""
    from carom.generalized.solution import CoordinateImpact
    from carom.impact.api import Impact
    from carom.results.event_tables import ImpactRecord

    if isinstance(solution, (ImpactRecord, CoordinateImpact)):
        return solution
    if isinstance(solution, Impact):
        if "inverse_mass" not in solution._stated:
            raise ValueError(
                "there must be one impact in space to draw, got several, or a plane one (give W (3, 3))"
            )
        return SimpleNamespace(
            relative_velocity_after=solution.velocity_after, together=1, **solution._stated
        )
    figure.is_bodies(solution)
    return figure.impact(solution, k)


def _course(record):
    """Return the impact in time; velocities depend neither on the width nor on the penetration."""
    from carom.impact.history import impact_layer

    return impact_layer(
        record.inverse_mass, record.relative_velocity_before, record.friction, record.restitution,
        penetration=0.5, width=1e-6, law=record.law, steps=FLOW_STEPS,
    )  # fmt: skip


def _slip(axes, path, W, mu, flow: bool) -> None:
    from carom.impact.slip_directions import invariant_directions

    corners = np.vstack([path, np.zeros(2)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, half = 0.5 * (low + high), 0.62 * float(max(high - low)) or 1.0
    if flow and mu > 0.0:
        grid = np.linspace(-half, half, 60)
        slip = np.stack(np.meshgrid(*(m + grid for m in middle)))
        size = np.maximum(np.hypot(*slip), 1e-12 * half)
        rate = W[1:, 0, None, None] - mu * np.einsum("ij,jab->iab", W[1:, 1:], slip / size)
        axes.streamplot(
            *(m + grid for m in middle), *rate, density=FLOW, color="#c8c8c8", linewidth=0.6,
            arrowsize=0.6, zorder=0,
        )  # fmt: skip
    axes.plot(*path.T, color=looks.RED, lw=1.8, zorder=3, label="slip")
    rays = invariant_directions(W, mu)
    drawn = {True: "outgoing ray", False: "incoming ray"}
    for angle, grows in zip(rays.angle, rays.outgoing):
        end = 4.0 * half * np.array([np.cos(angle), np.sin(angle)])
        axes.plot([0.0, end[0]], [0.0, end[1]], "--" if grows else ":", color=looks.BLACK, lw=0.9,
                  label=drawn.pop(bool(grows), None))  # fmt: skip
    axes.plot(*path[0], "s", color=looks.RED, ms=4.5, zorder=4)
    axes.plot(*path[-1], "o", color=looks.RED, ms=4.5, zorder=4)
    axes.plot(0.0, 0.0, "+", color=looks.BLACK, ms=6, zorder=4)
    axes.set(xlabel="slip $u_{t1}$ [m/s]", ylabel="slip $u_{t2}$ [m/s]", aspect="equal")
    axes.set(xlim=middle[0] + half * np.array([-1, 1]), ylim=middle[1] + half * np.array([-1, 1]))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)


def _friction(axes, history, mu: float) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    axes.plot(
        mu * np.cos(angle), mu * np.sin(angle), color=looks.GREY, lw=0.8, label=rf"$\mu$ = {mu:g}"
    )
    pressed = history.normal_force > 0.0
    share = history.friction_force[pressed] / history.normal_force[pressed, None]
    axes.plot(*share.T, ".-", color=looks.RED, lw=0.8, ms=3)
    if len(share):
        axes.plot(*share[0], "s", color=looks.RED, ms=4.5)
        axes.plot(*share[-1], "o", color=looks.RED, ms=4.5)
    axes.plot(0.0, 0.0, "+", color=looks.BLACK, ms=6)
    axes.set(xlabel="friction / normal force, $t_1$", ylabel="friction / normal force, $t_2$")
    reach = 1.15 * mu or 1.0
    axes.set(aspect="equal", xlim=(-reach, reach), ylim=(-reach, reach))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))
