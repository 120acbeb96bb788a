"""One value of all runs of an ensemble over what was varied: a heat map, a line, or points."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.studies.ensembles.result import Ensemble
from carom.studies.ensembles.table import columns, stems
from carom.visual.plots import style as looks
from carom.visual.plots.figure import Canvas, drawing


def ensemble(
    found: Ensemble,
    value,
    over=None,
    *,
    ax=None,
    label: str | None = None,
    colorbar: bool = True,
    figsize=None,
    style="carom",
):
    """Draw one value of all runs of an ensemble over what was varied.

    Two axes of a `Grid` are a heat map, and one is a line, with the mean over all other axes of the grid.
    Without a grid each run is a point, in two axes with a colour. Runs that could not start are left out.

    Parameters
    ----------
    found : Ensemble
    value : str or (R,)
        A column of `Ensemble.to_pandas`, such as ``"die.z"``, ``"impacts"`` or ``"status"``, or one number or
        word for each run.
    over : str or two of them, optional
        The columns on the horizontal and on the vertical axis. Default: the axes of the grid, or the numbers
        that were varied.
    ax : Axes, optional
        Axes to draw into. Default: a new figure of pyplot.
    label : str, optional
        Name of the value. Default: that of its column.
    colorbar : bool
        Whether the colours have a scale. Default True.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If there is no such column, or `over` must be given because more than two numbers were varied.
    """
    checks.instance("found", found, (Ensemble,))
    checks.flag("colorbar", colorbar)
    table = columns(found)
    if label is None:
        label = value if isinstance(value, str) else "value"
    label = checks.text("label", label)
    values, words = _numbers(_column("value", value, table, len(found)))
    if not (isinstance(value, str) and value in ("status", "message")):
        values = np.where(found.outcomes["status"] >= 0, values, np.nan)
    names = _axes(found, over, table)
    with drawing(Canvas(ax, figsize, style)) as ax:
        ax.set_xlabel(names[0])
        ax.set_ylabel(label if len(names) == 1 else names[1])
        shown = None
        if set(names) <= set(found.grid):
            x, y, mean = _on_grid(found, names, values)
            if len(names) == 1:
                ax.plot(x, mean, "o-", color=looks.BLUE)
            else:
                shown = ax.pcolormesh(
                    _places(x), _places(y), mean.T, shading="nearest", cmap="cividis"
                )
                for axis, one in ((ax.xaxis, x), (ax.yaxis, y)):
                    if one.dtype.kind == "U":
                        axis.set_ticks(_places(one), labels=one.tolist())
        else:
            x = table[names[0]]
            if len(names) == 1:
                ax.plot(x, values, "o", color=looks.BLUE)
            else:
                shown = ax.scatter(x, table[names[1]], c=values, s=8, cmap="cividis")
        if words and len(names) == 1:
            ax.set_yticks(range(len(words)), words)
        if shown is not None and colorbar:
            bar = ax.figure.colorbar(shown, ax=ax, label=label)
            if words:
                bar.set_ticks(range(len(words)), labels=words)
    return ax


def _column(argument: str, given, table: dict[str, np.ndarray], runs: int) -> np.ndarray:
    """Return a column by name, or a given one."""
    if isinstance(given, str):
        return table[checks.choice(argument, given, table)]
    values = np.asarray(given)
    if values.dtype.kind not in "UO":
        values = checks.real_array(argument, given, f"({runs},)")
    if values.shape != (runs,):
        raise ValueError(
            f"{argument} must be a column of to_pandas or one value for each of {runs} runs, got "
            f"{checks.shown(given)}"
        )
    return values


def _numbers(values: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Return numbers; words become their places in the list that is returned too."""
    if values.dtype.kind not in "UO":
        return values.astype(float), []
    words, places = np.unique(values.astype(str), return_inverse=True)
    return places.astype(float), words.tolist()


def _axes(found: Ensemble, over, table: dict[str, np.ndarray]) -> list[str]:
    """Return the names of one or two axes."""
    if over is not None:
        names = [over] if isinstance(over, str) else checks.listed("over", over, "names of columns")
        if not 1 <= len(names) <= 2:
            raise ValueError(f"over must be one or two columns, got {checks.shown(over)}")
        return [checks.choice("over", name, {*table, *found.grid}) for name in names]
    names = list(found.grid)
    if not names:
        varied = tuple(stems(found)["inputs"].values())
        names = [n for n in table if n in varied or n.rpartition(".")[0] in varied]
        names = [n for n in names if table[n].dtype.kind == "f" and np.ptp(table[n]) > 0.0]
    if not 1 <= len(names) <= 2:
        raise ValueError(
            f"over must be one or two of {', '.join(names) or 'the columns'}, because not one or two numbers "
            "were varied, got None"
        )
    return names


def _on_grid(found: Ensemble, names: list[str], values: np.ndarray):
    """Return the values of one or two axes, and the means over all others."""
    axes = list(found.grid)
    rest = tuple(k for k, name in enumerate(axes) if name not in names)
    cells = values.reshape([len(axis) for axis in found.grid.values()])
    made = np.isfinite(cells)
    count = made.sum(axis=rest)
    with np.errstate(invalid="ignore"):
        mean = np.where(made, cells, 0.0).sum(axis=rest) / count
    left = [name for name in axes if name in names]
    order = [left.index(name) for name in names]
    x, *y = (found.grid[name] for name in names)
    return x, y[0] if y else x, np.transpose(mean, order)


def _places(values: np.ndarray) -> np.ndarray:
    """Return where the values of an axis stand; words stand side by side."""
    return np.arange(len(values)) if values.dtype.kind == "U" else values
