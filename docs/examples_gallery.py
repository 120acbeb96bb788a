"""How the examples become a gallery: their pictures, films and pages, square thumbnails, and their order."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from PIL import Image, ImageDraw
from sphinx_gallery.scrapers import figure_rst

import carom
from carom.visual.films import still

WRITTEN = "out/examples"  # where `main` of an example writes by default, from its own folder here
EXAMPLES = Path(__file__).parents[1] / "examples"
PAGES = Path(__file__).parent / "_static" / "gallery"
FIRST = (  # of each section; the others follow by name
    "bouncing_sphere", "die", "watch", "own_force", "restitution_laws", "newtons_cradle", "counting_pi",
    "draw_shot", "ladder", "off_a_sphere", "plank_on_rollers", "stick_slip", "ball_in_a_bowl", "rocking_block",
    "overhang", "arch", "heap", "rattleback",
    "trammel",
    "trebuchet", "planetary_gear", "falling_chain", "heavy_top", "rolling_disc", "sleigh", "striking_four_bar",
    "load_a_model", "dice_study",
)  # fmt: skip
SIDE = 400  # of a thumbnail [pixels]
#: runs that are seen best at another part of their duration than 0.4, or from elsewhere than usual
SEEN = {
    "a02_four_bars": (0.02, {"view": "front"}),
    "a03_andrews": (0.4, {"view": "top"}),
    "arch": (1.0, {}),
    "dzhanibekov": (0.4, {"zoom": 3.5}),
    "falling_chain": (0.6, {"view": "front"}),
    "heavy_top": (0.15, {"zoom": 1.5}),
    "hopping_leg": (0.04, {"view": "front"}),
    "newtons_cradle": (0.1, {"view": (-75, 10)}),
    "overhang": (1.0, {"view": (-75, 12)}),
    "planetary_gear": (0.6, {"view": (-80, 50)}),
    "rocking_block": (0.0, {}),
    "rolling_disc": (0.4, {"zoom": 1.4}),
    "striking_four_bar": (0.1, {"view": "front"}),
}
#: examples whose plot says more than their bodies do
PLOTTED = {
    "a01_pendulum",
    "aim_a_throw",
    "ball_in_a_bowl",
    "billiard_break",
    "bouncing_sphere",
    "counting_pi",
    "draw_shot",
    "gear_rattle",
    "heap",
    "impact_hammer",
    "jams_and_locks",
    "ladder",
    "load_a_model",
    "loose_pin",
    "off_a_sphere",
    "one_bounce",
    "own_force",
    "painleve",
    "plank_on_rollers",
    "restitution_laws",
    "save_and_resume",
    "sleigh",
    "stick_slip",
    "tippe_top",
    "trammel",
    "trebuchet",
    "vibrating_table",
    "watch",
    "woodpecker",
}


def pictures(block, block_vars, gallery_conf):
    """Move what an example has written into its page, and leave no trace beside the example."""
    source = Path(block_vars["src_file"])
    folder = source.parent / WRITTEN
    text = ""
    page, *drawn = (folder / f"{source.stem}.{suffix}" for suffix in ("html", "gif", "png"))
    if page.exists():
        PAGES.mkdir(exist_ok=True)
        (PAGES / page.name).write_bytes(page.read_bytes())
        page.unlink()
        address = f"../../_static/gallery/{page.name}#loop"
        text += f'.. raw:: html\n\n   <iframe class="run" src="{address}" title="{source.stem}"></iframe>\n\n'
    for made in filter(Path.exists, drawn):
        place = Path(next(block_vars["image_path_iterator"])).with_suffix(made.suffix)
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
            if (PAGES / f"{example.stem}.html").exists() or any(
                place.parent.glob(f"*_{example.stem}_*.gif")
            ):
                mark_film(square)
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
        if isinstance(self.solution, carom.Solution) and name not in PLOTTED:
            part, look = SEEN.get(name, (0.4, {}))
            t, bodies = self.solution.t, self.solution.scene.bodies
            if len(bodies) == 1 and not self.solution.scene.joints:
                look = {"follow": bodies[0].name, "zoom": 2.0} | look
            at = t[0] + part * (t[-1] - t[0])
            return Image.fromarray(still(self.solution, at, size=(SIDE, SIDE), clock=False, **look))
        return self.panel


def largest_panel(figure, savefig) -> Image.Image:
    """Return the largest panel of a figure with its labels, on a white square."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    panel = max(figure.axes, key=lambda axes: np.prod(axes.get_window_extent(renderer).size))
    wide = panel.get_window_extent(renderer).size
    if panel.get_aspect() != "auto" and panel.get_adjustable() == "box":  # it keeps its shape
        wide = np.max(wide)
    figure.set_size_inches(2.4 * figure.bbox.size / wide)  # small: its words are to be read
    figure.draw_without_rendering()
    inches = panel.get_tightbbox(renderer).transformed(figure.dpi_scale_trans.inverted())
    box = Bbox.from_extents(*(inches.min - 0.03), *(inches.max + 0.03))
    drawn = io.BytesIO()
    savefig(figure, drawn, bbox_inches=box, dpi=SIDE / max(box.size), format="png")
    picture, square = Image.open(drawn).convert("RGB"), Image.new("RGB", (SIDE, SIDE), "white")
    picture.thumbnail((SIDE, SIDE))
    square.paste(picture, ((SIDE - picture.width) // 2, (SIDE - picture.height) // 2))
    return square


def mark_film(square) -> None:
    """Mark the thumbnail of a page that has a film."""
    pen = ImageDraw.Draw(square)
    pen.ellipse((SIDE - 58, SIDE - 58, SIDE - 10, SIDE - 10), fill="#4a5560")
    pen.polygon(
        [(SIDE - 41, SIDE - 47), (SIDE - 41, SIDE - 21), (SIDE - 20, SIDE - 34)], fill="white"
    )


thumbnails = Thumbnails()


class Order:
    """Sorts the examples of a section: those of `FIRST` in that order, then the others by name."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, file):
        """Return its place."""
        stem = Path(file).stem
        return (FIRST.index(stem) if stem in FIRST else len(FIRST), stem)
