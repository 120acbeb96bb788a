"""Time of one free step of a die with its contact check, beside other engines in the same run."""

from __future__ import annotations

from carom.bench.problems import free_step
from common import peer, per_step, report, spread

NS = 1e-9


def main() -> None:
    """Measure and report."""
    rows = [
        [f"carom, {case}", spread(per_step(free_step.ours(case), 1000, 201000), NS)]
        for case in free_step.CASES
    ]
    mujoco, pybullet = peer("mujoco"), peer("pybullet")
    if mujoco:
        for integrator in ("Euler", "RK4"):
            times = per_step(free_step.mujoco(mujoco, integrator), 1000, 21000)
            rows.append([f"MuJoCo {integrator}, far", spread(times, NS)])
    if pybullet:
        times = per_step(free_step.pybullet(pybullet), 1000, 21000)
        rows.append(["pybullet, far (a Python call a step)", spread(times, NS)])
    report(
        "free_step", "One free step of a die with contact check", ["", "ns a step"], rows,
        "Far: the ball around the die clears the table. Near: it does not, so each corner is "
        "bounded. The step is 1 ms; what a call costs is taken out by two lengths of run.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
