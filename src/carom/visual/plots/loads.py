"""Plot of forces over time: of springs, motors, other forces, and contacts."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks


@known
def forces(solution, forces=None, *, ax=None, figsize=None, style="carom"):
    """Draw forces over time: of springs, motors, other applied forces, and persistent contacts.

    Upper axes: forces [N]; lower axes: torques [N m]; axes are left out if there is nothing to draw. What acts
    along a coordinate of a joint, and the tension of a spring, has a sign. Of others the magnitude is drawn.

    Parameters
    ----------
    solution : Solution
        A run.
    forces : str or sequence of str, optional
        Forces, motors (`Driver`), contacts and stops, as names or objects. Default: all that act.
    ax : sequence of Axes, optional
        As many Axes as are drawn, one or two. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    ndarray of Axes
        One or two: forces, torques.

    Raises
    ------
    ValueError
        If there is no force with this name, or nothing acts.
    """
    figure.need_bodies(solution, "a plot of forces")
    scene = solution.scene
    every = [force.name for force in scene.forces]
    every += [one.name for one in scene.constraints if one.kind == "Driver"]
    contacts = figure.contact_names(solution)
    touched = [contacts[k] for k in np.unique(solution._touch["contact"]).tolist()]
    wanted = every + touched if forces is None else None
    if wanted is None:
        names = [*every, *contacts]
        wanted = [names[k] for k in figure.named("forces", forces, names)]
    curves = [(name, unit, values) for name in wanted for unit, values in _curves(solution[name])]
    curves = [one for one in curves if np.any(np.nan_to_num(one[2]))]
    units = [unit for unit in ("N", "N m") if any(one[1] == unit for one in curves)]
    if not curves:
        raise ValueError(f"there must be a force that acts to draw, got {solution!r}")
    look = figure.Canvas(ax, figsize, style)
    with figure.drawing(look, len(units), (looks.COLUMN, 0.6 + 1.7 * len(units))) as axes:
        axes = np.atleast_1d(axes)
        for one, unit in zip(axes, units):
            lines = figure.colours()
            for name, _, values in (curve for curve in curves if curve[1] == unit):
                colour, dash = next(lines)
                one.plot(solution.t, values, dash, color=colour, lw=0.9, label=name)
            word = "force" if unit == "N" else "torque"
            one.set(ylabel=f"{word} [{unit}]", xlim=solution.t[[0, -1]])
            figure.legend(one, 1, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
        axes[-1].set(xlabel="time [s]")
    return axes


def _curves(view):
    """Yield the unit and the values (T,) of each curve of a view."""
    from carom.results.exerted import unit_of
    from carom.results.names import row_units
    from carom.results.views.contact import ContactView
    from carom.results.views.force import ConstraintView, ForceView

    if isinstance(view, ForceView) and unit_of(view._part):
        yield unit_of(view._part), view._value
    elif isinstance(view, ForceView):
        for unit, vector in (("N", view.force), ("N m", view.torque)):
            size = np.linalg.norm(vector, axis=-1)
            yield unit, size if size.ndim == 1 else np.sum(size, axis=1)
    elif isinstance(view, ConstraintView):
        yield "N m" if row_units(view._part.definition) == ["rad"] else "N", view.multipliers
    elif isinstance(view, ContactView):
        yield (
            ("N m", view.force[:, 0]) if view._turns else ("N", np.linalg.norm(view.force, axis=1))
        )
