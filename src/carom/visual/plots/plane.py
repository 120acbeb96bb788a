"""Phase plane plot."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks


@known
def phase(
    solution,
    of=None,
    *,
    axis: str = "z",
    number: int = 0,
    degrees: bool = False,
    ax=None,
    figsize=None,
    style="carom",
):
    """Draw the phase plane of one coordinate: its rate over its value.

    For a body or a coordinate of a `GeneralizedSystem`, an impact is a vertical line. For a joint only saved
    times are known, so an impact is an inclined line from one to the next.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        The run.
    of : str or handle, optional
        A body (its position along `axis`) or a joint (its coordinate `number`), as name or object. Default: the
        first joint that has a coordinate, otherwise the first body. Not for a `GeneralizedSolution`.
    axis : {"x", "y", "z"}
        Axis of the position of a body. Default "z".
    number : int
        Index of the coordinate of a joint, or of the system. Default 0.
    degrees : bool
        Whether the angle of a joint is in degrees. Default False: radians.
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
        The axes.
    """
    if not figure.is_bodies(solution):
        if of is not None:
            raise ValueError(
                f"of must be left out for a system in coordinates, got {checks.shown(of)}; give number"
            )
        count = solution.q.shape[1]
        k = checks.integer("number", number, least=0, most=count - 1)
        _, (q, v) = _course(solution, lambda states: (states[0][:, k], states[1][:, k]))
        words = f"$q_{{{k}}}$", f"$\\dot q_{{{k}}}$ [1/s]"
    else:
        checks.integer("number", number, least=0)
        axis, degrees = checks.choice("axis", axis, "xyz"), checks.flag("degrees", degrees)
        q, v, words = _of_scene(solution, of, axis, number, degrees)
    with figure.drawing(figure.Canvas(ax, figsize, style), 1, (looks.COLUMN, 2.6)) as axes:
        axes.plot(q, v, color=looks.BLUE, lw=0.9)
        axes.plot(q[:1], v[:1], "s", color=looks.BLUE, ms=4)
        axes.plot(q[-1:], v[-1:], "o", color=looks.BLUE, ms=4)
        axes.set(xlabel=words[0], ylabel=words[1])
    return axes


def _of_scene(solution, of, axis: str, number: int, degrees: bool):
    """Return coordinate, rate and their labels, of a joint or a body."""
    from carom.results.joint_coordinates import units as units_of

    scene = solution.scene
    joints = {joint.name: joint for joint in scene.joints if units_of(joint)}
    every = [body.name for body in scene.bodies]
    name = of if isinstance(of, type) else getattr(of, "name", of)
    if name is None:
        name = next(iter(joints), every[0])
    if isinstance(name, str) and name in joints:
        units = units_of(joints[name], degrees)
        k = checks.integer("number", number, least=0, most=len(units) - 1)
        q, rate = solution.joint_coordinates(name, degrees=degrees)
        words = f"coordinate of {name} [{units[k]}]", f"rate of {name} [{units[k]}/s]"
        return q.reshape(len(q), -1)[:, k], rate.reshape(len(q), -1)[:, k], words
    (b,) = figure.named("of", name, [*every, *joints])
    k = "xyz".index(axis)
    _, (q, v) = _course(solution, lambda states: (states[0][:, b, k], states[2][:, b, k]))
    return q, v, (f"${axis}$ of {name} [m]", f"$v_{axis}$ of {name} [m/s]")


def _course(solution, pick):
    """Return times (M,) and the chosen quantity there; at impacts before and after them."""
    t = figure.with_impacts(solution)
    struck = np.isin(t, solution.impacts.time)
    twice = np.repeat(t, 1 + struck)
    first = np.append(twice[1:] == twice[:-1], False)
    before, after = (pick(solution.evaluate(twice, side)) for side in ("left", "right"))
    return twice, tuple(np.where(first, b, a) for b, a in zip(before, after))
