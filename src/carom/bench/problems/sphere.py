"""A ball that bounces without loss for 60 s, from a height of 0.4 m."""

from __future__ import annotations

from carom.bench.problems.task import Task, carom_task, solref
from carom.paper.runs import DROP, GRAVITY, sphere

NAME, TITLE = "sphere", "Bouncing ball, e = 1, 60 s"
ERROR = "error of its height at the end [m]"
METHODS, STEPS, PEER_STEPS = ("rk4",), (1e-2, 1e-3, 1e-4), (1e-3, 3e-4, 1e-4)
RADIUS, DURATION = 0.1, 60.0


def height(t: float) -> float:
    """Return the height of the centre."""
    from carom.paper.references import Bounce

    return RADIUS + float(Bounce(1.0).motion(t)[0])


def ours(step: float, method: str = "rk4", duration: float = DURATION) -> Task:
    """Return the work of carom."""
    return carom_task(
        sphere(1.0), duration, step, method,
        lambda run: abs(run.position[-1, 0, 2] - height(duration)),
    )  # fmt: skip


def mujoco(module, step: float, duration: float = DURATION) -> Task:
    """Return the work of MuJoCo with an undamped spring, as stiff as the step allows."""
    model = module.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{step}" integrator="implicitfast" gravity="0 0 {-GRAVITY}">
    <flag refsafe="disable"/></option>
    <default><geom solref="{solref(0.2 / step, 0.0)}" solimp=".9999 .9999 .001" condim="1"/></default>
    <worldbody><geom type="plane" size="0 0 1"/><body pos="0 0 {RADIUS + DROP}"><freejoint/>
    <geom type="sphere" size="{RADIUS}" mass="1"/></body></worldbody></mujoco>""")
    data = module.MjData(model)

    def run():
        module.mj_resetData(model, data)
        module.mj_step(model, data, nstep=round(duration / step))
        return data.qpos[2]

    return Task(step, run, lambda: abs(run() - height(duration)))
