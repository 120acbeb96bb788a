"""A model in MJCF
==================

A gate falls against its stop and bounces, with the restitution that is asked for.

Gate and handle are one body. About the hinge its inertia is J = 1/3 + 1/4 + 0.01, its weight acts with
the moment g (1/2 + 1/2) cos q. From q0 = 0.3 the limit at -0.5 is first struck with
q' = -sqrt(2 g (sin 0.3 + sin 0.5) / J), and left with e = 0.6 of it.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom

g, e = 9.81, 0.6
GATE = """
<mujoco model="gate">
  <option gravity="0 0 -9.81"/>
  <compiler angle="radian"/>
  <worldbody>
    <body name="gate" pos="0 0 1">
      <joint name="hinge" axis="0 -1 0" range="-.5 2"/>
      <inertial pos=".5 0 0" mass="1" diaginertia=".01 .083333333333333333 .083333333333333333"/>
      <body name="handle" pos=".5 0 0">
        <inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="opener" joint="hinge"/></actuator>
  <keyframe><key name="open" qpos=".3"/></keyframe>
</mujoco>"""


def main(out="out/examples"):
    model = carom.load_model(GATE, keyframe="open", limit_restitution=e)
    print(model.report)
    s = carom.simulate(model.scene, 3.0, step=2e-3, method="rk8")
    q, rate = model.joints["hinge"].of(s)
    hit = s.impacts[0]
    speed = np.sqrt(2 * g * (np.sin(0.3) + np.sin(0.5)) / (1 / 3 + 1 / 4 + 0.01))
    error = max(
        abs(-hit.relative_velocity_before[0] - speed),
        abs(hit.relative_velocity_after[0] - e * speed),
    )
    print(f"strikes at {-hit.relative_velocity_before[0]:.9f} rad/s, error {error:.0e}")

    figure = Figure(figsize=(6.5, 4), layout="constrained")
    angle, turning = figure.subplots(2, 1, sharex=True)
    angle.plot(s.t, q, lw=1.2)
    angle.axhspan(-0.6, -0.5, color="0.85")
    angle.set(ylabel="hinge [rad]", ylim=(-0.6, 0.35))
    turning.plot(s.t, rate, lw=1.2)
    turning.set(xlabel="time [s]", ylabel="[rad/s]")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "load_a_model.png", dpi=150)
    assert error < 1e-9
    assert model.bodies["handle"] is model.scene["gate"]


if __name__ == "__main__":
    main()
