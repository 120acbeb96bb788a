"""Plot of an impact over its two coefficients: the e-mu diagram."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

#: what slip does, by the phases that are passed: in words, and in pale colours
OUTCOMES = (
    ("wedged", "wedged", "#d5d5d5"),
    ("jam", "jams", "#f3c6b0"),
    ("reversal", "slip stops, starts again", "#fbe5b6"),
    ("stick", "sticks", "#cfe3f1"),
    ("slip", "slips throughout", "#ffffff"),
)
CONTOURS = 8  # lines of equal loss, about


@known
def e_mu(
    inverse_mass, velocity, law: str = "newton", *, most_friction: float = 1.0, points: int = 121, ax=None,
    figsize=None, style="carom",
):  # fmt: skip
    """Draw what an impact does, and what energy it loses, over its coefficients of friction and restitution.

    Areas: whether slip lasts throughout the impact, stops for good (the contact sticks), or starts again in
    another direction; whether the contact jams (the normal force makes the bodies approach while they slip) or
    friction wedges the pair. Lines: the energy loss divided by the energy that the impact could take,
    ``u.W^-1 u / 2``; negative values are gains, which Newton's law allows. Dotted: the critical friction
    (`carom.impact.critical_friction`), from which on slip that has stopped does not start again.

    Parameters
    ----------
    inverse_mass : array_like, shape (3, 3)
        Delassus operator W of the contact [1/kg], as for `carom.resolve_impact`, for example
        ``solution.impacts[k].inverse_mass``.
    velocity : array_like, shape (3,)
        Relative velocity before the impact [m/s]; the normal component is first, and negative.
    law : {"newton", "poisson", "stronge"}
        Law of restitution, with a path. Default "newton".
    most_friction : float
        Greatest friction, above 0. Default 1.
    points : int
        Number of values of each coefficient, 2 to 1001. Default 121.
    ax : Axes, optional
        Axes to draw into. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    Axes
        The axes: friction to the right, restitution upwards.

    Raises
    ------
    ValueError
        If an argument is invalid.
    """
    from carom.impact.api import checked_impact, need_path
    from carom.impact.slip_directions import critical_friction

    most = checks.number("most_friction", most_friction, above=0.0, most=1e3)
    count = checks.integer("points", points, least=2, most=1001)
    W, u, _, _, law_number = checked_impact(inverse_mass, velocity, 0.0, 0.0, law)
    need_path("the map of outcomes", law)
    mu, e = np.linspace(0.0, most, count), np.linspace(0.0, 1.0, count)
    number, loss = _outcomes(W, u, law_number, mu, e)
    figure.pyplot()
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    with figure.drawing(figure.Canvas(ax, figsize, style), 1, (looks.COLUMN, 3.0)) as axes:
        palette = ListedColormap([colour for _, _, colour in OUTCOMES])
        axes.pcolormesh(
            mu, e, number, cmap=palette, vmin=-0.5, vmax=len(OUTCOMES) - 0.5, shading="nearest",
            rasterized=True,
        )  # fmt: skip
        if np.nanmax(loss) - np.nanmin(loss) > 1e-9:
            lines = axes.contour(mu, e, loss, levels=CONTOURS, colors=looks.BLACK, linewidths=0.6)
            axes.clabel(lines, fontsize="small")
        if (critical := critical_friction(W)) < most:
            axes.axvline(critical, color=looks.RED, lw=1.0, ls=":", label=r"$\mu_\mathrm{crit}$")
        seen = [OUTCOMES[k] for k in np.unique(number[np.isfinite(number)]).astype(int)[::-1]]
        drawn = [Patch(fc=c, ec=looks.GREY, lw=0.5, label=words) for _, words, c in seen]
        axes.set(xlabel=r"friction $\mu$", ylabel="restitution $e$", xlim=(0, most), ylim=(0, 1))
        drawn += axes.get_legend_handles_labels()[0]
        axes.legend(handles=drawn, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    return axes


def _outcomes(W, u, law: int, mu, e) -> tuple[np.ndarray, np.ndarray]:
    """Return the number of the outcome and the relative loss (E, M); NaN where there is no solution."""
    from carom.impact import layout as o
    from carom.impact.api import phase_names
    from carom.impact.resolve import resolve

    names = [name for name, _, _ in OUTCOMES]
    number, loss = np.full((2, len(e), len(mu)), np.nan)
    out, most = np.zeros(o.SIZE), 0.5 * u @ np.linalg.pinv(W) @ u
    for i, j in np.ndindex(number.shape):
        if resolve(W, u, float(mu[j]), float(e[i]), law, out) != o.OK:
            continue  # no impulse stops the approach
        phases = phase_names(int(out[o.PHASES]))  # none without any slip
        number[i, j] = next(
            (k for k, name in enumerate(names) if name in phases), names.index("stick")
        )
        loss[i, j] = -out[o.ENERGY_CHANGE] / most
    return number, loss
