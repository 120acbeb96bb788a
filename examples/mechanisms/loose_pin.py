r"""Loose pin: the orbit of a pin in its bush
=========================================

A crank drives a slider by a rod. The pin between rod and slider is 0.2 mm thinner in radius than its bush, as
after long wear. So it flies through its play, strikes the bush, bounces, and slides along it: the slider gets
blows in place of the smooth force of a tight pin. Instead of a spring whose stiffness has to be chosen, the
pin is a `Clearance`: blows are located, with restitution, and contact that lasts has its force.
"""

import numpy as np

import carom
from carom import GROUND, joints
from carom.geometry import quaternion
from carom.visual.plots.style import picture

A, B, PLAY, TURN = 0.05, 0.12, 2e-4, 20 * np.pi  # crank and rod [m], play [m], speed [rad/s]
Y = (0, 1, 0)

# %%
# The motor speeds up within its first turn. Gravity is left out; masses are 0.3, 0.2 and 0.15 kg.


def turn(t):
    angle = TURN * t
    return angle - np.sin(angle), TURN * (1 - np.cos(angle)), TURN**2 * np.sin(angle)


def mechanism(loose):
    scene = carom.Scene(gravity=(0, 0, 0))
    parts = (("crank", 0.3, A / 2, A), ("rod", 0.2, A + B / 2, B), ("slider", 0.15, A + B, 0.03))
    for name, mass, x, size in parts:
        scene.add_body(carom.Box(size, 0.01, 0.01), mass=mass, position=(x, 0, 0), name=name)
    axle = scene.add_joint(joints.Revolute((0, 0, 0), Y), GROUND, "crank")
    scene.add_joint(joints.Revolute((A, 0, 0), Y), "crank", "rod")
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, "slider", name="way")
    if loose:
        rubs = dict(radius=8e-3, friction=0.03, restitution=0.5)
        pin = joints.Clearance((A + B, 0, 0), Y, radial=PLAY, **rubs)
        scene.add_joint(pin, "rod", "slider", name="pin")
    else:
        scene.add_joint(joints.Revolute((A + B, 0, 0), Y), "rod", "slider", name="pin")
    scene.add_constraint(carom.constraints.Driver(axle, motion=turn))
    return scene


# %%
# The place of the pin in its bush is that of the slider beside the end of the rod.


def main(out="out/examples"):
    tight, s = (carom.simulate(mechanism(loose), 0.3, save_at=2e-4) for loose in (False, True))
    end = s["rod"].position + quaternion.rotate(s["rod"].orientation, np.array([B / 2, 0, 0]))
    place = (s["slider"].position - end)[:, [0, 2]]
    away = np.abs(s["way"].coordinate - tight["way"].coordinate).max()
    blows = s.impacts.impulse[:, 0]
    print(
        f"{len(s.impacts)} blows of up to {blows.max():.2f} N s; the slider is away by {1e3 * away:.2f} mm"
    )
    with picture(f"{out}/loose_pin.png", columns=2) as (orbit, beyond):
        circle = np.linspace(0, 2 * np.pi, 200)
        orbit.plot(np.cos(circle), np.sin(circle), color="0.7", lw=1)
        orbit.plot(*(place.T / PLAY), lw=0.6)
        orbit.set(xlabel="x / play", ylabel="z / play", aspect="equal", title="the pin in its bush")
        beyond.plot(s.t, s["way"].rate - tight["way"].rate, lw=0.9)
        beyond.set(
            xlabel="time / s", ylabel="velocity of the slider beside\nthat with a tight pin / (m/s)"
        )
    assert np.hypot(*place.T).max() < PLAY * (1 + 1e-6)
    assert away < 1.2 * PLAY
    assert np.abs(s.ledger.residual).max() < 1e-3 * np.abs(s.ledger.loads).max()


if __name__ == "__main__":
    main()
