"""The progress of what takes long: a bar on stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable
from time import perf_counter
from typing import Any, Self

from carom import checks

PATIENCE = 2.0  # seconds until a bar appears by itself


class Bar:
    """A bar with elapsed and remaining time, as a function of (done, total); shown after `patience` [s]."""

    costs: Callable[[], str] = staticmethod(lambda: "")  # what has cost time so far

    def __init__(self, what: str, patience: float = 0.0, hidden: bool = False):
        self.what, self.patience, self.hidden = what, patience, hidden
        self.begin, self.bar = perf_counter(), None

    def __call__(self, done: float, total: float) -> None:
        """Show how much is done."""
        if self.bar is None:
            waits = perf_counter() - self.begin < self.patience
            if self.hidden or waits or (self.patience > 0.0 and done >= total):
                return
            from tqdm import tqdm

            self.bar = tqdm(desc=self.what, total=total)
        self.bar.set_postfix_str(self.costs(), refresh=False)
        self.bar.update(done - self.bar.n)

    def tell(self, what: str) -> None:
        """Show the present task."""
        self.what = what
        if self.bar is not None:
            self.bar.set_description_str(what)

    def close(self) -> None:
        """Leave the bar as it is."""
        if self.bar is not None:
            self.bar.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_) -> None:
        self.close()


def is_watched() -> bool:
    """Return whether somebody reads stderr as it is written: a terminal, or a notebook."""
    if getattr(sys.stderr, "closed", True):
        return False
    return sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel")


def reporter(progress, what: str) -> Any:
    """Return a function of (done, total) that shows progress, or None."""
    if progress is None and is_watched():
        return Bar(what, PATIENCE)
    if progress is None or progress is False:
        return None
    if progress is True:
        return Bar(what)
    if callable(progress):
        return lambda done, total: checks.call("progress", progress, done, total)
    raise TypeError(f"progress must be True, False or a function, got {checks.shown(progress)}")
