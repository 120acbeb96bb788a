"""Error got over accuracy asked, by carom and by Drake's CENIC.

python benchmarks/cenic.py --drake    where pydrake 1.51.1 can be imported: write the rows of Drake
python benchmarks/cenic.py            write those of carom, the table and the picture
python benchmarks/cenic.py --keep     the table and the picture from the files
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path
from typing import NamedTuple

import cenic_problems as problems

PUBLISHED = Path(__file__).parent / "published"
FILES = {"carom": PUBLISHED / "cenic_carom.csv", "CENIC": PUBLISHED / "cenic_drake.csv"}
ASKED = {"carom": (1e-2, 1e-4, 1e-6, 1e-8, 1e-10), "CENIC": tuple(10.0**-k for k in range(1, 9))}
BALLS = "64 balls"  # of which nothing but their depth in each other is known
LONG = 20.0  # seconds after which no better accuracy is asked for
SHOWN = {"carom": (1e-4, 1e-8), "CENIC": (1e-3, 1e-8)}  # accuracies of the table


class Point(NamedTuple):
    """The error at an accuracy, and what it cost."""

    asked: float
    error: float
    steps: int
    time: float  # [s]


def measure(tool: str) -> None:
    """Solve each problem at each accuracy, and write the rows."""
    every = problems.drake_problems() if tool == "CENIC" else problems.carom_problems()
    lines = ["problem,accuracy asked,error,steps,time"]
    for name, solve in every.items():
        solve(0.1)  # loads code
        for asked in ASKED[tool]:
            error, steps, took = solve(asked)
            lines.append(f"{name},{asked:g},{error:.3g},{steps},{took:.2g}")
            print(lines[-1], flush=True)
            if took > LONG or (name == BALLS and asked < 1e-4):
                break
    FILES[tool].write_text("\n".join(lines) + "\n", encoding="utf-8")


def points(tool: str) -> dict[str, list[Point]]:
    """Return the points of each problem."""
    found: dict[str, list[Point]] = {}
    with FILES[tool].open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            point = Point(
                float(row["accuracy asked"]),
                float(row["error"]),
                int(row["steps"]),
                float(row["time"]),
            )
            found.setdefault(row["problem"], []).append(point)
    return found


def rows() -> list[list[str]]:
    """Return the rows of the table: errors at two accuracies that were asked for, and times."""
    every = {tool: points(tool) for tool in FILES}
    table = []
    for name in every["carom"]:
        cells = []
        for tool in FILES:
            for asked in SHOWN[tool]:
                (point,) = [p for p in every[tool][name] if p.asked == asked] or [None]
                cells.append("" if point is None else f"{point.error:.1e} ({point.time:.2g} s)")
        table.append([name, *cells])
    return table


def draw():
    """Return the picture."""
    from matplotlib.figure import Figure

    from carom.visual.plots import style

    every = {tool: points(tool) for tool in FILES}
    drawn = list(every["carom"])[:4]
    figure = Figure(figsize=(style.PAGE, 4.0), layout="constrained")
    panels = figure.subplots(2, len(drawn), sharey=True)
    for column, name in enumerate(drawn):
        upper, lower = panels[:, column]
        for (tool, found), colour in zip(every.items(), (style.BLUE, style.RED), strict=True):
            error = [max(p.error, 1e-17) for p in found[name]]
            upper.loglog([p.asked for p in found[name]], error, "o-", color=colour, label=tool)
            lower.loglog([p.time for p in found[name]], error, "o-", color=colour)
        upper.loglog([1e-10, 1e-1], [1e-10, 1e-1], ":", color=style.GREY, label="got = asked")
        upper.set(title=name, xlabel="accuracy asked")
        lower.set_xlabel("time [s]")
        upper.invert_xaxis()
    for panel in panels[:, 0]:
        panel.set_ylabel("error [m or rad]")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def main() -> None:
    """Measure, unless told otherwise, and report."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--drake", action="store_true")
    parser.add_argument("--keep", action="store_true")
    given = parser.parse_args()
    if given.drake:
        measure("CENIC")
        return
    from carom.visual.plots import style
    from common import FEW, OUT, report

    if not (given.keep or FEW):
        measure("carom")
    head = ["error", "carom, rtol 1e-4", "carom, 1e-8", "CENIC, accuracy 1e-3", "CENIC, 1e-8"]
    report("cenic", "Error got at an accuracy asked", head, rows(), NOTES, timing="")
    with style.style():
        style.write(draw(), str(OUT / "cenic.png"))


NOTES = "In brackets the processor time of the run, once, both on the machine of the first line."

if __name__ == "__main__":
    main()
