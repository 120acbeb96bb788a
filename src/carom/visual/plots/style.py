"""One style for all figures: sizes of a two-column journal, and colours for colour-blind readers too.

Figures are made as objects, never through pyplot, and the settings hold only inside `style`:
nothing of the caller's matplotlib is touched and no display is needed.
"""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from contextlib import contextmanager
from pathlib import Path
from textwrap import shorten
from typing import Any

from carom import checks
from carom.io.files.disk import put

COLUMN, PAGE = 3.4, 6.9  # widths of one and of two columns [in]

# Okabe and Ito's palette
BLACK, GREY = "#000000", "#8c8c8c"
BLUE, RED, GREEN, ORANGE, SKY, PURPLE = (
    "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7",
)  # fmt: skip

SETTINGS: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "mathtext.fontset": "dejavusans",
    "axes.labelsize": 8.5,
    "axes.titlesize": 8.5,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "legend.borderaxespad": 0.2,
    "legend.labelspacing": 0.3,
    "lines.linewidth": 1.2,
    "lines.markersize": 3.5,
    "pdf.fonttype": 42,
    "savefig.bbox": "tight",
    "savefig.pad_inches": 0.02,
}
DPI = 250


@contextmanager
def style(chosen="carom"):
    """Within this context matplotlib draws in a style, by default that of the paper's figures.

    Other values are None, for the caller's own settings; a mapping of settings, which are added to those of the
    paper; and what `matplotlib.style.use` takes, in their place.
    """
    import matplotlib as mpl
    from matplotlib.style import use

    styles = SETTINGS if isinstance(chosen, str) and chosen == "carom" else chosen
    styles = [SETTINGS, chosen] if isinstance(chosen, Mapping) else styles
    with mpl.rc_context():
        try:
            if chosen is not None:
                checks.instance("style", chosen, (str, os.PathLike, Mapping, list))
                use(styles)
        except (OSError, LookupError, TypeError, ValueError) as error:
            raise ValueError(
                'style must be "carom", None, a mapping of settings of matplotlib, or one of its styles, got '
                f"{checks.shown(chosen)}: {shorten(str(error), 200)}"
            ) from None
        yield


def new(width=COLUMN, height=2.3, rows=1, columns=1, **options) -> tuple[Any, Any]:
    """Return a figure and its axes (one, or an array) of the given size [in]."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


@contextmanager
def picture(path, height=2.6, columns=1, rows=1, width=PAGE, **options):
    """Within this context new axes are drawn into, of the size given [in]; at its end they become a PNG file.

    Yields the axes (one, or an array). Lines that are given no colour take those of the palette in turn;
    `options` are those of `Figure.subplots`. The folder of the file is made at the start, if there is none.
    """
    import matplotlib as mpl
    from cycler import cycler

    Path(path).parent.mkdir(parents=True, exist_ok=True)
    palette = cycler(color=[BLUE, RED, GREEN, ORANGE, PURPLE, SKY])
    with style(), mpl.rc_context({"axes.prop_cycle": palette}):
        figure, axes = new(width, height, rows, columns, **options)
        yield axes
        write(figure, path)


def write(figure, path) -> None:
    """Write a figure as PNG; the folder is made if there is none."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    put(path, [as_bytes(figure, path.suffix, dpi=DPI)])


def mosaic(width, height, layout, columns, rows=None) -> tuple[Any, Any]:
    """Return a figure and its axes by name, from their layout and the sizes of columns and rows."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplot_mosaic(layout, width_ratios=columns, height_ratios=rows)


def save(figure, folder: Path, name: str) -> list[Path]:
    """Write a figure as PDF and PNG; the same input gives the same bytes."""
    files = [folder / f"{name}.pdf", folder / f"{name}.png"]
    put(files[0], [as_bytes(figure, ".pdf", metadata={"CreationDate": None})])
    put(files[1], [as_bytes(figure, ".png", dpi=DPI)])
    return files


def as_bytes(figure, suffix: str, **options: Any) -> memoryview:
    """Return a figure as the bytes of a file with this suffix."""
    out = io.BytesIO()
    figure.savefig(out, format=suffix.removeprefix(".") or "png", **options)
    return out.getbuffer()
