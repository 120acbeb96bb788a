"""Plot of the impacts over time."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

_MARKS = "osD^v<>P"
PANELS = ("velocity", "slip", "impulse", "energy")


@known
def impacts(
    solution, *, contacts=None, panel: str | None = None, ax=None, figsize=None, style="carom"
):
    """Draw all impacts over time: normal velocity, slip, impulse and energy loss.

    There are four axes. Normal velocity and speed of slip: open marks before and filled marks after the impact,
    joined by a line. Normal impulse (filled) and tangential impulse (open). Energy loss; a cross is an energy
    gain, which Newton's law allows. Axes of impulses and energies are logarithmic; values below 1e-12 of the
    greatest are not shown.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        The run.
    contacts : str or sequence of str, optional
        Contacts, as names or objects. Default: all.
    panel : {"velocity", "slip", "impulse", "energy"}, optional
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
        Normal velocity, slip, impulses, energy; of one panel its Axes.

    Raises
    ------
    ValueError
        If there is no impact, or no contact with this name.
    """
    names = figure.contact_names(solution)
    figure.need_impacts(solution)
    chosen = figure.named("contacts", contacts, names)
    table = solution.impacts
    struck = [c for c in chosen if np.any(table.contact == c)]
    if not struck:
        raise ValueError(f"contacts must have an impact to draw, got {contacts!r}, which have none")
    only, look = figure.only(panel, PANELS, ax), figure.Canvas(ax, figsize, style)
    layout = {"nrows": 2, "ncols": 2, "sharex": True}
    with figure.drawing(look, 4, (looks.PAGE, 4.0), only=only, **layout) as axes:
        many = len(struck) > 8
        for k, c in enumerate(struck):
            colour = looks.BLUE if many else figure.COLOURS[k % len(figure.COLOURS)]
            label = names[c] if not many else f"{len(struck)} contacts" if not k else None
            _one(axes, table, table.contact == c, colour, "o" if many else _MARKS[k], label)
        normal, slip, impulse, lost = axes
        normal.axhline(0.0, color=looks.BLACK, lw=0.4)
        speed, push = _units(solution, struck)
        normal.set(ylabel=f"normal velocity [{speed}]")
        slip.set(ylabel=f"slip [{speed}]")
        slip.set_ylim(bottom=0.0)
        impulse.set(ylabel=f"impulse [{push}]", yscale="log", xlabel="time [s]")
        lost.set(ylabel="energy lost [J]", yscale="log", xlabel="time [s]")
        for one, words in ((normal, ("before", "after")), (impulse, ("tangential", "normal"))):
            one.plot([], [], "o", mfc="white", mec=looks.BLACK, label=words[0])
            one.plot([], [], "o", color=looks.BLACK, label=words[1])
        for one in (normal, impulse, lost):
            figure.legend(one, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4)
        if only is not None:  # the names of contacts stand above the energies
            sources = (lost, axes[only]) if len(struck) > 1 and axes[only] is not lost else ()
            handles = [h for one in sources for h in one.get_legend_handles_labels()[0]]
            handles = handles or axes[only].get_legend_handles_labels()[0]
            if handles:
                place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": 2}
                axes[only].legend(handles=handles, **place)
    return axes if only is None else axes[only]


def _one(axes, table, rows, colour, mark, label) -> None:
    """Draw the impacts of one contact."""
    normal, slip, impulse, lost = axes
    t = table.time[rows]
    before, after = table.relative_velocity_before[rows], table.relative_velocity_after[rows]
    full = {"ls": "", "marker": mark, "color": colour, "mew": 0.8}
    hollow = {**full, "mfc": "white", "zorder": 3}
    speeds = (
        (normal, before[:, 0], after[:, 0]),
        (slip, np.hypot(*before[:, 1:].T), np.hypot(*after[:, 1:].T)),
    )
    for one, first, last in speeds:
        one.vlines(t, first, last, color=colour, lw=0.6, alpha=0.7)
        one.plot(t, first, **hollow)
        one.plot(t, last, **full)
    P = table.impulse[rows]
    greatest = np.max(np.abs(table.energy_change), initial=0.0)
    most = np.max(np.abs(table.impulse), initial=0.0)
    impulse.plot(t, _above(np.hypot(P[:, 1], P[:, 2]), most), **hollow)
    impulse.plot(t, _above(P[:, 0], most), **full)
    lost.plot(t, _above(-table.energy_change[rows], greatest), **full, label=label)
    gained = _above(table.energy_change[rows], greatest)
    if np.any(gained > 0.0):
        lost.plot(t, gained, ls="", marker="x", color=colour, label="gained")


def _above(values, greatest: float) -> np.ndarray:
    """Return values with NaN in place of those that are too small for a logarithmic axis."""
    return np.where(values > 1e-12 * greatest, values, np.nan)


def _units(solution, struck) -> tuple[str, str]:
    """Return the units of velocities and impulses of contacts."""
    if not figure.is_bodies(solution):
        return "gap/s", "N s, by gap"  # the user's own unit
    scene = solution.scene
    stops = len(figure.contact_names(solution)) - len(scene.stops)
    if max(struck) < stops:
        return "m/s", "N s"
    return "m/s or rad/s", "N s or N m s"
