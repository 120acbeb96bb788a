"""Order in the step of the three ways to find an impact: the paper's die, through two impacts."""

from __future__ import annotations

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np

import carom
from common import OUT, die_scene, report

END = 0.35  # s, after the second impact (0.3209 s), before the third
STEPS = 2.0 ** -np.arange(11, 21)  # 0.5 ms to 1 microsecond
SHIFTS = 1.0 + np.linspace(0.0, 0.05, 12)  # nearby steps: the error depends on where a step ends
LABEL = {"locate": 0, "work": -9, "project": 3}
STYLE = {"locate": ("o-", "#0072B2"), "work": ("s-", "#009E73"), "project": ("^-", "#D55E00")}


def errors(mode: str, exact: np.ndarray) -> list[float]:
    """Return the mean error of the mass centre at the end, over steps near each of STEPS [m]."""
    scene = die_scene()
    result = []
    for step in STEPS:
        ends = [
            carom.simulate(scene, END, step=float(step * f), impact_location=mode, save_every=10**6)
            for f in SHIFTS
        ]
        found = [np.linalg.norm(e.position[-1, 0] - exact) for e in ends]
        result.append(float(np.mean(found)))
    return result


def main() -> None:
    """Measure, print a table, and draw."""
    exact = carom.simulate(die_scene(), END, step=1e-3).position[-1, 0]
    table = {mode: errors(mode, exact) for mode in STYLE}
    rows = [[f"{1e3 * h:.4g}", *(f"{table[m][k]:.2e}" for m in STYLE)] for k, h in enumerate(STEPS)]
    last = slice(-5, None)
    order = {
        m: np.polyfit(np.log(STEPS[last]), np.log(np.maximum(table[m], 1e-17))[last], 1)[0]
        for m in STYLE
    }
    rows.append(["fitted order", *("-" if m == "locate" else f"{order[m]:.2f}" for m in STYLE)])
    report(
        "location",
        "Three ways to find an impact",
        ["step [ms]", *(f"{m} [m]" for m in STYLE)],
        rows,
    )
    figure, ax = plt.subplots(figsize=(3.4, 2.8), layout="constrained")
    for mode, (style, colour) in STYLE.items():
        ax.loglog(STEPS, np.maximum(table[mode], 1e-17), style, color=colour, ms=3.5, lw=1)
        ax.annotate(mode, (STEPS[0], table[mode][0]), xytext=(5, LABEL[mode]), textcoords="offset points",
                    color=colour, va="center", fontsize=8)  # fmt: skip
    ax.loglog(STEPS, 4.0 * STEPS, ":", color="0.6", lw=1)
    ax.annotate("order 1", (STEPS[-1], 4.0 * STEPS[-1]), xytext=(8, -8),
                textcoords="offset points", color="0.5", fontsize=8)  # fmt: skip
    ax.set(xlabel="step h [s]", ylabel="error of the centre at 0.35 s [m]",
           xlim=(STEPS[-1] / 1.5, STEPS[0] * 4))  # fmt: skip
    OUT.mkdir(parents=True, exist_ok=True)
    figure.savefig(OUT / "location.png", dpi=220)


if __name__ == "__main__":
    main()
