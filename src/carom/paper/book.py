"""The whole reproduction of the paper in one folder: figures, tables, and an index page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from carom.io.files.disk import put
from carom.paper.figure import page, texts

TITLE = "A Novel Time-Stepping Method for Multibody Systems with Frictional Impacts"


_SILENT = "its text, as far as we know it, does not speak of this curve; the choice is ours."


def names() -> tuple[str, ...]:
    """Return the names of all figures."""
    return tuple(texts())


def figures() -> dict:
    """Return all figures by name."""
    from carom.paper import layer, planar, spatial, sphere

    return {
        figure.name: figure for part in (sphere, layer, planar, spatial) for figure in part.FIGURES
    }


def make(
    folder: Path,
    wanted: Sequence[str] | None = None,
    progress: Callable[[str], None] = lambda what: None,
) -> list[Path]:
    """Write figures, and, if no figures were chosen, the tables and their page too.

    Parameters
    ----------
    folder : Path
        Folder of the files; it is made if it does not exist.
    wanted : sequence of str, optional
        Names of figures. Default: all, with tables and pages.
    progress : callable
        Function that is called with the name of each part when the part begins; see `parts`.

    Returns
    -------
    list of Path
        The files written.
    """
    from carom.visual.plots.style import save, style

    folder.mkdir(parents=True, exist_ok=True)
    known = figures()
    written = []
    for name in wanted or known:
        progress(name)
        with style():
            written += save(known[name].draw(), folder, name)
    if not wanted:
        from carom.paper import table

        progress("table")
        written += table.write(folder)
        written.append(folder / "index.md")
        put(written[-1], [_index(known).encode()])
    return written


def parts(wanted: Sequence[str] | None = None) -> int:
    """Return the number of calls that `make` makes to its progress function."""
    return len(wanted) if wanted else len(names()) + 1


def _index(known: dict) -> str:
    import carom

    pieces = [page("index", title=TITLE, version=carom.__version__)]
    for figure in known.values():
        title = figure.name.replace("fig", "Fig. ").replace("_", " ")
        pieces.append(
            f"## {title[0].upper()}{title[1:]}\n\n![{figure.name}]({figure.name}.png)\n\n"
            f"{figure.caption} ([PDF]({figure.name}.pdf))\n\n"
            f"- **The paper:** {figure.paper or _SILENT}\n- **Seen here:** {figure.seen()}\n"
        )
    return "\n".join(pieces)
