"""The picture of the tutorial "From a measured video to e and mu": heights of tosses, recorded and simulated.

Run ``python docs/pictures/video.py`` to make ``docs/_static/video.png``. It runs the code of the page.
"""

from __future__ import annotations

import re
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from carom.visual.plots import style

HERE = Path(__file__).parents[1]
PAGE = HERE / "tutorial" / "video.md"
SHOWN = (0, 3, 7, 10)


def run_page() -> dict:
    """Return the names that the code of the page has made."""
    text, names = PAGE.read_text(encoding="utf-8"), {}
    for block in re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        exec(block, names)
    return names


def main() -> None:
    """Draw."""
    names = run_page()
    print(names["fit"])
    with style.style():
        fig, panels = plt.subplots(1, 4, figsize=(9.6, 2.6), sharey=True, layout="constrained")
        for panel, k in zip(panels, SHOWN):
            toss, run = names["others"][k], names["runs"][k]
            panel.plot(toss.t, 100 * toss.position[:, 0, 2], ".", color="0.6", ms=3)
            panel.plot(toss.t, 100 * run.position[:, 0, 2], lw=1.2)
            panel.set(xlabel="t [s]", title=toss.name)
            panel.set_xlim(0, np.max(toss.t))
        panels[0].set_ylabel("height of the centre [cm]")
        fig.savefig(HERE / "_static" / "video.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
