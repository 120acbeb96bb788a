"""A chain of N rods: time of a step, and error in energy, beside MuJoCo's RK4 in the same run."""

from __future__ import annotations

import numpy as np

import carom
from common import peer, pendulum_scene, per_step, report, spread

STEP = 2e-3
US = 1e-6
COUNTS = (1, 10, 40, 100)
WATCHED = 2.0  # [s]


def carom_chain(links: int):
    """Return the times of a step and the error in energy."""
    scene = pendulum_scene(links)

    def run(steps):
        carom.simulate(scene, duration=steps * STEP, step=STEP, save_every=steps)

    few, many = 50, 50 + 40000 // links
    solution = carom.simulate(scene, duration=WATCHED, step=STEP)
    error = np.abs(solution.ledger.residual).max() / scale(links)
    return per_step(run, few, many), error


def scale(links: int) -> float:
    """Return m g N L/2, the energy that errors are compared with."""
    return 9.81 * links / 2.0


def mujoco_chain(mujoco, links: int):
    """Return the same of MuJoCo's RK4."""
    text, end = "", ""
    for k in range(links):
        text += f"""<body pos="{0 if k == 0 else 1} 0 0"><joint type="hinge" axis="0 1 0"/>
          <inertial pos=".5 0 0" mass="1" diaginertia="1e-4 {1 / 12} {1 / 12}"/>"""
        end += "</body>"
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{STEP}" integrator="RK4"><flag energy="enable"/></option>
    <worldbody>{text}{end}</worldbody></mujoco>""")
    data = mujoco.MjData(model)

    def run(steps):
        mujoco.mj_resetData(model, data)
        mujoco.mj_step(model, data, nstep=steps)

    energies = []
    for _ in range(101):
        mujoco.mj_forward(model, data)
        energies.append(data.energy.sum())
        mujoco.mj_step(model, data, nstep=round(WATCHED / STEP / 100))
    error = np.abs(np.array(energies) - energies[0]).max() / scale(links)
    model.opt.enableflags = 0
    return per_step(run, 50, 50 + 20000 // links), error


def main() -> None:
    """Measure and report."""
    mujoco = peer("mujoco")
    rows = []
    for links in COUNTS:
        times, error = carom_chain(links)
        mid = float(np.median(times)) / US
        row = [str(links), spread(times, US), f"{mid / links:.3f}", f"{error:.1e}"]
        if mujoco:
            others, other_error = mujoco_chain(mujoco, links)
            ratio = float(np.median(others)) / float(np.median(times))
            row += [spread(others, US), f"{other_error:.1e}", f"{ratio:.1f}"]
        rows.append(row)
    head = ["links", "carom, us a step", "us a link", "energy error"]
    if mujoco:
        head += ["MuJoCo RK4, us a step", "energy error", "ratio"]
    report(
        "chain", "A chain of rods, released horizontal", head, rows,
        f"Step {STEP:g} s. Energy error: greatest in {WATCHED:g} s, relative to m g N L/2; "
        "long chains are chaotic, and single figures scatter.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
