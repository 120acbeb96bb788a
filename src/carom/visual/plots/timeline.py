"""Plot of the contacts over time: impacts, slip and stick."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

MODES = (("slipping", looks.ORANGE, 0.62), ("sticking", looks.BLUE, 0.34))  # width of the bar


@known
def contacts(solution, *, contacts=None, most: int = 40, ax=None, figsize=None, style="carom"):
    """Draw the state of each contact over time: ticks at impacts, bars for slip and stick.

    While nothing is drawn, the contact is open. A contact with several points may slip at one and stick (or
    roll, or rest) at another: then the narrow bar is drawn on the wide one.

    Parameters
    ----------
    solution : Solution or GeneralizedSolution
        The run.
    contacts : str or sequence of str, optional
        Contacts, as names or objects. Default: those that touch during the run.
    most : int
        Maximum number of rows: the contacts with the most impacts and intervals are drawn. Default 40.
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

    Raises
    ------
    ValueError
        If there is no contact with this name, or none of the contacts touches.
    """
    names = figure.contact_names(solution)
    most = checks.integer("most", most, least=1)
    chosen = figure.named("contacts", contacts, names)
    spans = intervals(solution)
    struck = solution.impacts
    busy = np.bincount(struck.contact.astype(int), minlength=len(names))
    busy = busy + np.bincount(np.array([row[0] for row in spans], dtype=int), minlength=len(names))
    if contacts is None:
        chosen = [c for c in chosen if busy[c]]
        chosen = sorted(sorted(chosen, key=lambda c: -busy[c])[:most])
    if not chosen:
        raise ValueError(f"there must be a contact that touches to draw, got {solution!r}")
    with figure.drawing(
        figure.Canvas(ax, figsize, style), 1, (looks.PAGE, 0.75 + 0.22 * min(len(chosen), 40))
    ) as axes:
        for mode, colour, width in MODES:
            for row, c in enumerate(chosen):
                bars = [
                    (a, b - a) for contact, a, b, what in spans if contact == c and what == mode
                ]
                if bars:
                    axes.broken_barh(bars, (row - width / 2, width), color=colour, lw=0)
            if any(row[0] in chosen and row[3] == mode for row in spans):
                axes.barh([0], [0], color=colour, label=mode)
        for row, c in enumerate(chosen):
            t = struck.time[struck.contact == c]
            axes.vlines(t, row - 0.4, row + 0.4, color=looks.BLACK, lw=0.6)
        axes.plot([], [], "|", color=looks.BLACK, ms=8, label="impact")
        axes.set_yticks(range(len(chosen)), [names[c] for c in chosen])
        room = max(0.0, 0.5 * (2 - len(chosen)))  # one row alone is not to fill tall axes
        axes.set(
            ylim=(len(chosen) - 0.4 + room, -0.6 - room),
            xlim=solution.t[[0, -1]],
            xlabel="time [s]",
        )
        axes.tick_params(axis="y", length=0)
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, columnspacing=1.0)
    return axes


def touching(solution) -> int:
    """Return the number of contacts that touch during the run."""
    return len({*solution.impacts.contact.tolist(), *(row[0] for row in intervals(solution))})


def intervals(solution) -> list[tuple[int, float, float, str]]:
    """Return (contact, start, end, mode) of all intervals of persistent contact."""
    if figure.is_bodies(solution):
        table = solution.contacts
        rows = zip(table.contact, table.start, table.end, table.mode)
        return [(int(c), float(a), float(b), str(mode)) for c, a, b, mode in rows]
    out, since = [], {}
    modes = {"slips": "slipping", "sticks": "sticking"}
    event = solution.events
    for time, kind, contact in zip(event.time, event.kind, event.contact):
        if kind == "impact":
            continue
        if contact in since:
            begin, mode = since.pop(contact)
            if mode and time > begin:
                out.append((int(contact), float(begin), float(time), mode))
        if kind != "opens":
            since[contact] = (time, modes.get(kind, "sticking"))
    end = float(solution.t[-1])
    return out + [(int(c), float(a), end, mode) for c, (a, mode) in since.items()]
