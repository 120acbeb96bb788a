"""Two four-bars in a row (IFToMM A02): closed loops, redundant rows, all bars in line once in each half turn.

All bars have 1 m and 1 kg. There is one degree of freedom, the angle theta of the N + 1 upright bars from the
vertical: theta'' = g sin(theta) ((N + 1)/2 + N) / ((N + 1)/3 + N).
"""

from __future__ import annotations

import math

import numpy as np

from carom.bench.problems.task import Task, carom_task

NAME, TITLE = "four_bar", "Four-bars (A02), 10 s"
ERROR = "error of the tip at the end [m]"
METHODS, STEPS = ("rk4", "rk5", "rk8"), (2e-2, 1e-2, 5e-3, 2.5e-3)
PEER_STEPS = (4e-3, 2e-3, 1e-3, 5e-4)
BARS, GRAVITY, DURATION = 2, 9.81, 10.0
TIP = (0.328458111536, 0.944518538180)  # m at 10 s: elliptic motion


def scene(count: int = BARS):
    """Return `count` upright four-bars with theta' = 1 rad/s."""
    import carom

    made, hinge = carom.Scene(gravity=(0, -GRAVITY, 0)), carom.joints.Revolute
    z = np.array([0.0, 0.0, 1.0])
    bar = {"mass": 1.0, "inertia": np.full(3, 1 / 12)}
    swing = {"velocity": (0.5, 0, 0), "angular_velocity": -z}
    ups = [made.add_body(position=(k, 0.5, 0), **swing, **bar) for k in range(count + 1)]
    for k in range(count + 1):
        made.add_joint(hinge((k, 0, 0), z), carom.GROUND, ups[k])
    for k in range(count):
        across = made.add_body(position=(k + 0.5, 1, 0), velocity=(1, 0, 0), **bar)
        made.add_joint(hinge((k, 1, 0), z), ups[k], across)
        made.add_joint(hinge((k + 1, 1, 0), z), ups[k + 1], across)
    return made


def ours(step: float, method: str = "rk4") -> Task:
    """Return the work of carom."""

    def wrong(run) -> float:
        return np.hypot(*(2.0 * run.position[-1, 0, :2] - TIP))

    return carom_task(scene(), DURATION, step, method, wrong, by_steps=True)


def mujoco(module, step: float) -> Task:
    """Return the work of MuJoCo: hinges, and loops closed by equalities as stiff as it advises for the step."""
    bar = '<inertial pos="{} {} 0" mass="1" diaginertia=".0833333 .0833333 .0833333"/>'
    bodies = []
    for k in range(BARS + 1):
        across = (
            f'<body name="a{k}" pos="0 1 0"><joint axis="0 0 1"/>{bar.format(0.5, 0)}</body>'
            if k < BARS
            else ""
        )
        bodies.append(
            f'<body name="u{k}" pos="{k} 0 0"><joint name="j{k}" axis="0 0 1"/>{bar.format(0, 0.5)}'
            f"{across}</body>"
        )
    ties = "".join(
        f'<connect body1="a{k}" body2="u{k + 1}" anchor="1 0 0" solref="{2 * step} 1"/>'
        for k in range(BARS)
    )
    made = module.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{step}" integrator="implicitfast" gravity="0 {-GRAVITY} 0"/>
    <worldbody>{"".join(bodies)}</worldbody><equality>{ties}</equality></mujoco>""")
    data = module.MjData(made)
    ups = [made.joint(f"j{k}").dofadr[0] for k in range(BARS + 1)]

    def steps(count: int):
        module.mj_resetData(made, data)
        data.qvel[:] = 0.0
        for k, address in enumerate(ups):
            data.qvel[address] = -1.0
            if k < BARS:
                data.qvel[address + 1] = 1.0  # the bars across stay level
        module.mj_step(made, data, nstep=count)
        return data.qpos[ups[0]]

    count = round(DURATION / step)

    def error() -> float:
        lean = -steps(count)
        return math.hypot(math.sin(lean) - TIP[0], math.cos(lean) - TIP[1])

    return Task(step, lambda: steps(count), error, steps, count)
