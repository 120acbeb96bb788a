"""Errors of the tasks of SimBenchmark, beside those that its authors published in 2018.

    python benchmarks/simbenchmark.py            measure, write benchmarks/published, the table and the picture
    python benchmarks/simbenchmark.py --keep     the table and the picture from the files
    python benchmarks/simbenchmark.py bouncing   this task alone

The picture is docs/_static/simbenchmark.png, the table is put into docs/published/simbenchmark.md by
``python benchmarks/all.py --docs --keep``.
"""

from __future__ import annotations

import argparse
import csv
import warnings
from pathlib import Path
from typing import NamedTuple

import carom
from carom.visual.plots import style
from common import FEW, OUT, clock, report
from simbenchmark_tasks import TASKS

PUBLISHED = Path(__file__).parent / "published"
THEIRS, OURS = PUBLISHED / "simbenchmark.csv", PUBLISHED / "simbenchmark_carom.csv"
TOOLS = "RaiSim", "Bullet", "ODE", "MuJoCo Euler", "MuJoCo RK4", "DART"
COLOURS = style.GREEN, style.SKY, style.PURPLE, style.ORANGE, style.RED, style.GREY
SETTINGS = 1e-8, 1e-10  # tolerances


NOTES = """
In brackets the time of that run: carom's, once, on the machine of the first line, the others' on that of their
authors.
"""


class Point(NamedTuple):
    """An error, and the time that it took."""

    error: float
    time: float  # [s]
    how: float  # step of a tool [s]; tolerance of carom


def published() -> dict[tuple[str, str], list[Point]]:
    """Return the published points of each task and tool, by step."""
    found: dict[tuple[str, str], list[Point]] = {}
    with THEIRS.open(encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            point = Point(*(float(row[name]) for name in ("mean squared error", "time", "step")))
            found.setdefault((row["task"], row["tool"]), []).append(point)
    return found


def measured() -> dict[str, list[Point]]:
    """Return the points of carom of each task."""
    found: dict[str, list[Point]] = {}
    with OURS.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            point = Point(*(float(row[name]) for name in ("mean squared error", "time", "rtol")))
            found.setdefault(row["task"], []).append(point)
    return found


def measure(names: list[str]) -> None:
    """Run the tasks, and write the points of carom; those of other tasks stay."""
    found = measured() if OURS.exists() else {}
    for task in TASKS:
        if names and task.name not in names:
            continue
        found[task.name] = []
        carom.simulate(task.scene(), 0.02 * task.duration, throw=False)  # loads compiled code
        for rtol in SETTINGS:
            scene, begin = task.scene(), clock()
            run = carom.simulate(scene, task.duration, rtol=rtol, save_at=task.sample)
            found[task.name].append(Point(task.error(run), clock() - begin, rtol))
            print(task.name, rtol, found[task.name][-1], run.stats["impacts"], flush=True)
    lines = ["task,rtol,mean squared error,time"]
    for task in TASKS:
        lines += [
            f"{task.name},{p.how:g},{p.error:.2g},{p.time:.2g}" for p in found.get(task.name, ())
        ]
    OURS.write_text("\n".join(lines) + "\n", encoding="utf-8")


def cell(points: list[Point]) -> str:
    """Return the least error, and the time that it took."""
    if not points:
        return ""
    error, time, _ = min(points)
    return f"{error:.0f} ({time:.3g} s)" if error > 100.0 else f"{error:.1e} ({time:.3g} s)"


def rows() -> list[list[str]]:
    """Return the rows of the table, from the files."""
    theirs, ours = published(), measured()
    return [
        [f"{task.title} [{task.unit.replace('^2', '²')}]", cell(ours.get(task.name, []))]
        + [cell(theirs.get((task.name, tool), [])) for tool in TOOLS]
        for task in TASKS
    ]


def draw():
    """Return the picture: the error of each task over the time that it takes."""
    from matplotlib.figure import Figure

    theirs, ours = published(), measured()
    figure = Figure(figsize=(style.PAGE, 4.4), layout="constrained")
    panels = figure.subplots(2, 3)
    for ax, task in zip(panels.flat, TASKS, strict=True):
        for tool, colour in zip(TOOLS, COLOURS, strict=True):
            points = sorted(theirs.get((task.name, tool), []), key=lambda p: p.time)
            ax.loglog(
                [p.time for p in points],
                [p.error for p in points],
                ".-",
                color=colour,
                lw=0.8,
                label=tool,
            )
        points = ours.get(task.name, [])
        ax.loglog(
            [p.time for p in points],
            [p.error for p in points],
            "*",
            color=style.BLUE,
            ms=9,
            label="carom",
        )
        ax.set_title(task.title)
        unit = task.unit.replace(" ", r"\,")
        ax.set_ylabel(f"$\\mathrm{{{unit}}}$")
    for ax in panels[1]:
        ax.set_xlabel("time [s]")
    names = panels[0, 0].get_legend_handles_labels()
    figure.legend(*names, loc="outside lower center", ncols=len(TOOLS) + 1)
    return figure


def main() -> None:
    """Measure, unless told otherwise, and report."""
    parser = argparse.ArgumentParser()
    parser.add_argument("tasks", nargs="*", choices=[[], *(task.name for task in TASKS)])
    parser.add_argument("--keep", action="store_true")
    given = parser.parse_args()
    warnings.simplefilter("ignore", carom.AccuracyWarning)
    if not (given.keep or FEW):
        measure(given.tasks)
    head = ["mean squared error", "carom", *TOOLS]
    report("simbenchmark", "SimBenchmark", head, rows(), NOTES, timing="")
    with style.style():
        style.write(draw(), str(OUT / "simbenchmark.png"))


if __name__ == "__main__":
    main()
