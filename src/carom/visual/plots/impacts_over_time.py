"""Plot of the impacts over time."""

from __future__ import annotations

import numpy as np

from carom.arguments import known
from carom.visual.plots import figure, style

_MARKS = "osD^v<>P"


@known
def impacts(solution, *, contacts=None, ax=None):
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
    ax : sequence of 4 Axes, optional
        Axes to draw into. Default: a new figure.

    Returns
    -------
    ndarray of 4 Axes
        Normal velocity, slip, impulses, energy.

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
    with figure.drawing(ax, 4, (style.PAGE, 4.0), nrows=2, ncols=2, sharex=True) as axes:
        many = len(struck) > 8
        for k, c in enumerate(struck):
            colour = style.BLUE if many else figure.COLOURS[k % len(figure.COLOURS)]
            label = names[c] if not many else f"{len(struck)} contacts" if not k else None
            _one(axes, table, table.contact == c, colour, "o" if many else _MARKS[k], label)
        normal, slip, impulse, lost = axes
        normal.axhline(0.0, color=style.BLACK, lw=0.4)
        speed, push = _units(solution, struck)
        normal.set(ylabel=f"normal velocity [{speed}]")
        slip.set(ylabel=f"slip [{speed}]")
        slip.set_ylim(bottom=0.0)
        impulse.set(ylabel=f"impulse [{push}]", yscale="log", xlabel="time [s]")
        lost.set(ylabel="energy lost [J]", yscale="log", xlabel="time [s]")
        for one, words in ((normal, ("before", "after")), (impulse, ("tangential", "normal"))):
            one.plot([], [], "o", mfc="white", mec=style.BLACK, label=words[0])
            one.plot([], [], "o", color=style.BLACK, label=words[1])
        for one in (normal, impulse, lost):
            figure.legend(one, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4)
    return axes


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
