"""Error against time for six problems with known answers, beside MuJoCo in the same run: figure and table."""

from __future__ import annotations

import json
from types import ModuleType

import numpy as np

from carom.bench import measure
from carom.bench.problems import ALL, Task
from common import FEW, OUT, ROUNDS, decades, peer, report

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
FLOOR = 1e-16  # errors of zero are drawn here


def tasks(problem: ModuleType, mujoco) -> dict[str, list[Task]]:
    """Return the work of each tool and method, by its name, long steps first; of tolerances the large ones."""
    steps = problem.STEPS[:2] if FEW else problem.STEPS
    found = {
        f"carom {method}": [problem.ours(step, method) for step in steps]
        for method in problem.METHODS
    }
    tolerances = TOLERANCES[:2] if FEW else TOLERANCES
    found["carom by tolerance"] = [problem.ours(rtol, measure.TOLERANCE) for rtol in tolerances]
    if mujoco:
        theirs = problem.PEER_STEPS[:2] if FEW else problem.PEER_STEPS
        found["MuJoCo"] = [problem.mujoco(mujoco, step) for step in theirs]
    return found


def measured(problem: ModuleType, mujoco) -> dict[str, list[dict]]:
    """Return for each tool and step the median, the quartiles and the error."""
    return {
        name: [
            {
                "step": task.step,
                "error": task.error(),
                **measure.spread(task.times(ROUNDS))._asdict(),
            }
            for task in each
        ]
        for name, each in tasks(problem, mujoco).items()
    }


def asked(name: str, step: float) -> str:
    """Return the step of a run, or its tolerance."""
    return f"{step:.0e}" if name == "carom by tolerance" else f"{1e3 * step:g} ms"


def draw(results: dict[str, dict[str, list[dict]]]) -> None:
    """Draw one small picture a problem, with the same colours in all."""
    from carom.visual.plots import style as look

    colours = {
        "carom by tolerance": look.BLACK, "carom rk4": look.BLUE, "carom rk5": look.SKY,
        "carom rk8": look.GREEN, "MuJoCo": look.RED,
    }  # fmt: skip
    with look.style():
        figure, axes = look.new(look.PAGE, 4.6, 2, 3)
        for ax, problem in zip(axes.flat, ALL):
            for name, points in results[problem.NAME].items():
                time = np.array([p["median"] for p in points])
                spans = [time - [p["low"] for p in points], [p["high"] for p in points] - time]
                error = np.maximum([p["error"] for p in points], FLOOR)
                ax.errorbar(
                    time, error, xerr=np.maximum(spans, 0.0), fmt="o-", color=colours[name],
                    label=name, lw=1,
                )  # fmt: skip
            ax.set(xscale="log", yscale="log", ylim=(FLOOR / 3, 10.0))
            ax.set_title(f"{problem.TITLE}\n{problem.ERROR}", fontsize=7)
            decades(ax)
            ax.grid(alpha=0.25, lw=0.4)
        for ax in axes[1]:
            ax.set_xlabel("processor time [s]")
        for ax in axes[:, 0]:
            ax.set_ylabel("error")
        handles = {}
        for ax in axes.flat:
            handles.update(dict(zip(*reversed(ax.get_legend_handles_labels()))))
        handles = {name: handles[name] for name in colours if name in handles}
        figure.legend(
            handles.values(), handles.keys(), loc="outside upper center", ncols=len(handles)
        )
        figure.text(
            1.0, -0.02, measure.machine_line(), ha="right", va="top", fontsize=4.5, color=look.GREY
        )
        OUT.mkdir(parents=True, exist_ok=True)
        figure.savefig(OUT / "work_precision.png", dpi=220)


def main() -> None:
    """Measure, draw and report."""
    mujoco = peer("mujoco")
    results = {problem.NAME: measured(problem, mujoco) for problem in ALL}
    rows = [
        [
            problem.TITLE, name, asked(name, p["step"]), f"{p['error']:.1e}",
            measure.Spread(p["median"], p["low"], p["high"], ROUNDS).text(1e-3),
        ]
        for problem in ALL
        for name, points in results[problem.NAME].items()
        for p in points
    ]  # fmt: skip
    report(
        "work_precision", "Work and precision, problem by problem",
        ["problem", "tool", "step, or rtol", "error", "time / ms"], rows,
        "Errors: " + "; ".join(f"{p.TITLE}: {p.ERROR}" for p in ALL) + ".",
    )  # fmt: skip
    facts = {"machine": measure.machine(), "results": results}
    (OUT / "work_precision.json").write_text(json.dumps(facts, indent=1), encoding="utf-8")
    draw(results)


if __name__ == "__main__":
    main()
