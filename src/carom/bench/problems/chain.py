"""A chain of rods (1 m, 1 kg) with hinges along y, released in a horizontal position.

Long chains are chaotic, so the energy is compared, after a time in which the errors still come from the method.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from carom.bench.problems.task import Task, carom_task

NAME, TITLE = "chain", "Chain of 10 rods, 2 s"
ERROR = "greatest error of the energy / (m g N L/2)"
METHODS, STEPS = ("rk4", "rk5", "rk8"), (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)
PEER_STEPS = STEPS
WATCHED, LINKS = 2.0, 10


def scene(links: int = 1):
    """Return a chain of rods, horizontal and at rest."""
    import carom

    made = carom.Scene(gravity=(0, 0, -9.81))
    above = carom.GROUND
    inertia = np.array([1e-4, 1.0 / 12.0, 1.0 / 12.0])
    for k in range(links):
        rod = made.add_body(mass=1.0, inertia=inertia, position=(k + 0.5, 0, 0))
        made.add_joint(carom.joints.Revolute((k, 0, 0), (0, 1, 0)), above, rod)
        above = rod
    return made


def scale(links: int) -> float:
    """Return m g N L/2, the scale of energy errors."""
    return 9.81 * links / 2.0


def ours(step: float, method: str = "rk4", links: int = LINKS) -> Task:
    """Return the work of carom."""

    def wrong(run) -> float:
        return np.abs(run.total_energy - run.total_energy[0]).max() / scale(links)

    return carom_task(scene(links), WATCHED, step, method, wrong, saves=100, by_steps=True)


def model(module, links: int, step: float, integrator: str = "RK4"):
    """Return MuJoCo's chain and its data."""
    text, end = "", ""
    for k in range(links):
        text += f"""<body pos="{0 if k == 0 else 1} 0 0"><joint type="hinge" axis="0 1 0"/>
          <inertial pos=".5 0 0" mass="1" diaginertia="1e-4 {1 / 12} {1 / 12}"/>"""
        end += "</body>"
    made = module.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{step}" integrator="{integrator}"/>
    <worldbody>{text}{end}</worldbody></mujoco>""")
    return made, module.MjData(made)


def _steps(module, made, data, count: int) -> None:
    module.mj_resetData(made, data)
    module.mj_step(made, data, nstep=count)


def mujoco(module, step: float, links: int = LINKS) -> Task:
    """Return the work of MuJoCo's RK4."""
    made, data = model(module, links, step)
    run = partial(_steps, module, made, data)

    def error() -> float:
        made.opt.enableflags = int(module.mjtEnableBit.mjENBL_ENERGY)
        module.mj_resetData(made, data)
        each = max(1, round(WATCHED / 100 / step))
        energies = []
        for _ in range(round(WATCHED / step / each) + 1):
            module.mj_forward(made, data)
            energies.append(data.energy.sum())
            module.mj_step(made, data, nstep=each)
        made.opt.enableflags = 0
        return float(np.abs(np.array(energies) - energies[0]).max() / scale(links))

    count = round(WATCHED / step)
    return Task(step, lambda: run(count), error, run, count)
