"""Throws of the die of the paper to rest: how many a second, on one thread and on all, beside MuJoCo."""

from __future__ import annotations

import os

import numpy as np

from carom.bench.measure import spread
from carom.bench.problems import spatial_die
from common import FEW, peer, report

COUNT, ROUNDS = (40, 3) if FEW else (400, 5)


def row(name: str, step: float, workers: int, rates: list[float], note: str) -> list[str]:
    """Return a row of the table."""
    return [name, f"{1e3 * step:g} ms", str(workers), spread(rates).text(), note]


def main() -> None:
    """Measure and report."""
    rows = []
    cores = os.cpu_count() or 1
    for step in (1e-3, 2e-3, 5e-3):
        thrown = spatial_die.throws(step, 50)
        rest = np.sum(np.isfinite(thrown.rest_time))
        note = f"{thrown.impacts.mean():.0f} impacts, {100 * rest / len(thrown):.0f} % at rest"
        for workers in sorted({1, cores}):
            rates = [spatial_die.rate(step, COUNT, seed, workers) for seed in range(ROUNDS)]
            rows.append(row("carom", step, workers, rates, note))
    mujoco = peer("mujoco")
    if mujoco:
        rates = [spatial_die.mujoco_rate(mujoco, 1e-3, COUNT // 10, s) for s in range(ROUNDS)]
        rows.append(row("MuJoCo", 1e-3, 1, rates, "springs and dampers"))
    report(
        "ensembles", f"Throws of a die, {spatial_die.DURATION:g} s each, a second",
        ["tool", "step", "threads", "throws a second of wall time", "of a throw"], rows,
        f"Orientation uniformly random; medians of {ROUNDS} rounds (quartiles).",
    )  # fmt: skip


if __name__ == "__main__":
    main()
