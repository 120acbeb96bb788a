"""The pictures of the page on plots and films: what its own code draws.

Run ``python docs/pictures/plots.py`` to make ``docs/_static/plots``.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import tempfile
from pathlib import Path

import matplotlib as mpl
import numpy as np

DOCS = Path(__file__).parents[1]
PAGE = DOCS / "howto" / "plots.md"
OUT = DOCS / "_static" / "plots"
PIECE = re.compile(r"^```python\n(.*?)^```|^!\[.*?\]\((.*?)\)", re.MULTILINE | re.DOTALL)


def keep(name: str, space: dict) -> None:
    """Write the picture that the code before it has made."""
    if name.endswith(".gif"):
        shutil.copy(space["path"], OUT / name)
    elif "picture" in space:
        from PIL import Image

        Image.fromarray(space["picture"]).save(OUT / name)
    else:
        drawn = space["axes"] if "axes" in space else space["ax"]
        axes = list(drawn.values()) if isinstance(drawn, dict) else np.ravel(drawn)
        axes[0].figure.savefig(OUT / name, dpi=140, bbox_inches="tight", pad_inches=0.05)
    for made in ("axes", "ax"):
        space.pop(made, None)
    print(OUT / name)


def main() -> None:
    """Run the code of the page."""
    mpl.use("agg")
    OUT.mkdir(parents=True, exist_ok=True)
    space: dict = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for code, picture in PIECE.findall(PAGE.read_text(encoding="utf-8")):
            if code:
                exec(compile(code, str(PAGE), "exec"), space)
            else:
                keep(os.path.basename(picture), space)


if __name__ == "__main__":
    main()
