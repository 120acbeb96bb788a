"""A stack of 20 boxes that slides as one body and is slowed by friction, with 80 points in persistent contact.

The coefficient of friction is 0.5 between boxes and 0.02 on the floor: only the lowest box slips, and all have
x = v t - mu g t^2/2. (It does not tip over: mu times the height of its centre, 1 m, is less than half an edge.)
"""

from __future__ import annotations

import numpy as np

from carom.bench.problems.task import Task, carom_task

NAME, TITLE = "stack", "Stack of 20 boxes that slides, 0.2 s"
ERROR = "greatest error of a box [m]"
METHODS, STEPS, PEER_STEPS = ("rk4",), (5e-3, 2e-3, 1e-3), (5e-3, 2e-3, 1e-3, 5e-4)
BOXES, EDGE, SPEED, MU, BETWEEN, GRAVITY, DURATION = 20, 0.1, 1.0, 0.02, 0.5, 9.81, 0.2


def scene(count: int = BOXES):
    """Return the sliding stack."""
    import carom

    made = carom.Scene(gravity=(0, 0, -GRAVITY))
    below = made.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(count):
        box = made.add_body(
            carom.Box(EDGE, EDGE, EDGE), mass=1.0, position=(0, 0, (k + 0.5) * EDGE),
            velocity=(SPEED, 0, 0),
        )  # fmt: skip
        made.add_contact(box, below, restitution=0.0, friction=BETWEEN if k else MU)
        below = box
    return made


def places(count: int = BOXES) -> np.ndarray:
    """Return the positions of the centres at the end."""
    z = (np.arange(count) + 0.5) * EDGE
    x = SPEED * DURATION - 0.5 * MU * GRAVITY * DURATION**2
    return np.stack([np.full(count, x), np.zeros(count), z], axis=1)


def ours(step: float, method: str = "rk4", boxes: int = BOXES) -> Task:
    """Return the work of carom."""

    def wrong(run) -> float:
        return np.abs(run.position[-1] - places(boxes)).max()

    return carom_task(scene(boxes), DURATION, step, method, wrong, by_steps=True)


def mujoco(module, step: float, boxes: int = BOXES) -> Task:
    """Return the work of MuJoCo, with the contact stiffness that it advises for the step."""
    half = EDGE / 2
    text = "".join(
        f'<body pos="0 0 {(k + 0.5) * EDGE}"><freejoint/><geom type="box" size="{half} {half} {half}" mass="1" '
        f'friction="{BETWEEN} 0 0"/></body>'
        for k in range(boxes)
    )
    made = module.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10"
    gravity="0 0 {-GRAVITY}"/><default><geom solref="{2 * step} 1"/></default>
    <worldbody><geom type="plane" size="0 0 1" friction="{MU} 0 0" priority="1"/>
    {text}</worldbody></mujoco>""")
    data = module.MjData(made)

    def steps(count: int):
        module.mj_resetData(made, data)
        data.qvel.reshape(boxes, 6)[:, 0] = SPEED
        module.mj_step(made, data, nstep=count)
        return data.qpos.reshape(boxes, 7)[:, :3]

    count = round(DURATION / step)

    def error() -> float:
        return float(np.abs(steps(count) - places(boxes)).max())

    return Task(step, lambda: steps(count), error, steps, count)
