"""The paper's planar die: it is thrown with spin, strikes a table on an edge, and friction turns it back."""

from __future__ import annotations

import math

from carom.bench.problems.task import Task, carom_task, solref
from carom.paper.runs import GRAVITY, MASS
from carom.paper.runs import die as scene

NAME, TITLE = "planar_die", "Planar die, one impact with friction"
ERROR = "error of its centre at 0.3 s [m]"
METHODS, STEPS, PEER_STEPS = ("rk4",), (1e-2, 1e-3, 1e-4), (1e-3, 1e-4, 1e-5)
DURATION, END = 0.6, 0.3  # s, after the first impact, before the second
FIRST = 0.196210991904  # s
# m/s, (v_x, v_z) after it: Routh's impulse in closed form
AFTER = -0.104880400901, 0.599572173967


def centre() -> tuple[float, float]:
    """Return the position (x, z) of the centre at END."""
    s, z = END - FIRST, 0.3 - 0.5 * FIRST - 0.5 * GRAVITY * FIRST**2
    return 0.5 * FIRST + AFTER[0] * s, z + AFTER[1] * s - 0.5 * GRAVITY * s * s


def wrong(x: float, z: float) -> float:
    """Return the distance of a position from `centre`."""
    return math.hypot(x - centre()[0], z - centre()[1])


def ours(step: float, method: str = "rk4") -> Task:
    """Return the work of carom."""
    return carom_task(
        scene(), DURATION, step, method, lambda run: wrong(*run.position[-1, 0, [0, 2]]), until=END
    )


def model(module, step: float, frequency: float):
    """Return MuJoCo's model of the die and its data, before any throw."""
    made = module.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10">
    <flag refsafe="disable"/></option><default><geom condim="3" friction=".2 0 0" solimp=".999 .999 .001"
    solref="{solref(frequency, 0.2155)}"/></default>
    <worldbody><geom type="plane" size="0 0 1"/><body pos="0 0 .3"><freejoint/>
    <geom type="box" size=".01 .01 .01" mass="{MASS}"/></body></worldbody></mujoco>""")
    return made, module.MjData(made)


def stiffness(step: float) -> float:
    """Return the best frequency found of the contact [rad/s] that the step resolves."""
    return {1e-3: 500.0, 1e-4: 3000.0}.get(step, 0.2 / step)


def throw(module, made, data, steps: int, spin=(0, 10, 0), turn=(1, 0, 0, 0)):
    """Throw MuJoCo's die; return the final position of its centre."""
    module.mj_resetData(made, data)
    data.qpos[:] = [0, 0, 0.3, *turn]
    data.qvel[:] = [0.5, 0, -0.5, *spin]
    module.mj_step(made, data, nstep=steps)
    return data.qpos[:3]


def mujoco(module, step: float, duration: float = DURATION) -> Task:
    """Return the work of MuJoCo with springs and dampers, which are stiffer with a smaller step."""
    made, data = model(module, step, stiffness(step))

    def error() -> float:
        x = throw(module, made, data, round(END / step))
        return wrong(x[0], x[2])

    return Task(step, lambda: throw(module, made, data, round(duration / step)), error)
