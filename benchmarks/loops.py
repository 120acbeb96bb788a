"""Energy and cost of a closed loop with a redundant row, by method and step: Bricard's mechanism, 10 s."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import carom
from common import report, seconds, spread

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "mechanisms"))
from test_bricard import bricard

CASES = (
    ("rk4", 0.02), ("rk4", 0.01), ("rk4", 0.005), ("rk5", 0.02), ("rk5", 0.01), ("rk8", 0.04),
    ("rk8", 0.02),
)  # fmt: skip


def main() -> None:
    """Measure and report."""
    rows, scene = [], bricard()
    for method, step in CASES:

        def run(method=method, step=step):
            return carom.simulate(scene, 10.0, step=step, method=method, save_every=10)

        s = run()
        error = np.max(np.abs(s.total_energy - s.total_energy[0]))
        times = [t * step / 10.0 for t in seconds(run)]
        rows.append([method, f"{step:g}", f"{error:.1e}", spread(times, 1e-6)])
    report(
        "loops", "Bricard's mechanism for 10 s: 5 bodies, 6 hinges, 1 row redundant",
        ["method", "step / s", "error of the energy / J", "a step / microseconds"], rows,
    )  # fmt: skip


if __name__ == "__main__":
    main()
