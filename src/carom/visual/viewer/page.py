"""A run as one HTML file that plays without Python and without a network."""

from __future__ import annotations

import html
import os
from importlib import resources
from pathlib import Path
from string import Template
from typing import NamedTuple

import numpy as np

import carom
from carom import checks
from carom.io.files.disk import put
from carom.visual.bodies import colour_of
from carom.visual.dice import pip_colour
from carom.visual.viewer.pack import Packer, header_text
from carom.visual.viewer.show import FORCE, IMPULSE, Show, body_number, playing_speed
from carom.visual.viewer.strikes import Inside, insides_of

SCRIPTS = (
    "space", "data", "motion", "meshes", "shaders", "draw", "camera", "paint", "chart", "impacts",
    "play", "controls",
)  # fmt: skip
CURVE_POINTS = 1500  # of the curves of energy


class Exported(NamedTuple):
    """The result of an export."""

    path: Path  #: path of the file
    size: int  #: size of the file [bytes]
    left_out: list[str]  #: descriptions of data that are not shown completely

    def __str__(self) -> str:
        size = f"{self.size / 1e6:.1f} MB" if self.size >= 1e6 else f"{self.size / 1e3:.0f} kB"
        shown = f"; shown are {', '.join(self.left_out)}" if self.left_out else ""
        return f"{self.path}: {size}{shown}"


SUFFIXES = (".html", ".htm")
FILM, MODEL = "; a film is made by carom.film", "; such a file is made by solution.export"
OTHERS = {".mp4": FILM, ".gif": FILM, ".glb": MODEL, ".pvd": MODEL}  # what writes other files


def write_page(
    show: Show, path: str | os.PathLike, follow: str | None, speed: float | None
) -> Exported:
    """Write the page of a run."""
    where = checks.file_to_write("export", path)
    if where.suffix.lower() not in SUFFIXES:
        more = OTHERS.get(where.suffix.lower(), "")
        raise ValueError(f"export must end in .html, got {checks.shown(str(where))}{more}")
    text = page_text(show, follow, speed)
    data = text.encode("utf-8")
    put(where, [data])
    return Exported(where, len(data), show.left_out)


def page_text(show: Show, follow: str | None = None, speed: float | None = None) -> str:
    """Return the page of a run."""
    packer = Packer()
    head = header(show, packer)
    head["follow"] = body_number(show, follow)
    head["speed"] = speed or playing_speed(float(show.frames.time[-1] - show.frames.time[0]))
    own = resources.files("carom.visual.viewer") / "page"
    return Template((own / "page.html").read_text("utf-8")).substitute(
        title=html.escape(show.title),
        version=carom.__version__,
        style=(own / "page.css").read_text("utf-8"),
        script="\n".join((own / f"{name}.js").read_text("utf-8") for name in SCRIPTS),
        header=header_text(head),
        data=packer.block(),
    )


def header(show: Show, packer: Packer) -> dict:
    """Return the header of the page, and put its arrays into `packer`."""
    solution, frames, place = show.solution, show.frames, show.place
    colours = [colour_of(body) for body in solution.scene.bodies]
    return {
        "title": show.title,
        "note": "; ".join(show.left_out),
        "longest": show.longest,
        "status": " ".join(solution.warnings) if solution.success else solution.message,
        "colours": {
            "bodies": colours, "pips": [pip_colour(one) for one in colours],
            "impulse": IMPULSE, "force": FORCE,
        },
        "bodies": [body.name for body in solution.scene.bodies],
        "sizes": [float(size) for size in show.sizes],
        "place": {
            "centre": place.centre.tolist(), "radius": place.radius,
            "up": place.up.tolist(), "side": place.side.tolist(), "lift": place.lift,
        },
        "time": packer.add(frames.time, "f8"),
        # from the centre: single precision is enough near it
        "position": packer.add(frames.position - place.centre),
        "orientation": packer.add(frames.orientation),
        "parts": [
            {
                "vertices": packer.add(part.vertices - (place.centre if part.look == "static" else 0.0)),
                "triangles": packer.add(part.triangles, "i4"),
                "bodies": part.bodies,
                "look": part.look,
                "colour": part.colour,
            }
            for part in show.parts
        ],
        "planes": [
            {
                "corners": (p.corners - place.centre).tolist(),
                "normal": p.normal.tolist(),
                "colour": p.colour,
            }
            for p in show.planes
        ],
        "links": [_link(link, place.centre, frames.time) for link in show.links],
        "energy": _energy(solution, packer),
        "impacts": _impacts(show, packer),
        "persistent": {
            "time": packer.add(show.persistent.time, "f8"),
            "first": packer.add(show.persistent.first, "i4"),
            "point": packer.add(show.persistent.point - place.centre),
            "force": packer.add(show.persistent.force),
        },
    }  # fmt: skip


def _link(link, centre: np.ndarray, time: np.ndarray) -> dict:
    """Return a spring, rod or cord; points of the ground from the centre, as all points of the world.

    Times at which it is there are cut off beyond those that are shown, which JSON could not state.
    """
    spans = None if link.there is None else np.clip(link.there, time[0] - 1.0, time[-1] + 1.0)
    ends = (link.parent, link.parent_anchor), (link.child, link.child_anchor)
    anchors = [(anchor if body >= 0 else anchor - centre).tolist() for body, anchor in ends]
    sides = [link.parent, link.child]
    made = {"bodies": sides, "anchors": anchors, "kind": link.kind, "length": link.length}
    made["there"] = None if spans is None else spans.tolist()
    return made | {"radii": link.radii.tolist(), "axis": link.axis.tolist()}


def _energy(solution, packer: Packer) -> dict:
    """Return the energies at saved times, thinned."""
    last = len(solution.t) - 1
    chosen = np.unique(np.linspace(0, last, min(last + 1, CURVE_POINTS)).round().astype(int))
    potential = solution.potential_energy[chosen]
    return {
        "time": packer.add(solution.t[chosen], "f8"),
        "kinetic": packer.add(solution.kinetic_energy[chosen]),
        "potential": packer.add(potential - np.min(potential)),
    }


def _impacts(show: Show, packer: Packer) -> dict:
    """Return the impacts that are shown, and of the strongest the inside."""
    impacts, strikes = show.solution.impacts, show.strikes
    k = strikes.number
    insides = insides_of(show.solution, strikes)
    return {
        "number": k.tolist(),
        "contact": strikes.contact,
        "time": packer.add(impacts.time[k], "f8"),
        "point": packer.add(impacts.point[k] - show.place.centre),
        "arrow": packer.add(strikes.arrow),
        "before": packer.add(impacts.relative_velocity_before[k]),
        "after": packer.add(impacts.relative_velocity_after[k]),
        "impulse": packer.add(impacts.impulse[k]),
        "energy": packer.add(impacts.energy_change[k]),
        "turning": strikes.turning.tolist(),
        "together": impacts.together[k].tolist(),
        "located": impacts.located[k].tolist(),
        "inside": _insides(insides, packer),
    }


def _insides(insides: dict[int, Inside], packer: Packer) -> dict:
    """Return all insides one after the other: that of `number[i]` from `first[i]` to `first[i + 1]`."""
    them = list(insides.values())
    rows = np.cumsum([0, *(len(inside.time) for inside in them)])
    columns = {name: [getattr(one, name) for one in them] for name in ("time", "velocity", "force")}
    return {
        "number": list(insides),
        "phases": [inside.phases for inside in them],
        "first": rows.tolist(),
        **{name: packer.add(np.concatenate(c) if c else []) for name, c in columns.items()},
    }
