"""``carom paper``: reproduce the paper."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from carom.cli import show
from carom.paper.book import names

_WHICH = f"Of {', '.join(names())}."


def _chosen(given: list[str] | None) -> list[str]:
    """Return names of figures; several may be in one word, separated by commas."""
    chosen = [name for word in given or [] for name in word.split(",") if name]
    for name in chosen:
        if name not in names():
            raise typer.BadParameter(f"{name!r} is none of {', '.join(names())}.")
    return chosen


def run(
    figures: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="FIGURE", callback=_chosen, show_default=False,
            help=f"Make only these figures, without tables and pages. {_WHICH}",
        ),
    ] = None,
    figure: Annotated[
        list[str] | None,
        typer.Option(
            "--figure", metavar="NAME", callback=_chosen, show_default=False,
            help="The same as an option: may be repeated, or have several names separated by commas.",
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Output folder; it is created if it does not exist.")
    ] = Path("out/paper"),
) -> int:  # fmt: skip
    """Reproduce the paper: figures and tables.

    Writes Figs. 2a to 6b as PDF and PNG, the table of numbers (Markdown and CSV), and index.md,
    a page that shows and explains everything. This takes half a minute, and some minutes at the first
    time, because everything has to be compiled.

    For example:
      carom paper                            everything, in out/paper
      carom paper fig3a fig6b                these figures only
      carom paper --figure fig3a,fig6b --out pictures
    """
    from carom.paper.book import make, parts

    start = time.perf_counter()
    chosen = [*(figures or []), *(figure or [])] or None
    total = parts(chosen)
    with show.progress("paper") as bar:
        begun = iter(range(total + 1))

        def tell(name: str) -> None:
            bar(next(begun), total)
            bar.tell(name)

        written = make(out, chosen, tell)
    spent = time.perf_counter() - start
    more = "" if chosen else f"; start with {out / 'index.md'}"
    print(f"carom paper: {len(written)} files under {out} in {spent:.1f} s{more}")
    return 0
