"""A chain of N rods: cost against error in energy, beside MuJoCo's RK4 in the same run; cost against N.

Long chains are chaotic, so tools are compared by curves over several steps, in a time in which the errors are
still those of the method.
"""

from __future__ import annotations

import numpy as np

import carom
from common import peer, pendulum_scene, per_step, report, spread

STEPS = (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)
US = 1e-6
COUNTS = (1, 10, 40, 100)
METHODS = ("rk4", "rk5", "rk8")
BOUNDS = (1e-6, 1e-8, 1e-10)
WATCHED = 2.0  # [s]


def scale(links: int) -> float:
    """Return m g N L/2, the energy that errors are compared with."""
    return 9.81 * links / 2.0


def carom_curve(links: int, method: str) -> list[tuple[float, float]]:
    """Return (seconds of work a simulated second, error in energy) for each step."""
    scene, curve = pendulum_scene(links), []

    def run(steps):
        carom.simulate(
            scene, duration=steps * 1e-3, step=1e-3, method=method, save_every=max(steps, 1)
        )

    cost = float(np.median(per_step(run, 50, 50 + 20000 // links)))
    for step in STEPS:
        solution = carom.simulate(
            scene, duration=WATCHED, step=step, method=method,
            save_every=max(1, round(WATCHED / 100 / step)),
        )  # fmt: skip
        energy = solution.total_energy
        curve.append((cost / step, float(np.abs(energy - energy[0]).max()) / scale(links)))
    return curve


def mujoco_curve(mujoco, links: int) -> list[tuple[float, float]]:
    """Return the same of MuJoCo's RK4."""
    text, end = "", ""
    for k in range(links):
        text += f"""<body pos="{0 if k == 0 else 1} 0 0"><joint type="hinge" axis="0 1 0"/>
          <inertial pos=".5 0 0" mass="1" diaginertia="1e-4 {1 / 12} {1 / 12}"/>"""
        end += "</body>"
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><option timestep="1e-3" integrator="RK4"><flag energy="enable"/></option>
    <worldbody>{text}{end}</worldbody></mujoco>""")
    data = mujoco.MjData(model)

    def run(steps):
        mujoco.mj_resetData(model, data)
        mujoco.mj_step(model, data, nstep=steps)

    model.opt.enableflags = 0
    cost = float(np.median(per_step(run, 50, 50 + 20000 // links)))
    model.opt.enableflags = int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    curve = []
    for step in STEPS:
        model.opt.timestep = step
        mujoco.mj_resetData(model, data)
        each = max(1, round(WATCHED / 100 / step))
        energies = []
        for _ in range(round(WATCHED / step / each) + 1):
            mujoco.mj_forward(model, data)
            energies.append(data.energy.sum())
            mujoco.mj_step(model, data, nstep=each)
        error = np.abs(np.array(energies) - energies[0]).max() / scale(links)
        curve.append((cost / step, float(error)))
    return curve


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


def size() -> None:
    """Report the time of a step against the number of links."""
    rows = []
    for links in (*COUNTS, 1000):
        scene = pendulum_scene(links)

        def run(steps, scene=scene):
            carom.simulate(scene, duration=steps * 2e-4, step=2e-4, save_every=max(steps, 1))

        times = per_step(run, 50, 50 + 40000 // links)
        mid = float(np.median(times)) / US
        rows.append([str(links), spread(times, US), f"{mid / links:.2f}"])
    report(
        "chain_size", "A chain of rods: time of a step", ["links", "us a step", "us a link"], rows,
        "Order 4, step 0.2 ms.",
    )  # fmt: skip


def precision() -> None:
    """Report cost against error, and how much less work carom does for the same error."""
    mujoco = peer("mujoco")
    rows, ratios = [], []
    for links in COUNTS:
        curves = {f"carom {name}": carom_curve(links, name) for name in METHODS}
        if mujoco:
            curves["MuJoCo RK4"] = mujoco_curve(mujoco, links)
        for name, curve in curves.items():
            rows.append([str(links), name, *(f"{c:.2g} s, {e:.0e}" for c, e in curve)])
        if mujoco:
            for bound in BOUNDS:
                theirs = curves["MuJoCo RK4"]
                found = [ratio(theirs, curves[f"carom {name}"], bound) for name in METHODS]
                ratios.append([str(links), f"{bound:.0e}", *found])
    note = f"Work a simulated second, and greatest error in energy in {WATCHED:g} s, relative to m g N L/2."
    head = ["links", "tool", *(f"{1e3 * step:g} ms" for step in STEPS)]
    report("chain", "A chain of rods, released horizontal: work and error", head, rows, note)
    if ratios:
        report(
            "chain_ratio", "MuJoCo's work over carom's at equal error in energy",
            ["links", "error", *METHODS], ratios,
            "Between the points of both curves, in logarithms; a dash where MuJoCo's does not reach the error.",
        )  # fmt: skip


if __name__ == "__main__":
    size()
    precision()
