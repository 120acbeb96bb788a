"""Time of one free step of a die with its contact check, beside other engines in the same run."""

from __future__ import annotations

import carom
from common import die_scene, peer, per_step, report, spread

STEP = 1e-3
NS = 1e-9


def carom_runner(scene):
    """Return ``run(steps)`` of a scene, nothing saved but both ends."""

    def run(steps):
        carom.simulate(scene, duration=steps * STEP, step=STEP, save_every=steps)

    return run


def mujoco_runner(mujoco, integrator: str):
    """Return ``run(steps)`` of the die high above a plane; the steps are made in C."""
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{STEP}" integrator="{integrator}"/>
      <worldbody><geom type="plane" size="1 1 1"/>
        <body pos="0 0 1e7"><freejoint/><geom type="box" size=".01 .01 .01" mass=".016"/></body>
      </worldbody></mujoco>""")
    data = mujoco.MjData(model)

    def run(steps):
        mujoco.mj_resetData(model, data)
        data.qvel[:] = (0.5, 0, -0.5, 0, 10, 0)
        mujoco.mj_step(model, data, nstep=steps)

    return run


def pybullet_runner(pybullet):
    """Return ``run(steps)`` of the die high above a plane; one Python call a step."""
    pybullet.connect(pybullet.DIRECT)
    pybullet.setTimeStep(STEP)
    pybullet.setGravity(0, 0, -9.81)
    plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE)
    box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[0.01] * 3)
    pybullet.createMultiBody(0, plane)
    die = pybullet.createMultiBody(0.016, box, basePosition=[0, 0, 1e7])

    def run(steps):
        pybullet.resetBasePositionAndOrientation(die, [0, 0, 1e7], [0, 0, 0, 1])
        pybullet.resetBaseVelocity(die, [0.5, 0, -0.5], [0, 10, 0])
        for _ in range(steps):
            pybullet.stepSimulation()

    return run


def main() -> None:
    """Measure and report."""
    general = (0.9e-6, 1.0e-6, 1.2e-6)
    far = {"height": 1e7, "velocity": (0.5, 0, -0.5), "spin": (0, 10, 0)}
    near = {"height": 0.012, "velocity": (0.5, 0, 0), "spin": (0, 0, 10), "gravity": 0.0}
    cases = [
        ("carom, equal moments, far", die_scene(**far)),
        ("carom, equal moments, near (8 corners checked)", die_scene(**near)),
        ("carom, general inertia, far", die_scene(**far, inertia=general)),
        ("carom, general inertia, near (8 corners checked)", die_scene(**near, inertia=general)),
    ]
    rows = [
        [name, spread(per_step(carom_runner(scene), 1000, 201000), NS)] for name, scene in cases
    ]
    mujoco, pybullet = peer("mujoco"), peer("pybullet")
    if mujoco:
        for integrator in ("Euler", "RK4"):
            times = per_step(mujoco_runner(mujoco, integrator), 1000, 21000)
            rows.append([f"MuJoCo {integrator}, far", spread(times, NS)])
    if pybullet:
        times = per_step(pybullet_runner(pybullet), 1000, 21000)
        rows.append(["pybullet, far (a Python call a step)", spread(times, NS)])
    report(
        "free_step", "One free step of a die with contact check", ["", "ns a step"], rows,
        "Far: the ball around the die clears the table. Near: it does not, so each corner is "
        "bounded. The step is 1 ms; what a call costs is taken out by two lengths of run.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
