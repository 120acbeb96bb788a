"""The picture of "Work in a notebook": a cell and its result, as a static page.

Run ``python docs/pictures/notebook.py``, with ``pip install nbclient nbconvert ipykernel`` and a chromium, to
make ``docs/_static/notebook.png``.
"""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import nbclient
import nbformat
from nbconvert import HTMLExporter
from throw import OUT

CODE = """
import carom
from throw import throw

solution = throw()
solution
---
solution.impacts[:3]
---
solution.scene
"""


def main() -> None:
    """Run the notebook, and look at its page."""
    cells = [nbformat.v4.new_code_cell(code.strip()) for code in CODE.split("---")]
    made = nbformat.v4.new_notebook(cells=cells)
    here = {"metadata": {"path": str(Path(__file__).parent)}}
    nbclient.NotebookClient(made, timeout=120, kernel_name="python3", resources=here).execute()
    for cell in made.cells:  # without the bars of progress
        cell.outputs = [one for one in cell.outputs if one.output_type != "stream"]
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "notebook.html"
        page.write_text(HTMLExporter().from_notebook_node(made)[0], encoding="utf-8")
        subprocess.run(
            ["chromium", "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--window-size=1100,1420", "--hide-scrollbars",
             # the frame is drawn with its page, so that the picture waits for it
             "--disable-features=IsolateSandboxedIframes", "--virtual-time-budget=8000",
             f"--screenshot={OUT / 'notebook.png'}", page.as_uri()],
            check=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
