"""Colours by their names in matplotlib, without matplotlib."""

from __future__ import annotations

import re
from functools import cache

from carom import checks


@cache
def named() -> dict[str, str]:
    """Return all colours by name, in lower case: those of CSS, of Tableau, one letter, and c0 to c9."""
    from importlib.resources import files

    lines = (files("carom.scene") / "colors.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split() for line in lines)


def hex_color(name: str, value) -> str:
    """Return a colour as ``#rrggbb``.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : str or (3,)
        A colour name of matplotlib (``"red"``, ``"tab:blue"``, ``"k"``, ``"C0"``), ``"#rrggbb"``, ``"#rgb"``;
        or red, green and blue, from 0 to 1.

    Raises
    ------
    ValueError
        If the value is none of these.
    """
    if not isinstance(value, str):
        array = checks.finite_array(name, value, (3,))
        if not (array.min() >= 0.0 and array.max() <= 1.0):
            raise ValueError(
                f"{name} must be red, green and blue from 0 to 1, got {checks.shown(value)}"
            )
        return "#" + "".join(f"{round(255 * part):02x}" for part in array.tolist())
    text = value.strip().lower()
    if re.fullmatch(r"#[0-9a-f]{6}", text):
        return text
    if re.fullmatch(r"#[0-9a-f]{3}", text):
        return "#" + "".join(2 * letter for letter in text[1:])
    if text in named():
        return named()[text]
    near = checks.nearest(text, named())
    raise ValueError(
        f"{name} must be a name that matplotlib has, '#rrggbb', or three numbers from 0 to 1, got "
        f"{checks.shown(value)}{near}"
    )
