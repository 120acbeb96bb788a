"""Throws of the die of the paper to rest: how many a second, on one thread and on all, beside MuJoCo."""

from __future__ import annotations

import os

import numpy as np

from carom.bench.measure import spread
from carom.bench.problems import spatial_die
from common import FEW, peer, report

COUNT, ROUNDS = (40, 3) if FEW else (400, 5)
HOW = [*({"rtol": rtol} for rtol in (1e-8, 1e-6, 1e-4)), *({"step": h} for h in (1e-3, 2e-3, 5e-3))]


def row(name: str, how: dict, workers: int, rates: list[float], note: str) -> list[str]:
    """Return a row of the table."""
    chosen = f"{1e3 * how['step']:g} ms" if "step" in how else f"rtol {how['rtol']:.0e}"
    return [name, chosen, str(workers), spread(rates).text(), note]


def main() -> None:
    """Measure and report."""
    rows = []
    cores = os.cpu_count() or 1
    for how in HOW:
        thrown = spatial_die.throws(50, **how)
        rest = np.sum(np.isfinite(thrown.rest_time))
        note = f"{thrown.impacts.mean():.0f} impacts, {100 * rest / len(thrown):.0f} % at rest"
        for workers in sorted({1, cores}):
            rates = [spatial_die.rate(COUNT, seed, workers, **how) for seed in range(ROUNDS)]
            rows.append(row("carom", how, workers, rates, note))
    mujoco = peer("mujoco")
    if mujoco:
        rates = [spatial_die.mujoco_rate(mujoco, 1e-3, COUNT // 10, s) for s in range(ROUNDS)]
        rows.append(row("MuJoCo", {"step": 1e-3}, 1, rates, "springs and dampers"))
    report(
        "ensembles", f"Throws of a die, {spatial_die.DURATION:g} s each, a second",
        ["tool", "step, or rtol", "threads", "throws a second of wall time", "of a throw"], rows,
        f"Orientation uniformly random; medians of {ROUNDS} rounds (quartiles).",
    )  # fmt: skip


if __name__ == "__main__":
    main()
