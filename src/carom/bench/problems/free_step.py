"""One step of a die in free flight, with the check for contact with the table."""

from __future__ import annotations

from collections.abc import Callable

from carom.bench.measure import stepper
from carom.bench.problems import planar_die

NAME, TITLE = "free_step", "Free step of a cube, with its contact check"
STEP = 1e-3
GENERAL = (0.9e-6, 1.0e-6, 1.2e-6)
FAR = {"height": 1e7, "velocity": (0.5, 0, -0.5), "spin": (0, 10, 0)}
NEAR = {"height": 0.012, "velocity": (0.5, 0, 0), "spin": (0, 0, 10), "gravity": 0.0}
#: far: the ball around the die cannot reach the table; near: it can, so the motion of each corner is bounded
CASES = {
    "equal moments, far": FAR,
    "equal moments, near (8 corners checked)": NEAR,
    "general inertia, far": {**FAR, "inertia": GENERAL},
    "general inertia, near (8 corners checked)": {**NEAR, "inertia": GENERAL},
}


def ours(case: str = "equal moments, far") -> Callable[[int], object]:
    """Return ``run(steps)`` of carom."""
    return stepper(planar_die.scene(**CASES[case]), STEP)  # pyright: ignore[reportArgumentType]


def mujoco(module, integrator: str = "Euler") -> Callable[[int], object]:
    """Return ``run(steps)`` of MuJoCo, far above a plane; the loop of steps runs in C."""
    model = module.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{STEP}" integrator="{integrator}"/>
      <worldbody><geom type="plane" size="1 1 1"/>
        <body pos="0 0 1e7"><freejoint/><geom type="box" size=".01 .01 .01" mass=".016"/></body>
      </worldbody></mujoco>""")
    data = module.MjData(model)

    def run(steps: int) -> None:
        module.mj_resetData(model, data)
        data.qvel[:] = (0.5, 0, -0.5, 0, 10, 0)
        module.mj_step(model, data, nstep=steps)

    return run
