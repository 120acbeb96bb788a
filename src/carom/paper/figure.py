"""What a figure of the paper is: how it is drawn, and the words that go with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple


class FigureOfPaper(NamedTuple):
    """One figure. `draw` returns a matplotlib figure; `seen` says what it shows, computed."""

    name: str
    caption: str
    paper: str
    draw: Callable[[], Any]
    seen: Callable[[], str]
