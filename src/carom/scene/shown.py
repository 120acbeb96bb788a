"""How an object shows itself: in notebooks instead of its text, and in plots."""

from __future__ import annotations

from typing import Any


def html_of(thing) -> str:
    """Return an object as HTML."""
    from carom.visual import notebook

    return notebook.html_of(thing)


def hodograph_of(impact, options: dict[str, Any]):
    """Draw the hodograph of an impact; return its axes."""
    from carom.visual import plots

    return plots.hodograph(impact, **options)


class Shown:
    """Base class of what shows itself in notebooks (`carom.visual.notebook`)."""

    def _repr_html_(self) -> str:
        return html_of(self)
