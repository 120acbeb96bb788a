"""The table of numbers: exact or independent value, the paper's method, the production method."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from carom import impact_layer, resolve_impact
from carom.impact.geometry import NormalMotion
from carom.paper.layer import first_impact, hht, least_steps
from carom.paper.references import Bounce, die_after, die_impact
from carom.paper.runs import FRICTIONS, STEP, die_run, sphere_run

METHODS = ("paper", "rk4")
ALPHAS = (0.0, 0.05, 0.1, 0.2, 0.3)
COUNTS = (8, 20, 40, 80, 320)
FINE = 512  # spline steps of the rows that show the paper's method converged


class Row(NamedTuple):
    """One quantity; None where a method has no such number."""

    quantity: str
    unit: str
    source: str
    reference: float
    paper: float | None
    production: float | None
    tolerance: float  # of the errors of both methods, except where `quantity` says two spline steps

    @property
    def errors(self) -> tuple[float | None, float | None]:
        """Absolute errors of both methods."""
        reference = self.reference
        return tuple(
            None if x is None else abs(x - reference) for x in (self.paper, self.production)
        )  # type: ignore[return-value]


@cache
def rows() -> tuple[Row, ...]:
    """Return the whole table."""
    return (*_sphere(), *_layer(), *_planar(), *_spatial())


def _sphere():
    form = "closed form"
    for e in (1.0, 0.8):
        exact = Bounce(e)
        runs = [sphere_run(e, method) for method in METHODS]
        times = [run.impacts.time for run in runs]
        after = [run.impacts.relative_velocity_after[:, 0] for run in runs]
        last = 5 if e == 1.0 else 6
        for k in (1, last):
            yield Row(f"sphere, e = {e:g}: time of impact {k}", "s", form, exact.times(k)[-1],
                      *(t[k - 1] for t in times), 1e-10)  # fmt: skip
            yield Row(f"sphere, e = {e:g}: speed after impact {k}", "m/s", form,
                      exact.speed * e**k, *(v[k - 1] for v in after), 1e-10)  # fmt: skip
    exact = Bounce(0.8)
    runs = [sphere_run(0.8, method) for method in METHODS]
    for k in range(1, 5):
        top = exact.times(k)[-1] + exact.speed * 0.8**k / exact.gravity
        yield Row(f"sphere, e = 0.8: apex {k}", "m", form, exact.drop * 0.8 ** (2 * k),
                  *(run.evaluate(top)[0][0, 2] - 0.1 for run in runs), 1e-9)  # fmt: skip
    held = [run.events.time[run.events.kind == "held"][0] for run in runs]
    yield Row(f"sphere, e = 0.8: comes to rest (within a step of {STEP:g} s)", "s", form, exact.rest,
              *held, STEP)  # fmt: skip
    moved = [np.max(np.abs(r.position[r.t > h, 0, 2] - 0.1)) for r, h in zip(runs, held)]
    yield Row("sphere, e = 0.8: greatest gap afterwards", "m", form, 0.0, *moved, 1e-12)
    long = [sphere_run(1.0, method, duration=57.5) for method in METHODS]
    assert all(len(run.impacts) >= 100 for run in long)
    drift = [np.ptp(run.total_energy[run.t <= run.impacts.time[99] + STEP]) for run in long]
    yield Row("sphere, e = 1: relative change of energy over 100 impacts", "", form, 0.0,
              *(d / run.total_energy[0] for d, run in zip(drift, long)), 1e-10)  # fmt: skip


def _layer():
    """Law A in closed form; `resolve_impact` has the velocity at exit, but no path."""
    exact, _ = first_impact()
    v, b, delta = exact.approach_speed, exact.width, exact.penetration
    W, u = np.eye(3), np.array([-v, 0.0, 0.0])
    exits, least, path, direct, rate = [], [], [], [], []
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
    form = "closed form"
    yield Row("layer, 2 spline steps, e = 1: greatest error of x / b", "", form, 0.0, path[0], None,
              1e-13)  # fmt: skip
    yield Row("layer, 2 spline steps, e = 1: greatest error of u_n / v0", "", form, 0.0, rate[0], None,
              1e-13)  # fmt: skip
    yield Row("layer, least x / b (worst of e = 1 ... 0.01)", "", form, 1.0 - delta,
              max(least, key=lambda x: abs(x - 1.0 + delta)), None, 1e-12)  # fmt: skip
    yield Row("layer, exit speed / (e v0) (worst of e = 1 ... 0.01)", "", form, 1.0,
              *(max(values, key=lambda x: abs(x - 1.0)) for values in (exits, direct)), 1e-12)  # fmt: skip


_STATE = ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z")
_UNITS = ("m/s",) * 3 + ("rad/s",) * 3


def _after(run):
    _, _, v, w = run.evaluate(run.impacts.time[0])
    return np.concatenate([v[0], w[0]])


def _planar():
    for mu in FRICTIONS:
        runs = [die_run(mu, "planar", method) for method in METHODS]
        if mu == FRICTIONS[0]:
            yield Row("planar die: time of impact 1", "s", "root of the flight",
                      die_impact("planar").time, *(r.impacts.time[0] for r in runs), 1e-8)  # fmt: skip
        exact, found = die_after("planar", mu), [_after(run) for run in runs]
        for k in (0, 2, 4):
            yield Row(f"planar die, mu = {mu:.2f}: {_STATE[k]} after impact 1", _UNITS[k],
                      "Routh, closed form", exact[k], *(f[k] for f in found), 1e-8)  # fmt: skip
        off = [_out_of_plane(run) for run in runs]
        yield Row(f"planar die, mu = {mu:.2f}: greatest abs(y) through impacts 1 to 3", "m", "symmetry",
                  0.0, *off, 1e-12)  # fmt: skip


def _out_of_plane(run) -> float:
    third = run.impacts.time[2] + STEP
    return float(np.max(np.abs(run.position[run.t <= third, 0, 1])))


def _spatial():
    source = "independent integration (Darboux-Keller)"
    for mu in FRICTIONS:
        fine = die_run(mu, "spatial", layer_steps=FINE)
        default = die_run(mu, "spatial", "rk4")
        exact = die_after("spatial", mu)
        if mu == FRICTIONS[0]:
            yield Row("spatial die: time of impact 1", "s", "root of the flight",
                      die_impact("spatial").time, fine.impacts.time[0], default.impacts.time[0],
                      1e-8)  # fmt: skip
        for k in range(6):
            yield Row(f"spatial die, mu = {mu:.2f}: {_STATE[k]} after impact 1, {FINE} spline steps",
                      _UNITS[k], source, exact[k], _after(fine)[k], _after(default)[k],
                      1e-8)  # fmt: skip
        two = die_run(mu, "spatial")
        for k in (0, 5):
            yield Row(f"spatial die, mu = {mu:.2f}: {_STATE[k]} after impact 1, 2 spline steps",
                      _UNITS[k], source, exact[k], _after(two)[k], None, 1e-2)  # fmt: skip


def hht_rows() -> list[tuple]:
    """For each alpha: alpha, first step count that completes, errors of velocity at `COUNTS`."""
    return [
        (alpha, least_steps(alpha), *(hht(n, alpha).velocity_error for n in COUNTS))
        for alpha in ALPHAS
    ]


def write(folder: Path) -> list[Path]:
    """Write table.csv, hht.csv and table.md."""
    files = [folder / name for name in ("table.csv", "hht.csv", "table.md")]
    head = ("quantity", "unit", "reference", "source", "method paper", "error", "method rk4",
            "error", "tolerance")  # fmt: skip
    with files[0].open("w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(head)
        for r in rows():
            out.writerow((r.quantity, r.unit, repr(float(r.reference)), r.source,
                          _full(r.paper), _full(r.errors[0]), _full(r.production),
                          _full(r.errors[1]), r.tolerance))  # fmt: skip
    hht_head = ("alpha", "first completing steps", *(f"error at {n} steps" for n in COUNTS))
    found = hht_rows()
    with files[1].open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([hht_head, *found])
    lines = ["# Numbers", "", _line(head), _line(["---"] * len(head))]
    lines += [
        _line((r.quantity, r.unit, f"{r.reference:.12g}", r.source, _number(r.paper),
               _error(r.errors[0]), _number(r.production), _error(r.errors[1]), f"{r.tolerance:.0e}"))
        for r in rows()
    ]  # fmt: skip
    lines += [
        "", "Errors are absolute. `method=\"paper\"`: three fields, return map, boundary layer by two cubic-",
        "spline steps unless the row says otherwise; `rk4` is the default, with impacts solved to round-off.",
        "", "## HHT-alpha in the boundary layer", "",
        "First impact of the sphere, e = 1, delta = 0.8; greatest error of the velocity at its steps, divided",
        "by the speed of entry (two spline steps: exact). The count at which it first completes is computed.",
        "", _line(hht_head), _line(["---"] * len(hht_head)),
        *(_line((f"{row[0]:g}", row[1], *(f"{x:.3g}" for x in row[2:]))) for row in found),
        "", "From alpha = 0.1 on the first count that completes does so by a jump over the whole layer in one",
        "step, with an error above 100 %; 6 and 7 steps fail again, and proper runs begin with 8.", "",
    ]  # fmt: skip
    files[2].write_text("\n".join(lines), encoding="utf-8")
    return files


def _line(cells) -> str:
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def _full(value) -> str:
    return "" if value is None else repr(float(value))


def _number(value) -> str:
    return "-" if value is None else f"{value:.12g}"


def _error(value) -> str:
    return "-" if value is None else f"{value:.1e}"
