"""What the scripts share besides `carom.bench`: where tables go, and how they look."""

from __future__ import annotations

import os
from pathlib import Path

from carom.bench import measure
from carom.bench.measure import clock, machine_line, per_step, seconds, stepper
from carom.bench.problems.chain import scene as pendulum_scene
from carom.bench.problems.planar_die import scene as die_scene

__all__ = [
    "FEW", "OUT", "ROUNDS", "clock", "decades", "die_scene", "machine_line", "peer", "pendulum_scene",
    "per_step", "report", "seconds", "spread", "stepper",
]  # fmt: skip

OUT = Path(os.environ.get("CAROM_BENCH_OUT", Path("out") / "benchmarks"))
ROUNDS = measure.ROUNDS
TIMING = f"processor time, medians of {ROUNDS} rounds (quartiles)"
#: to try the scripts out: fewer and smaller cases (`python benchmarks/all.py --few`)
FEW = os.environ.get("CAROM_BENCH_FEW", "") not in ("", "0")


def peer(name: str):
    """Return the module of another tool, or None (and say so) where it cannot be imported."""
    module = measure.peer(name)
    if module is None:
        print(f"({name} is not installed in this interpreter: its rows are left out)")
    return module


def spread(values: list[float], unit: float = 1.0, digits: int = 3) -> str:
    """Return ``median (quartile to quartile)``."""
    return measure.spread(values).text(unit, digits)


def decades(ax) -> None:
    """Let a logarithmic x axis have two decades at least, and labels at powers of ten alone."""
    from matplotlib.ticker import NullFormatter

    low, high = ax.get_xlim()
    if high < 100.0 * low:
        middle = (low * high) ** 0.5
        ax.set_xlim(middle / 10.0, middle * 10.0)
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.yaxis.set_minor_formatter(NullFormatter())


def report(
    name: str,
    title: str,
    head: list[str],
    rows: list[list[str]],
    notes: str = "",
    timing: str = TIMING,
    machine: str = "",
) -> None:
    """Print a Markdown table and write it to ``out/benchmarks/<name>.md``.

    `timing` says how times were taken; where it is empty, the notes say it. `machine` is that of the numbers,
    where they were kept; otherwise it is this one.
    """
    lines = [f"## {title}", "", f"{machine or machine_line()}{timing and '; '}{timing}.", ""]
    lines += ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    lines += ["", notes.strip(), ""] if notes else [""]
    text = "\n".join(lines)
    print(text)
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / f"{name}.md").write_text(text, encoding="utf-8")
