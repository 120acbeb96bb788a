"""Common functions of the plots: figures, given axes, bodies and contacts by name, colours."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from itertools import cycle
from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.visual.plots import style

LEAST, MOST = 0.5, 50.0  # sizes of a figure [in]
ONE_PANEL = (style.COLUMN, 2.3)  # size of a figure of one panel [in]
#: of lines that are told apart, in their order
COLOURS = (style.BLUE, style.RED, style.GREEN, style.ORANGE, style.PURPLE, style.SKY, style.BLACK)


class Canvas(NamedTuple):
    """The arguments that all plots have: where they draw, and how large and in which style."""

    ax: Any
    figsize: Any = None
    style: Any = "carom"

    def new(self, size, **options):
        """Return a new figure of pyplot, by default of this `size` [in]."""
        size = size if self.figsize is None else self.size()
        return pyplot().figure(figsize=size, **options)

    def size(self) -> tuple[float, float]:
        """Return the size that was asked for [in]."""
        if self.ax is not None:
            raise ValueError(
                f"figsize must be left out with ax, which has a figure, got {checks.shown(self.figsize)}"
            )
        two = checks.finite_array("figsize", self.figsize, (2,), "inches")
        if not np.all((two >= LEAST) & (two <= MOST)):
            raise ValueError(
                f"figsize must be two numbers from {LEAST} to {MOST} [in], got {checks.shown(self.figsize)}"
            )
        return float(two[0]), float(two[1])


def only(panel, panels: tuple[str, ...], ax) -> int | None:
    """Return the number of the only axes to draw; None for all. A single Axes is that of the first panel."""
    pyplot()
    from matplotlib.axes import Axes

    if panel is None:
        return 0 if isinstance(ax, Axes) else None
    return panels.index(checks.choice("panel", panel, panels))


@contextmanager
def drawing(
    look: Canvas | Any,
    count: int = 1,
    size=(style.COLUMN, 2.3),
    compressed=False,
    only: int | None = None,
    **layout,
) -> Iterator[Any]:
    """Within this context matplotlib draws in the style of a plot; the axes to draw into.

    Parameters
    ----------
    look : Look
        The arguments of the plot, or only its `ax`: Axes, or a sequence of `count` of them. Without, a new
        figure of pyplot is made, with `count` axes one below the other unless `layout` (arguments of
        `Figure.subplots`) says otherwise; `compressed` for axes of fixed aspect.
    only : int, optional
        Number of the only axes that are seen: what is drawn into the others is thrown away.
    """
    plt = pyplot()
    look = look if isinstance(look, Canvas) else Canvas(look)
    if only is not None:
        from matplotlib.figure import Figure

        with drawing(look, 1, ONE_PANEL) as seen:
            parts = np.ravel(Figure().subplots(**layout or {"nrows": count}))
            last, parts[only] = parts[-1], seen
            yield parts
            # the last axes have the time for all of them
            if layout.get("sharex", not layout) and only < count - 1:
                seen.set(xlabel=last.get_xlabel(), xlim=last.get_xlim())
        return
    from matplotlib.axes import Axes

    figure, ax = None, look.ax
    if look.figsize is not None:
        look.size()
    with style.style(look.style):
        if ax is None:
            figure = look.new(size, layout="compressed" if compressed else "constrained")
            layout = layout or {"nrows": count, "sharex": True}
            parts = np.ravel(figure.subplots(**layout))
            if layout.get("sharex") and count > 1:
                figure.align_ylabels(parts)
        else:
            parts = np.empty(1, dtype=object)
            parts[0] = ax
            if isinstance(ax, (list, tuple, np.ndarray)):
                try:
                    parts = np.ravel(np.array(ax, dtype=object))
                except ValueError:
                    parts = np.empty(0, dtype=object)
            if len(parts) != count or not all(isinstance(one, Axes) for one in parts):
                raise ValueError(
                    f"ax must be {count} matplotlib Axes or None, got {checks.shown(ax)}"
                )
        try:
            yield parts[0] if count == 1 else parts
        except Exception:
            # nothing half drawn is left to be shown; of the caller's axes: no figure
            plt.close(figure)
            raise


def pyplot() -> Any:
    """Return matplotlib.pyplot with its backend loaded, or raise an error with the command that installs it.

    A backend makes settings of its own when it is loaded: that of notebooks makes matplotlib interactive. They
    must last, so it is loaded before the settings of a style, which end with the plot.
    """
    plt = checks.need("matplotlib.pyplot", "a plot", "plot")
    plt.draw_if_interactive()
    return plt


def is_bodies(solution) -> bool:
    """Return True for a `Solution`, False for a `GeneralizedSolution`; refuse other objects."""
    from carom.generalized.solution import GeneralizedSolution
    from carom.results.solution import Solution

    if isinstance(solution, (Solution, GeneralizedSolution)):
        return isinstance(solution, Solution)
    raise TypeError(
        f"solution must be a Solution or a GeneralizedSolution, got {checks.shown(solution)}; from a file: "
        "carom.Solution.load(path)"
    )


def need_bodies(solution, what: str) -> None:
    """Refuse a solution in coordinates."""
    if not is_bodies(solution):
        raise ValueError(
            f"{what} needs the Solution of a scene of bodies, got {checks.shown(solution)}"
        )


def named(argument: str, wanted, parts: list[str]) -> list[int]:
    """Return the indices of `wanted`, names or handles with a name or one of them; None is all."""
    if wanted is None:
        return list(range(len(parts)))
    if isinstance(wanted, str) or not isinstance(wanted, (list, tuple, set, np.ndarray)):
        wanted = [wanted]
    wanted = wanted.ravel() if isinstance(wanted, np.ndarray) else wanted
    found = []
    for one in wanted:
        name = one if isinstance(one, (str, type)) else getattr(one, "name", one)
        if not isinstance(name, str) or name not in parts:
            near = get_close_matches(checks.shown(name), parts, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            shown = ", ".join(map(repr, parts[:12])) + (", ..." if len(parts) > 12 else "")
            raise ValueError(
                f"{argument} must be among {shown or 'none'}, got {checks.shown(name)}{hint}"
            )
        found.append(parts.index(name))
    if not found:
        raise ValueError(f"{argument} must be at least one of {len(parts)}, got none")
    return found


def bodies(solution, wanted, argument: str = "bodies") -> list:
    """Return bodies of the scene by name."""
    every = solution.scene.bodies
    return [every[k] for k in named(argument, wanted, [body.name for body in every])]


def contact_names(solution) -> list[str]:
    """Return the names of all contacts, in their order."""
    if not is_bodies(solution):
        return [contact.name for contact in solution.system.contacts]
    from carom.results.names import contact_names as names

    return names(solution.scene, solution.pairs).name.tolist()


def need_impacts(solution) -> None:
    """Refuse a solution without impacts."""
    if not len(solution.impacts):
        raise ValueError(f"there must be an impact to draw, got {checks.shown(solution)}")


def impact(solution, k):
    """Return the record of impact k."""
    need_impacts(solution)
    count = len(solution.impacts)
    return solution.impacts[
        checks.integer("k, number of the impact,", k, least=-count, most=count - 1)
    ]


def with_impacts(solution) -> np.ndarray:
    """Return the saved times and those of impacts between them, where paths have corners."""
    times = solution.impacts.time
    inside = times[(times >= solution.t[0]) & (times <= solution.t[-1])]
    return np.union1d(solution.t, inside)


def colours():
    """Return an endless iterator over colours and dashes: the next ones once the colours are used up."""
    return ((c, line) for line in cycle(("-", "--", ":", "-.")) for c in COLOURS)


def legend(ax, least: int = 2, most: int = 12, **where) -> None:
    """Add a legend, unless there are too few entries or too many to be told apart."""
    if least <= len(ax.get_legend_handles_labels()[1]) <= most:
        ax.legend(**where)


def readable(value: float, unit: str) -> tuple[float, str]:
    """Return factor and unit in which values up to `value` [unit] read well: with SI prefixes, M to p."""
    prefixes = (
        (1e-6, "M"),
        (1e-3, "k"),
        (1.0, ""),
        (1e3, "m"),
        (1e6, r"$\mu$"),
        (1e9, "n"),
        (1e12, "p"),
    )
    factor, prefix = next((p for p in prefixes if value * p[0] >= 1.0), prefixes[-1])
    return factor, prefix + unit
