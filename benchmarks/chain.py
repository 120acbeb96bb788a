"""A chain of N rods: cost against error in energy, beside MuJoCo's RK4 in the same run.

Long chains are chaotic, so tools are compared by curves over several steps, in a time in which the errors are
still those of the method.
"""

from __future__ import annotations

import numpy as np

import carom
from carom.bench.measure import TOLERANCE
from carom.bench.problems import chain
from carom.bench.problems.chain import METHODS, STEPS, WATCHED
from common import FEW, peer, per_step, report, seconds

COUNTS = (1, 10) if FEW else (1, 10, 40, 100)
BOUNDS = (1e-6, 1e-8, 1e-10)
RTOL = (1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10)
INSTANT = 1e-6  # s: a run that only sets up
DEFAULT = "by tolerance"


def curve(make) -> list[tuple[float, float]]:
    """Return (seconds of work a simulated second, error in energy) for each step; setting up not counted.

    A step costs the same whatever its length, so that it is timed once.
    """
    middle = make(1e-3)
    few, many = max(1, middle.count // 20), middle.count
    cost = float(np.median(per_step(middle.steps, few, many)))
    return [(cost / step, make(step).error()) for step in STEPS]


def default_curve(links: int) -> list[tuple[float, float]]:
    """Return work and error for each tolerance of the default method; setting up not counted."""
    scene, found = chain.scene(links), []
    for rtol in RTOL:
        whole = chain.ours(rtol, TOLERANCE, links)
        set_up = seconds(
            lambda rtol=rtol: carom.simulate(scene, INSTANT, rtol=rtol, save_at=INSTANT)
        )
        work = np.median(seconds(whole.run)) - np.median(set_up)
        found.append((float(work) / WATCHED, whole.error()))
    return found


def cost_at(curve: list[tuple[float, float]], bound: float) -> float:
    """Return the cost at which a curve passes an error, between its points in logarithms; NaN outside."""
    cost, error = np.log(np.array(curve)).T
    order = np.argsort(error)
    if not error[order[0]] <= np.log(bound) <= error[order[-1]]:
        return np.nan
    return float(np.exp(np.interp(np.log(bound), error[order], cost[order])))


def ratio(theirs: list[tuple[float, float]], ours: list[tuple[float, float]], bound: float) -> str:
    """Return how many times cheaper ours is at an error: at least, where its longest step is below that."""
    inside, longest = cost_at(ours, bound), ours[0]
    at_least = not np.isfinite(inside) and longest[1] < bound
    value = cost_at(theirs, bound) / (longest[0] if at_least else inside)
    return f"{'> ' if at_least else ''}{value:.2g}" if np.isfinite(value) else "-"


def precision() -> None:
    """Report cost against error, and how much less work carom does for the same error."""
    mujoco = peer("mujoco")
    rows, ratios = [], []
    for links in COUNTS:
        curves = {
            f"carom {name}": curve(lambda h, n=links, m=name: chain.ours(h, m, n))
            for name in METHODS
        }
        if mujoco:
            curves["MuJoCo RK4"] = curve(lambda h, n=links: chain.mujoco(mujoco, h, n))
        default = default_curve(links)
        for name, found in curves.items():
            rows.append([str(links), name, *(f"{c:.2g} s, {e:.0e}" for c, e in found)])
        if mujoco:
            for bound in BOUNDS:
                theirs = curves["MuJoCo RK4"]
                found = [ratio(theirs, curves[f"carom {name}"], bound) for name in METHODS]
                found.append(ratio(theirs, default, bound))
                ratios.append([str(links), f"{bound:.0e}", *found])
    note = f"Work a simulated second, and greatest error in energy in {WATCHED:g} s, relative to m g N L/2."
    head = ["links", "tool", *(f"{1e3 * step:g} ms" for step in STEPS)]
    report("chain", "A chain of rods, released horizontal: work and error", head, rows, note)
    if ratios:
        report(
            "chain_ratio", "MuJoCo's work over carom's at equal error in energy",
            ["links", "error", *METHODS, DEFAULT], ratios,
            "Between the points of both curves, in logarithms; a dash where MuJoCo's does not reach the error. "
            "By tolerance: the default, with 100 states saved.",
        )  # fmt: skip


if __name__ == "__main__":
    precision()
