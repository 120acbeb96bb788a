"""The definition of a figure of the paper: a function that draws it, and its texts; pages and their tables."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from typing import Any, NamedTuple


class FigureOfPaper(NamedTuple):
    """One figure. `draw` returns a matplotlib figure; `seen` returns sentences with its computed numbers."""

    name: str
    caption: str
    paper: str
    draw: Callable[[], Any]
    seen: Callable[[], str]


def page(name: str, **values: object) -> str:
    """Return a page: its text in `pages`, with values in their places."""
    text = (files("carom.paper") / "pages" / f"{name}.md").read_text(encoding="utf-8")
    return text.format(**values)


def table(head, body) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *body]
    return "\n".join("| " + " | ".join(str(cell) for cell in cells) + " |" for cells in lines)
