"""Time of one free step of a die with its contact check, beside other engines in the same run."""

from __future__ import annotations

from carom.bench.problems import free_step
from common import peer, per_step, report, spread

NS, STEP = 1e-9, free_step.STEP


def with_pybullet(module):
    """Return ``run(steps)`` of pybullet, far above a plane; each step is a call from Python."""
    module.connect(module.DIRECT)
    module.setTimeStep(STEP)
    module.setGravity(0, 0, -9.81)
    plane = module.createCollisionShape(module.GEOM_PLANE)
    box = module.createCollisionShape(module.GEOM_BOX, halfExtents=[0.01] * 3)
    module.createMultiBody(0, plane)
    die = module.createMultiBody(0.016, box, basePosition=[0, 0, 1e7])

    def run(steps: int) -> None:
        module.resetBasePositionAndOrientation(die, [0, 0, 1e7], [0, 0, 0, 1])
        module.resetBaseVelocity(die, [0.5, 0, -0.5], [0, 10, 0])
        for _ in range(steps):
            module.stepSimulation()

    return run


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
        times = per_step(with_pybullet(pybullet), 1000, 21000)
        rows.append(["pybullet, far (a Python call a step)", spread(times, NS)])
    report(
        "free_step", "One free step of a die with contact check", ["", "ns a step"], rows,
        "Far: the ball around the die clears the table. Near: it does not, so each corner is "
        "bounded. The step is 1 ms; what a call costs is taken out by two lengths of run.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
