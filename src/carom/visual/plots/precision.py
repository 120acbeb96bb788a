"""Work-precision plot: error over computing time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from carom import checks
from carom.arguments import known
from carom.visual.plots import figure
from carom.visual.plots import style as looks

_MARKS = "osD^v<>P"


@known
def work_precision(series: Mapping, *, error: str = "error", ax=None, figsize=None, style="carom"):
    """Draw errors of several methods over wall time, both on logarithmic axes.

    Parameters
    ----------
    series : mapping of str to (times, errors)
        For each name in the legend: wall times (n,) [s] and errors (n,). Times must be above 0, errors at least
        0; errors of 0 are not shown. Points are joined in the order of time.
    error : str
        Label of the axis of errors, with the unit. Default "error".
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
    if not isinstance(series, Mapping) or not series:
        raise ValueError(
            f"series must be a mapping of names to (times, errors), got {checks.shown(series)}"
        )
    checks.text("error", error)
    checked = {name: _checked(name, pair) for name, pair in series.items()}
    figure.pyplot()
    from matplotlib.ticker import LogFormatterSciNotation, LogLocator

    with figure.drawing(figure.Canvas(ax, figsize, style), 1, (looks.COLUMN, 2.6)) as axes:
        for k, (name, (times, errors)) in enumerate(checked.items()):
            colour, mark = figure.COLOURS[k % 7], _MARKS[k % 8]
            axes.plot(times, errors, marker=mark, color=colour, lw=1.0, label=str(name))
        axes.set(xscale="log", yscale="log", xlabel="wall time [s]", ylabel=error)
        # hardly a decade has its label in there
        if axes.get_xlim()[1] < 100.0 * axes.get_xlim()[0]:
            axes.xaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
            axes.xaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(9.0, 9.0)))
        axes.grid(which="major", color="#dddddd", lw=0.5)
        axes.set_axisbelow(True)
        figure.legend(axes, least=1)
    return axes


def _checked(name, pair) -> tuple[np.ndarray, np.ndarray]:
    """Return times and errors, sorted by time."""
    two = checks.listed(f"series[{name!r}]", pair, "two: times and errors")
    if len(two) != 2:
        raise ValueError(f"series[{name!r}] must be (times, errors), got {checks.shown(pair)}")
    times, errors = two
    times = checks.finite_array(f"series[{name!r}] times", times, (None,), "s")
    errors = checks.finite_array(f"series[{name!r}] errors", errors, (None,))
    if len(times) != len(errors) or not np.all(times > 0.0) or not np.all(errors >= 0.0):
        raise ValueError(
            f"series[{name!r}] must be as many times above 0 as errors of at least 0, got {checks.shown(pair)}"
        )
    order = np.argsort(times)
    return times[order], np.where(errors > 0.0, errors, np.nan)[order]
