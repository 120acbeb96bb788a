"""``carom paper``: reproduce the paper."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

_ABOUT = """\
Reproduce the paper: Figs. 2a to 6b as PDF and PNG, the table of numbers (Markdown and CSV),
impacts of a real cube, and index.md, a page that shows and explains them all.

  carom paper                          everything, under out/paper
  carom paper --figure fig3a fig6b     these figures only
"""


def add(commands) -> None:
    """Add the command to the parser."""
    from carom.paper.book import names

    this = commands.add_parser(
        "paper",
        help="reproduce the paper: figures and tables",
        description=_ABOUT,
        epilog="Figures: " + ", ".join(names()),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    this.add_argument(
        "--out", type=Path, default=Path("out/paper"), metavar="DIR",
        help="where to write; made if it is not there (default: %(default)s)",
    )  # fmt: skip
    this.add_argument(
        "--figure", nargs="+", choices=names(), metavar="NAME", default=None,
        help="only these figures, without tables and pages",
    )  # fmt: skip
    this.set_defaults(run=run, extra="paper")


def run(given) -> int:
    """Write the figures and tables, with a progress bar."""
    from carom.paper.book import make, parts

    start = time.perf_counter()
    bar = _Bar(parts(given.figure))
    try:
        written = make(given.out, given.figure, bar)
    finally:
        bar.close()
    spent = time.perf_counter() - start
    print(f"carom paper: {len(written)} files under {given.out} in {spent:.1f} s", end="")
    print("" if given.figure else f"; begin with {given.out / 'index.md'}")
    return 0


class _Bar:
    """A progress bar that names what is being made; without tqdm, nothing."""

    def __init__(self, total: int):
        self.begun, self.bar = 0, None
        try:
            from tqdm import tqdm
        except ModuleNotFoundError:
            print("carom paper: no progress bar without tqdm", file=sys.stderr)
        else:
            self.bar = tqdm(total=total, unit="part", leave=False, dynamic_ncols=True)

    def __call__(self, name: str) -> None:
        if self.bar is not None:
            self.bar.update(self.begun - self.bar.n)
            self.bar.set_postfix_str(name)
        self.begun += 1

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
