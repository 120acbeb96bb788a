"""How the examples become a gallery: their pictures and pages, square thumbnails, and their order."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from PIL import Image
from sphinx_gallery.scrapers import figure_rst

import carom
from carom.visual.films import still

WRITTEN = "out/examples"  # where `main` of an example writes by default, from its own folder here
EXAMPLES = Path(__file__).parents[1] / "examples"
PAGES = Path(__file__).parent / "_static" / "gallery"
FIRST = (  # of each section; the others follow by name
    "bouncing_sphere", "die", "own_force", "restitution_laws", "newtons_cradle", "counting_pi",
    "draw_shot", "ladder", "off_a_sphere", "rocking_block", "overhang", "arch", "trammel", "planetary_gear",
    "dice_study",
)  # fmt: skip
SIDE = 400  # of a thumbnail [pixels]
#: runs that are seen best at another part of their duration than 0.4
SEEN = {"arch": 1.0}
#: examples whose plot says more than their bodies do
PLOTTED = {
    "billiard_break",
    "bouncing_sphere",
    "watch",
    "own_force",
    "restitution_laws",
    "counting_pi",
    "painleve",
    "vibrating_table",
    "heap",
}


def pictures(block, block_vars, gallery_conf):
    """Move what an example has written into its page, and leave no trace beside the example."""
    source = Path(block_vars["src_file"])
    folder = source.parent / WRITTEN
    text = ""
    page, made = (folder / f"{source.stem}.{suffix}" for suffix in ("html", "png"))
    if page.exists():
        PAGES.mkdir(exist_ok=True)
        (PAGES / page.name).write_bytes(page.read_bytes())
        page.unlink()
        address = f"../../_static/gallery/{page.name}#loop"
        text += f'.. raw:: html\n\n   <iframe class="run" src="{address}" title="{source.stem}"></iframe>\n\n'
    if made.exists():
        place = Path(next(block_vars["image_path_iterator"]))
        place.write_bytes(made.read_bytes())
        made.unlink()
        text += figure_rst([place], gallery_conf["src_dir"])
    for empty in (folder, folder.parent):
        if empty.exists() and not any(empty.iterdir()):
            empty.rmdir()
    return text


class Thumbnails:
    """Looks over the shoulder of an example, and draws a square picture of what it has run or plotted."""

    def __init__(self):
        self.simulate, self.savefig = carom.simulate, Figure.savefig
        self.solution, self.panel = None, None

    def __call__(self, gallery_conf, path, when):
        """Begin before an example; afterwards write its thumbnail (a hook of sphinx-gallery)."""
        if when == "before":
            self.solution, self.panel = None, None
            carom.simulate, Figure.savefig = self._simulated(), self._saved()
            return
        carom.simulate, Figure.savefig = self.simulate, self.savefig
        example = next(EXAMPLES.rglob(Path(path).name))
        place = Path(gallery_conf["src_dir"]) / "gallery" / example.parent.name / "images" / "thumb"
        square = self._square(example.stem)
        if square is not None and place.exists():
            square.save(place / f"sphx_glr_{example.stem}_thumb.png")

    def _simulated(self):
        def simulate(*args, **options):
            self.solution = self.simulate(*args, **options)
            return self.solution

        return simulate

    def _saved(self):
        def savefig(figure, *args, **options):
            self.savefig(figure, *args, **options)
            self.panel = largest_panel(figure, self.savefig)

        return savefig

    def _square(self, name):
        bodies = self.solution.scene.bodies if isinstance(self.solution, carom.Solution) else ()
        if bodies and all(b.shape for b in bodies) and name not in PLOTTED:
            t = self.solution.t[0] + SEEN.get(name, 0.4) * (
                self.solution.t[-1] - self.solution.t[0]
            )
            near = {"follow": bodies[0].name, "zoom": 2.0} if len(bodies) == 1 else {}
            return Image.fromarray(still(self.solution, t, size=(SIDE, SIDE), clock=False, **near))
        return self.panel


def largest_panel(figure, savefig) -> Image.Image:
    """Return the largest panel of a figure with its labels, on a white square."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    panel = max(figure.axes, key=lambda axes: np.prod(axes.get_window_extent(renderer).size))
    if panel.get_aspect() == "auto":  # it becomes a square, and the figure what it must be for that
        figure.set_size_inches(2.4 * figure.bbox.size / panel.get_window_extent(renderer).size)
    figure.draw_without_rendering()
    inches = panel.get_tightbbox(renderer).transformed(figure.dpi_scale_trans.inverted())
    box = Bbox.from_extents(*(inches.min - 0.03), *(inches.max + 0.03))
    drawn = io.BytesIO()
    savefig(figure, drawn, bbox_inches=box, dpi=SIDE / max(box.size), format="png")
    picture, square = Image.open(drawn).convert("RGB"), Image.new("RGB", (SIDE, SIDE), "white")
    picture.thumbnail((SIDE, SIDE))
    square.paste(picture, ((SIDE - picture.width) // 2, (SIDE - picture.height) // 2))
    return square


thumbnails = Thumbnails()


class Order:
    """Sorts the examples of a section: those of `FIRST` in that order, then the others by name."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, file):
        """Return its place."""
        stem = Path(file).stem
        return (FIRST.index(stem) if stem in FIRST else len(FIRST), stem)
