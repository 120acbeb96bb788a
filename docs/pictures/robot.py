"""The page of a run in the tutorial "A robot on a floor".

Run ``python docs/pictures/robot.py`` to make ``docs/_static/robot.html``. It runs the code of the page.
"""

from __future__ import annotations

import re
from pathlib import Path

import carom

HERE = Path(__file__).parents[1]
PAGE = HERE / "tutorial" / "robot.md"


def main() -> None:
    """Make the page of the last run."""
    names = {}
    for block in re.findall(
        r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S
    ):
        exec(block, names)
    title = "A robot strikes a crate"
    print(carom.view(names["solution"], export=HERE / "_static" / "robot.html", title=title))


if __name__ == "__main__":
    main()
