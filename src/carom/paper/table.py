"""The table of numbers: the exact or independent value, the paper's method, and the production method."""

from __future__ import annotations

import csv
import io
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from carom import impact_layer, resolve_impact
from carom.impact.geometry import NormalMotion
from carom.io.files.disk import put
from carom.paper.figure import page, table
from carom.paper.layer import first_impact, hht, least_steps
from carom.paper.references import Bounce, die_after, die_impact
from carom.paper.runs import FRICTIONS, STEP, after_first_impact, die_run, sphere_run

METHODS = ("paper", "rk4")
ALPHAS = (0.0, 0.05, 0.1, 0.2, 0.3)
COUNTS = (8, 20, 40, 80, 320)
FINE = 512  # spline steps of the rows with the converged result of the paper's method


class Row(NamedTuple):
    """One quantity; the value is None if a method has no such number."""

    quantity: str
    unit: str
    source: str
    reference: float
    values: tuple[float | None, ...]  # by the paper's method, by the production method
    tolerance: float  # of the errors of both methods

    @property
    def errors(self) -> tuple[float | None, ...]:
        """The absolute errors of both methods."""
        return tuple(None if x is None else abs(x - self.reference) for x in self.values)


@cache
def rows() -> tuple[Row, ...]:
    """Return the whole table."""
    return (*_sphere(), *_layer(), *_planar(), *_spatial())


def _sphere():
    form = "closed form"
    for e in (1.0, 0.8):
        exact, name = Bounce(e), f"sphere, e = {e:g}"
        runs = [sphere_run(e, method) for method in METHODS]
        for k in (1, 5 if e == 1.0 else 6):
            times = tuple(run.impacts.time[k - 1] for run in runs)
            speeds = tuple(run.impacts.relative_velocity_after[k - 1, 0] for run in runs)
            yield Row(f"{name}: time of impact {k}", "s", form, exact.times(k)[-1], times, 1e-10)
            after = exact.speed * e**k
            yield Row(f"{name}: speed after impact {k}", "m/s", form, after, speeds, 1e-10)
    exact, name = Bounce(0.8), "sphere, e = 0.8"
    runs = [sphere_run(0.8, method) for method in METHODS]
    for k in range(1, 5):
        top = exact.times(k)[-1] + exact.speed * 0.8**k / exact.gravity
        found = tuple(run.evaluate(top)[0][0, 2] - 0.1 for run in runs)
        yield Row(f"{name}: apex {k}", "m", form, exact.drop * 0.8 ** (2 * k), found, 1e-9)
    at_rest = tuple(run.events.time[run.events.kind == "held"][0] for run in runs)
    yield Row(f"{name}: comes to rest (within a step)", "s", form, exact.rest, at_rest, STEP)
    moved = tuple(np.max(np.abs(r.position[r.t > h, 0, 2] - 0.1)) for r, h in zip(runs, at_rest))
    yield Row(f"{name}: greatest gap afterwards", "m", form, 0.0, moved, 1e-12)
    drift = tuple(_drift(sphere_run(1.0, method, duration=57.5), 100) for method in METHODS)
    quantity = "sphere, e = 1: relative change of energy over 100 impacts"
    yield Row(quantity, "", form, 0.0, drift, 1e-10)


def _drift(run, impacts: int) -> float:
    """Return the relative spread of the energy over this number of impacts."""
    until = run.impacts.time[impacts - 1] + STEP
    return float(np.ptp(run.total_energy[run.t <= until]) / run.total_energy[0])


def _layer():
    """Compare with the closed form of law A; `resolve_impact` gives the velocity at exit, but no path."""
    entry, _ = first_impact()
    v, b, delta = entry.approach_speed, entry.width, entry.penetration
    W, u = np.eye(3), np.array([-v, 0.0, 0.0])
    exits, least, path, rate, direct = [], [], [], [], []
    for e in (1.0, 0.8, 0.5, 0.1, 0.01):
        run = impact_layer(W, u, 0.0, e, penetration=delta, width=b, steps=2)
        motion = NormalMotion(v, e, b, delta)
        t = np.linspace(0.0, run.duration, 1001)
        x, velocity = run.evaluate(t)
        path.append(np.max(np.abs(x - motion.x(t))) / b)
        rate.append(np.max(np.abs(velocity[:, 0] - motion.normal_velocity(t))) / v)
        exits.append(run.velocity_after[0] / (e * v))
        least.append(run.x.min() / b)
        direct.append(resolve_impact(W, u, 0.0, e).velocity_after[0] / (e * v))
    form, two = "closed form", "layer, 2 spline steps, e = 1: greatest error of"
    yield Row(f"{two} x / b", "", form, 0.0, (path[0], None), 1e-13)
    yield Row(f"{two} u_n / v0", "", form, 0.0, (rate[0], None), 1e-13)
    lowest = _farthest(least, 1.0 - delta)
    worst = "(worst of e = 1 ... 0.01)"
    yield Row(f"layer, least x / b {worst}", "", form, 1.0 - delta, (lowest, None), 1e-12)
    ends = (_farthest(exits, 1.0), _farthest(direct, 1.0))
    yield Row(f"layer, exit speed / (e v0) {worst}", "", form, 1.0, ends, 1e-12)


def _farthest(values, reference: float) -> float:
    return max(values, key=lambda x: abs(x - reference))


_STATE = ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z")
_UNITS = ("m/s",) * 3 + ("rad/s",) * 3


def _planar():
    source = "Routh, closed form"
    for mu in FRICTIONS:
        name = f"planar die, mu = {mu:.2f}"
        runs = [die_run(mu, "planar", method) for method in METHODS]
        if mu == FRICTIONS[0]:
            yield _first("planar", runs)
        exact, found = (
            die_after("planar", mu),
            [after_first_impact(run) for run in runs],
        )
        for k in (0, 2, 4):
            values = tuple(state[k] for state in found)
            quantity = f"{name}: {_STATE[k]} after impact 1"
            yield Row(quantity, _UNITS[k], source, exact[k], values, 1e-8)
        off = tuple(_out_of_plane(run) for run in runs)
        quantity = f"{name}: greatest abs(y) through impacts 1 to 3"
        yield Row(quantity, "m", "symmetry", 0.0, off, 1e-12)


def _first(kind: str, runs) -> Row:
    times = tuple(run.impacts.time[0] for run in runs)
    exact = die_impact(kind).time
    return Row(f"{kind} die: time of impact 1", "s", "root of the flight", exact, times, 1e-8)


def _out_of_plane(run) -> float:
    third = run.impacts.time[2] + STEP
    return float(np.max(np.abs(run.position[run.t <= third, 0, 1])))


def _spatial():
    source = "Darboux-Keller, independent integration"
    for mu in FRICTIONS:
        name = f"spatial die, mu = {mu:.2f}"
        fine, default = die_run(mu, "spatial", layer_steps=FINE), die_run(mu, "spatial", "rk4")
        if mu == FRICTIONS[0]:
            yield _first("spatial", (fine, default))
        exact, two = (
            die_after("spatial", mu),
            after_first_impact(die_run(mu, "spatial")),
        )
        found = (after_first_impact(fine), after_first_impact(default))
        for k in range(6):
            values = tuple(state[k] for state in found)
            quantity = f"{name}: {_STATE[k]} after impact 1, {FINE} spline steps"
            yield Row(quantity, _UNITS[k], source, exact[k], values, 1e-8)
        for k in (0, 5):
            quantity = f"{name}: {_STATE[k]} after impact 1, 2 spline steps"
            yield Row(quantity, _UNITS[k], source, exact[k], (two[k], None), 1e-2)


def hht_rows() -> list[tuple]:
    """Return for each alpha: alpha, the least complete number of steps, errors of velocity at `COUNTS`."""
    return [
        (alpha, least_steps(alpha), *(hht(n, alpha).velocity_error for n in COUNTS))
        for alpha in ALPHAS
    ]


_HEAD = (
    "quantity", "unit", "reference", "source", "method paper", "error", "method rk4", "error",
    "tolerance",
)  # fmt: skip
_HHT_HEAD = ("alpha", "first completing steps", *(f"error at {n} steps" for n in COUNTS))


def write(folder: Path) -> list[Path]:
    """Write table.csv, hht.csv and table.md."""
    files = [folder / name for name in ("table.csv", "hht.csv", "table.md")]
    full, short, hht_short = [], [], []
    for r in rows():
        pairs = list(zip(r.values, r.errors))
        exact = [_full(x) for pair in pairs for x in pair]
        shown = [cell for x, error in pairs for cell in (_number(x), _error(error))]
        full.append((r.quantity, r.unit, _full(r.reference), r.source, *exact, r.tolerance))
        first = (r.quantity, r.unit, f"{r.reference:.12g}", r.source)
        short.append((*first, *shown, f"{r.tolerance:.0e}"))
    found = hht_rows()
    for alpha, least, *errors in found:
        hht_short.append((f"{alpha:g}", least, *(f"{x:.3g}" for x in errors)))
    for path, content in ((files[0], [_HEAD, *full]), (files[1], [_HHT_HEAD, *found])):
        out = io.StringIO(newline="")
        csv.writer(out).writerows(content)
        put(path, [out.getvalue().encode()])
    text = page("table", table=table(_HEAD, short), hht=table(_HHT_HEAD, hht_short))
    put(files[2], [text.encode()])
    return files


def _full(value) -> str:
    return "" if value is None else repr(float(value))


def _number(value) -> str:
    return "-" if value is None else f"{value:.12g}"


def _error(value) -> str:
    return "-" if value is None else f"{value:.1e}"
