"""The definition of a figure of the paper: a function that draws it, and its texts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple


class FigureOfPaper(NamedTuple):
    """One figure. `draw` returns a matplotlib figure; `seen` returns sentences with its computed numbers."""

    name: str
    caption: str
    paper: str
    draw: Callable[[], Any]
    seen: Callable[[], str]
