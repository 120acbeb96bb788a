"""Table and pictures of six problems by nine programs, from what `benchmarks/peers/run.py` measured.

python benchmarks/comparison.py
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

RESULTS = Path(__file__).parent / "peers" / "results.json"
PROBLEMS = ("rolling", "free fall", "stops", "stick-slip", "bounce e=0.5", "bounce e=1", "Pleiades")
#: what each way of a program is called on the page, in the order of the table
LABELS = {
    ("carom", "default"): "carom",
    ("siconos", "event-driven"): "Siconos, event-driven",
    ("siconos", "Moreau-Jean"): "Siconos, Moreau-Jean",
    ("dart", "default"): "DART",
    ("rapier", "default"): "rapier",
    ("pybullet", "default"): "PyBullet",
    ("exudyn", "generalized-alpha"): "Exudyn, generalized-alpha",
    ("exudyn", "DOPRI5"): "Exudyn, DOPRI5",
    ("mujoco", "implicitfast"): "MuJoCo, implicitfast",
    ("mujoco", "RK4"): "MuJoCo, RK4",
    ("drake", "discrete"): "Drake, discrete",
    ("drake", "CENIC"): "Drake, CENIC",
    ("drake", "RK3"): "Drake, RK3",
    ("newton", "XPBD"): "Newton, XPBD",
}
#: colour and mark of a program; lines of its ways are solid, dashed, dotted
LOOKS = {
    "carom": ("#0072b2", "o"), "siconos": ("#d55e00", "s"), "dart": ("#c51b7d", "^"),
    "rapier": ("#7b52ab", "<"), "pybullet": ("#8c564b", ">"), "exudyn": ("#666666", "p"),
    "mujoco": ("#999900", "h"), "drake": ("#009e73", "D"), "newton": ("#000000", "X"),
}  # fmt: skip
ROUND_OFF = 1e-16  # errors below are drawn here
HEAD = ["least error / m (its time)", *PROBLEMS]


class Point(NamedTuple):
    """The error at a setting, and its processor time."""

    setting: float
    error: float  # [m]
    time: float  # [s]
    accuracy: bool  # the setting is an accuracy, not a step


def kept() -> dict:
    """Return the file."""
    return json.loads(RESULTS.read_text(encoding="utf-8"))


def points() -> dict[str, dict[str, list[Point]]]:
    """Return the points of each program and problem, from coarse to fine."""
    found: dict[str, dict[str, list[Point]]] = {label: {} for label in LABELS.values()}
    for row in kept()["rows"]:
        if row.get("error") is not None:
            of = found[LABELS[row["program"], row["variant"]]].setdefault(row["problem"], [])
            of.append(Point(row["setting"], row["error"], row["time"], row["accuracy"]))
    return found


def best(these: list[Point]) -> Point:
    """Return the point of least error; of those that are exact to round-off, the fastest."""
    exact = [p for p in these if p.error < 1e-12]
    return min(exact, key=lambda p: p.time) if exact else min(these, key=lambda p: p.error)


def time_of(point: Point) -> str:
    """Return a processor time as text."""
    return f"{point.time:.2g} s" if point.time >= 0.0995 else f"{1e3 * point.time:.2g} ms"


def cell(these: list[Point]) -> str:
    """Return the least error and its time."""
    if not these:
        return ""
    point = best(these)
    return f"{max(point.error, ROUND_OFF):.0e} ({time_of(point)})"


def rows() -> list[list[str]]:
    """Return the rows of the table."""
    found = points()
    return [[name, *(cell(found[name].get(p, [])) for p in PROBLEMS)] for name in found]


def why() -> list[str]:
    """Return the reasons of empty cells, as lines of a list."""
    said: dict[tuple[str, str], list[str]] = {}
    for row in kept()["rows"]:
        if "why" in row:
            name = LABELS[row["program"], row["variant"]]
            said.setdefault((name, row["why"]), []).append(row["problem"])
    return [f"- {name}: no {', '.join(of)}; {reason}." for (name, reason), of in said.items()]


def machine() -> str:
    """Return where it was measured, and what."""
    file = kept()
    others = ", ".join(f"{name} {of}" for name, of in file["versions"].items() if name != "carom")
    place = file["machine"].removesuffix(f", mujoco {file['versions']['mujoco']}")
    return f"{place}, {others}"


def panels(title: str):
    """Return a figure with a panel for each problem, the panels, and the axes of the legend."""
    from matplotlib.figure import Figure

    from carom.visual.plots import style

    figure = Figure(figsize=(style.PAGE, 4.6), layout="constrained")
    axes = figure.subplots(2, 4).ravel()
    for panel, name in zip(axes, PROBLEMS, strict=False):
        panel.set_title(name)
        panel.set_xscale("log")
        panel.set_yscale("log")
    for panel in axes[3:7]:
        panel.set_xlabel(title)
    for panel in axes[[0, 4]]:
        panel.set_ylabel("error [m]")
    axes[7].axis("off")
    return figure, axes


def draw(over_time: bool):
    """Return the picture of errors over time, or over the accuracy that was asked for."""
    from carom.visual.plots import style

    title = "processor time [s]" if over_time else "accuracy asked"
    figure, axes = panels(title)
    handles, lines = {}, {}
    for (program, _), name in LABELS.items():
        found = points()[name]
        colour, mark = LOOKS[program]
        line = ("-", "--", ":")[lines.setdefault(program, -1) + 1]
        lines[program] += 1
        for panel, problem in zip(axes, PROBLEMS, strict=False):
            these = found.get(problem, [])
            if not these or not (over_time or these[0].accuracy):
                continue
            x = [p.time if over_time else p.setting for p in these]
            y = [max(p.error, ROUND_OFF) for p in these]
            ours = program == "carom"
            (handles[name],) = panel.plot(
                x, y, mark + line, ms=3.5, lw=1.8 if ours else 0.9, color=colour, zorder=2 + ours
            )
    if not over_time:
        for panel in axes[:7]:
            panel.plot([1e-10, 1e-2], [1e-10, 1e-2], ":", color=style.GREY)
            panel.invert_xaxis()
    axes[7].legend(handles.values(), handles.keys(), loc="center", fontsize=6.5, frameon=False)
    return figure


def main() -> None:
    """Write the table and both pictures."""
    from carom.visual.plots import style
    from common import OUT, report

    notes = "\n".join(["Empty cells:", "", *why()])
    timing = f"medians of {kept()['rounds']} rounds"
    report("comparison", "Six problems by nine programs", HEAD, rows(), notes, timing, machine())
    with style.style():
        style.write(draw(False), str(OUT / "peers_asked.png"))
        style.write(draw(True), str(OUT / "peers_time.png"))


if __name__ == "__main__":
    main()
