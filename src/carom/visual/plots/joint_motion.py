"""Plot of the joints over time: coordinates, rates, forces and torques."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

PANELS = "coordinates", "rates", "forces", "torques"
ROUND_OFF = 1e-9  # [m]: torques below this times the greatest force are not seen


@known
def joints(
    solution,
    joints=None,
    *,
    degrees: bool = False,
    panel: str | None = None,
    ax=None,
    figsize=None,
    style="carom",
):
    """Draw joints over time: their coordinates and rates, and the magnitudes of their forces and torques.

    Forces and torques are those of `Solution.joint_reactions`: on the child at its anchor.

    Parameters
    ----------
    solution : Solution
        A run with joints.
    joints : str or sequence of str, optional
        Joints, as names or objects. Default: all.
    degrees : bool
        Whether angles are in degrees. Default False: radians.
    panel : {"coordinates", "rates", "forces", "torques"}, optional
        Draw only these axes. Default: all; the first if `ax` is a single Axes.
    ax : Axes or sequence of 4 Axes, optional
        Axes to draw into. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    ndarray of 4 Axes
        Coordinates, rates, forces, torques; of one panel its Axes.

    Raises
    ------
    ValueError
        If the scene has no joints, or none with this name.
    """
    from carom.results.joint_coordinates import units

    figure.need_bodies(solution, "a plot of joints")
    checks.flag("degrees", degrees)
    every = solution.scene.joints
    if not every:
        raise ValueError(f"the scene must have a joint, got {solution!r}")
    chosen = [every[k] for k in figure.named("joints", joints, [joint.name for joint in every])]
    used: set[str] = set()
    only, look = figure.only(panel, PANELS, ax), figure.Canvas(ax, figsize, style)
    layout = {"nrows": 2, "ncols": 2, "sharex": True}
    with figure.drawing(look, 4, (looks.PAGE, 3.6), only=only, **layout) as axes:
        lines = figure.colours()
        for joint in chosen:
            view = solution[joint]
            pair, own = view.coordinates(degrees=degrees), units(joint, degrees)
            used |= set(own)
            for k in range(max(1, len(own))):
                colour, dash = next(lines)
                name = joint.name if len(own) < 2 else f"{joint.name}[{k}]"
                drawn = [values[:, k] for values in pair] if own else [[], []]
                if k == 0:
                    drawn += [np.linalg.norm(one, axis=1) for one in (view.force, view.torque)]
                for one, values in zip(axes, drawn):
                    t = solution.t if len(values) else []
                    one.plot(t, values, dash, color=colour, lw=0.9, label=name)
        unit, per = (" or ".join(f"{one}{end}" for one in sorted(used)) for end in ("", "/s"))
        words = f"coordinate [{unit}]", f"rate [{per}]", "force [N]", "torque [N m]"
        for one, word in zip(axes, words):
            one.set(ylabel=word, xlim=solution.t[[0, -1]])
        for one in axes[2:]:
            one.set(xlabel="time [s]")
            one.set_ylim(bottom=0.0)
        if not axes[3].get_ylim()[1] > ROUND_OFF * axes[2].get_ylim()[1]:
            axes[3].set_ylim(top=1.0)  # torques that are only round-off stay a line at 0
        figure.legend(axes[only or 0], 1, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4)
    return axes if only is None else axes[only]
