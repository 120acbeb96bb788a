"""Write the page of thresholds from `thresholds.py` of each folder.

    python tools/thresholds.py

A threshold is a line ``NAME = value  #: unit: reason``, or has this comment above it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "carom"
PAGE = ROOT / "docs" / "development" / "thresholds.md"
#: folders in the order of imports
ROOMS = (
    "geometry",
    "flexible",
    "collision",
    "model",
    "law",
    "kinematics",
    "contact",
    "friction",
    "dynamics",
    "impact",
    "persistent",
    "stepping",
    "generalized",
)
HEAD = """\
# Thresholds

Numbers that the physics does not determine: tolerances, shares, first and longest steps. What a user may want
to set is in `carom.Options` instead. Each folder states its thresholds once, in its file `thresholds.py`;
those of round-off are in `geometry`, for all. `tools/thresholds.py` makes this page from these files, and a
test compares them.

A value is in the unit beside it. Most units are lengths, speeds or matrices of the scene itself, so that a
scene has the same motion in other units. A name in backquotes is another threshold, or an option.
"""


class Threshold(NamedTuple):
    """A line of the page."""

    name: str
    value: str
    unit: str
    reason: str


def thresholds(room: str) -> tuple[str, list[Threshold]]:
    """Return what the file of a folder is about, and its thresholds."""
    text = (SOURCE / room / "thresholds.py").read_text(encoding="utf-8")
    found, above = [], []
    for line in text.splitlines():
        if line.startswith("#: "):
            above.append(line[3:])
        elif stated := re.fullmatch(r"(\w+) = (.*?)(?:  #: (.*))?", line):
            name, value, beside = stated.groups()
            unit, _, reason = " ".join([*above, *([beside] if beside else [])]).partition(": ")
            found.append(Threshold(name, value, unit, reason))
            above = []
    return text.split('"""')[1], found


def page() -> str:
    """Return the text of the page."""
    parts = [HEAD]
    for room in ROOMS:
        about, rows = thresholds(room)
        parts.append(f"## {room}\n\n{about.replace('Thresholds of', 'Of', 1)}\n")
        lines = ["| name | value | unit | reason |", "| --- | --- | --- | --- |"]
        for row in rows:
            unit, reason = (text.replace("|", "\\|") for text in row[2:])
            lines.append(f"| `{row.name}` | {row.value} | {unit} | {reason} |")
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
