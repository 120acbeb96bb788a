"""What notebooks show of an object: a page, a picture or a table instead of its text."""

from __future__ import annotations


def html_of(thing) -> str:
    """Return an object as HTML."""
    from carom.visual import notebook

    return notebook.html_of(thing)


class Shown:
    """Base class of what shows itself in notebooks (`carom.visual.notebook`)."""

    def _repr_html_(self) -> str:
        return html_of(self)
