"""How the examples become a gallery: their pictures, and the order in which they stand."""

from __future__ import annotations

from pathlib import Path

from sphinx_gallery.scrapers import figure_rst

WRITTEN = "out/examples"  # where `main` of an example writes by default, from its own folder here
FIRST = (  # of each section; the others follow by name
    "bouncing_sphere", "die", "own_force", "restitution_laws", "newtons_cradle", "counting_pi",
    "draw_shot", "ladder", "off_a_sphere", "rocking_block", "overhang", "arch", "trammel", "planetary_gear",
    "dice_study",
)  # fmt: skip


def pictures(block, block_vars, gallery_conf):
    """Move the picture that an example has written into its page, and leave no trace beside the example."""
    source = Path(block_vars["src_file"])
    folder = source.parent / WRITTEN
    made = folder / f"{source.stem}.png"
    if not made.exists():
        return ""
    place = Path(next(block_vars["image_path_iterator"]))
    place.write_bytes(made.read_bytes())
    made.unlink()
    for empty in (folder, folder.parent):
        if not any(empty.iterdir()):
            empty.rmdir()
    return figure_rst([place], gallery_conf["src_dir"])


class Order:
    """Sorts the examples of a section: those of `FIRST` in that order, then the others by name."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, file):
        """Return its place."""
        stem = Path(file).stem
        return (FIRST.index(stem) if stem in FIRST else len(FIRST), stem)
