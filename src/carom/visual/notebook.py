"""What notebooks show of scenes, runs, ensembles and tables: HTML that loads nothing, static pages included."""

from __future__ import annotations

import base64
import dataclasses
import html
import io
from collections.abc import Callable, Iterable
from functools import singledispatch
from typing import Any

import numpy as np

from carom.generalized.solution import CoordinateImpactTable, GeneralizedSolution
from carom.impact.api import Impact
from carom.results.event_tables import ImpactRecord, ImpactTable
from carom.results.ledger import Ledger
from carom.results.solution import Solution
from carom.scene.bodies import Body
from carom.scene.scene import Scene
from carom.scene.summary import KINDS, counts
from carom.scene.table import Table
from carom.studies.ensembles.result import Ensemble
from carom.visual.bodies import colour_of

MOST_BYTES = 2_000_000  # of a page: it becomes a part of the notebook
FRAMES, FEWEST_FRAMES = 1500, 100  # of a run in such a page, at most and at least
POSE_NUMBERS = 300_000  # numbers of all poses together, with which most pages are small enough
SHOWN_ROWS = 10  # rows of a table that are shown
LISTED_PARTS = 40  # parts of a scene of each kind that are listed
PICTURE_SIZE = (800, 400)  # pixels of a picture
#: nothing of the page reaches the notebook, and nothing of the notebook's style the page
FRAME = (
    '<iframe srcdoc="{}" sandbox="allow-scripts" title="carom" style="width: 100%; height: 520px; '
    'border: 1px solid #d9e0e6; border-radius: 6px; background: white"></iframe>'
)
CELL = "padding: 2px 8px; text-align: right; white-space: nowrap"


@singledispatch
def html_of(thing) -> str:
    """Return an object as HTML; by default its text."""
    return f"<pre>{html.escape(repr(thing))}</pre>"


@html_of.register
def _(solution: Solution) -> str:
    """Return the page of a run in a frame of its own; of one that is too large, a picture and a sentence."""
    from carom.visual.viewer.page import page_text
    from carom.visual.viewer.show import show_of

    fitting = POSE_NUMBERS // (7 * len(solution.scene.bodies))
    text = page_text(show_of(solution, most=max(FEWEST_FRAMES, min(FRAMES, fitting))))
    size = len(text.encode())
    if size <= MOST_BYTES:
        text = text.replace("&", "&amp;").replace('"', "&quot;")
        return FRAME.format(text) + _said(repr(solution))
    more = f'Its page has {size / 1e6:.0f} MB: carom.view(solution, export="run.html") writes it.'
    return _still(solution, float(solution.t[-1])) + _said(f"{solution!r} {more}")


@html_of.register
def _(solution: GeneralizedSolution) -> str:
    """Return the coordinates over time as a picture, and a sentence."""
    return _picture(lambda: _overview(solution), "Coordinates and energies over time") + _said(
        repr(solution)
    )


@html_of.register
def _(scene: Scene) -> str:
    """Return a picture of a scene and the list of its parts."""
    picture = _still(Start(scene), 0.0) if scene.bodies else ""
    listed = ""
    for kind in KINDS:
        parts = getattr(scene, kind)
        lines = [_swatch(p) + _text(repr(p)) for p in parts[:LISTED_PARTS]]
        lines += [f"and {len(parts) - LISTED_PARTS} more"] if len(parts) > LISTED_PARTS else []
        listed += "".join(f"<li>{line}</li>" for line in lines)
    about = f"Scene with gravity {scene.gravity} m/s²: {counts(scene)}"
    return picture + _said(about) + f"<ul style='margin: 0'>{listed}</ul>"


@html_of.register
def _(ensemble: Ensemble) -> str:
    """Return how many runs ended how, and of each input and outcome the mean and the bounds."""
    varied = {f"input: {name}": values for name, values in ensemble.inputs.items()}
    names = [n for n in ensemble.outcomes.dtype.names or () if n != "status"]
    columns = {**varied, **{n: ensemble.outcomes[n] for n in names}, **ensemble.observed}
    made, rows = ensemble.done, []
    for name, column in columns.items():
        if column.ndim != 1 or column.dtype.kind not in "iufb":
            continue  # states of all bodies, names of laws
        known = column[made & np.isfinite(column)]
        if len(known):
            rows.append((name, known.mean(), known.std(), known.min(), known.max(), len(known)))
    head = ("", "mean", "deviation", "least", "greatest", "runs")
    return _said(repr(ensemble)) + _table(head, rows)


@html_of.register(ImpactTable)
@html_of.register(CoordinateImpactTable)
def _(table) -> str:
    """Return the impacts: velocities before and after, impulse, energy."""
    head = (
        "", "time [s]", "contact", "u<sub>n</sub> before", "after", "slip before", "after", "impulse",
        "energy [J]",
    )  # fmt: skip

    def row(k):
        before, after = table.relative_velocity_before[k], table.relative_velocity_after[k]
        slips = np.hypot(*before[1:]), np.hypot(*after[1:])
        name = getattr(table, "name", table.contact)[k]
        push = np.linalg.norm(table.impulse[k])
        energy = table.energy_change[k]
        return k, table.time[k], name, before[0], after[0], *slips, push, energy

    return _said(f"{len(table)} impacts") + _table(head, _first(row, len(table)), len(table))


@html_of.register
def _(table: Table) -> str:
    """Return the first rows of a table."""
    columns = table._columns()

    def row(k):
        return (k, *(column[k] for column in columns.values()))

    head = ("", *map(html.escape, columns))
    return _said(f"{type(table).__name__}: {len(table)} rows") + _table(
        head, _first(row, len(table)), len(table)
    )


@html_of.register
def _(ledger: Ledger) -> str:
    """Return the energies at the start and at the end, and what changed them."""
    names = [one.name for one in dataclasses.fields(ledger)] + ["residual"]
    columns = [(name, getattr(ledger, name)) for name in names]
    rows = [(name, c[0], c[-1], np.abs(c).max()) for name, c in columns]
    return _said("Energy balance [J]") + _table(("", "start", "end", "greatest"), rows)


@html_of.register(Impact)
@html_of.register(ImpactRecord)
def _(impact) -> str:
    """Return the results of an impact."""
    record = isinstance(impact, ImpactRecord)
    names = impact._fields if record else [f.name for f in dataclasses.fields(impact) if f.repr]
    fields = [(name.replace("_", " "), getattr(impact, name)) for name in names]
    rows = [(n, ", ".join(v) if isinstance(v, tuple) else v) for n, v in fields]
    return _said("Impact, in contact axes: normal, tangent 1, tangent 2") + _table(("", ""), rows)


class Start:
    """A scene before its motion, with all that a picture needs of a run."""

    def __init__(self, scene: Scene):
        self.scene, self.t, none = scene, np.zeros(1), np.zeros((0, 3))
        self.impacts = _Rows(time=none[:, 0], point=none, impulse=none, contact=none[:, 0])
        self.forces = _Rows(saved=none[:, 0], point=none)
        self.pairs = _Rows(body=none[:, 0])

    def _curve(self, t):
        """Return the initial state at times (n,) or at one time."""
        names = ("position", "orientation", "velocity", "angular_velocity")
        rows = [np.array([getattr(body, name) for body in self.scene.bodies]) for name in names]
        return tuple(np.broadcast_to(row, (*np.shape(t), *row.shape)) for row in rows)


class _Rows:
    """A table without rows."""

    def __init__(self, **columns: np.ndarray):
        vars(self).update(columns)

    def __len__(self) -> int:
        return 0


def _still(run, t: float) -> str:
    """Return a picture of a run at a time."""

    def drawn() -> bytes:
        from carom.visual.films.stage import Stage, pillow

        file = io.BytesIO()
        pillow()[0].fromarray(Stage(run, PICTURE_SIZE).draw(t, clock=False)).save(file, "PNG")
        return file.getvalue()

    return _picture(drawn, f"Bodies at t = {t:g} s")


def _overview(solution) -> bytes:
    from carom.visual.plots import overview

    file = io.BytesIO()
    figure = next(iter(overview(solution).values())).figure
    figure.savefig(file, dpi=100)
    from matplotlib import pyplot

    pyplot.close(figure)
    return file.getvalue()


def _picture(draw: Callable[[], bytes], words: str) -> str:
    """Return a picture that needs an optional package; without it the line that installs it."""
    try:
        data = base64.b64encode(draw()).decode("ascii")
    except ImportError as error:
        return _said(str(error))
    look = f'alt="{html.escape(words)}" style="max-width: 100%; width: {PICTURE_SIZE[0]}px"'
    return f'<img src="data:image/png;base64,{data}" {look}>'


def _said(text: str) -> str:
    return f"<p style='margin: 4px 0'>{_text(text)}</p>"


def _swatch(part) -> str:
    """Return a square in the colour of a part, if it has one."""
    colour = colour_of(part) if isinstance(part, Body) else getattr(part, "color", None)
    return f"<span style='color: {colour}'>&#9632;</span> " if colour else ""


def _first(row: Callable[[int], Any], count: int) -> list:
    return [row(k) for k in range(min(count, SHOWN_ROWS))]


def _table(head: Iterable[str], rows: list, count: int | None = None) -> str:
    """Return a table, and how many of its `count` rows are not shown; `head` is HTML."""
    lines = ["".join(f"<th style='{CELL}'>{name}</th>" for name in head)] if any(head) else []
    lines += ["".join(f"<td style='{CELL}'>{_text(_brief(x))}</td>" for x in row) for row in rows]
    more = (count or 0) - len(rows)
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f"<table>{body}</table>" + (_said(f"and {more} more") if more > 0 else "")


def _brief(value) -> str:
    if isinstance(value, np.ndarray):
        return np.array2string(value, precision=5)
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)


def _text(text: str) -> str:
    """Return text as HTML; signs of mathematics in a name are no formulas."""
    return html.escape(text).replace("$", "&#36;")
