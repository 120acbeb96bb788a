"""A figure of the paper: a function that draws it, and its text; pages and their tables."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple


class FigureOfPaper(NamedTuple):
    """One figure. `draw` returns a matplotlib figure, `numbers` the numbers in its text, by name."""

    name: str
    draw: Callable[[], Any]
    numbers: Callable[[], dict[str, Any]] = dict

    @property
    def caption(self) -> str:
        """Its caption."""
        return texts()[self.name]["caption"]

    @property
    def paper(self) -> str:
        """What the paper says about it; "" if nothing."""
        return texts()[self.name]["paper"]

    def seen(self) -> str:
        """Return sentences with its computed numbers."""
        return texts()[self.name]["seen"].format(**self.numbers())


@cache
def texts() -> dict[str, dict[str, str]]:
    """Return the texts of all figures, by name, in their order."""
    return tomllib.loads(_read("figures.toml"))


def page(name: str, **values: object) -> str:
    """Return a page: its text in `pages`, with values in their places."""
    return _read(f"{name}.md").format(**values)


def _read(name: str) -> str:
    return (files("carom.paper") / "pages" / name).read_text(encoding="utf-8")


def table(head, body) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *body]
    return "\n".join("| " + " | ".join(str(cell) for cell in cells) + " |" for cells in lines)
