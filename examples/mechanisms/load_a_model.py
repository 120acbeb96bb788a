"""A model in MJCF
===============

A gate from a file of MuJoCo's format falls against its stop and bounces. In the file the stop is soft; here
it has the restitution that we ask for. The velocities before and after the first impact are compared with
their closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

# %%
# The gate turns about a hinge with a limit at -0.5 rad. Its handle is a body without a joint, so both become
# one body.

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

# %%
# About the hinge the inertia is J = 1/3 + 1/4 + 0.01, and the weight has the moment g cos q. From q = 0.3 the
# limit is reached with
#
# .. math:: \dot q = -\sqrt{2 g (\sin 0.3 + \sin 0.5) / J}
#
# and left with the part e of this.

speed = np.sqrt(2 * g * (np.sin(0.3) + np.sin(0.5)) / (1 / 3 + 1 / 4 + 0.01))

# %%
# `carom.load_model` returns a scene, the joints by their names, and a report about what it has read and what
# it could not use.


def main(out="out/examples"):
    model = carom.load_model(GATE, keyframe="open", limit_restitution=e)
    print(model.report)
    s = carom.simulate(model.scene, 3.0, step=2e-3, method="rk8")
    q, rate = model.joints["hinge"].of(s)
    hit = s.impacts[0]
    before, after = -hit.relative_velocity_before[0], hit.relative_velocity_after[0]
    error = max(abs(before - speed), abs(after - e * speed))
    print(f"strikes at {before:.9f} rad/s, error {error:.0e}")

    with picture(f"{out}/load_a_model.png", height=3.2, rows=2, sharex=True) as (angle, turning):
        angle.plot(s.t, q)
        angle.axhspan(-0.6, -0.5, color="0.85")
        angle.set(ylabel="hinge / rad", ylim=(-0.6, 0.35))
        turning.plot(s.t, rate)
        turning.set(xlabel="time / s", ylabel="rate / rad s$^{-1}$")
    assert error < 1e-9
    assert model.bodies["handle"] is model.scene["gate"]


if __name__ == "__main__":
    main()
