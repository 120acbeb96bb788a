r"""A ball bounces to rest
======================

A ball that falls on a floor bounces infinitely often in a finite time. The run finds each impact, and it
finds the end of all impacts within one step, without a threshold that a user would have to choose. Both are
compared with their closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, h, e, radius = 9.81, 0.4, 0.8, 0.1

# %%
# The scene is a floor and a ball, which starts at the height h above the floor. Their contact has the
# restitution e and no friction.


def drop():
    scene = carom.Scene(gravity=(0, 0, -g))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    ball = scene.add_body(carom.Sphere(radius), mass=1.0, position=(0, 0, h + radius), name="ball")
    scene.add_contact(ball, ground, restitution=e, friction=0.0)
    return carom.simulate(scene, 3.0, step=1e-3)


# %%
# The first impact is at :math:`t_1 = \sqrt{2 h / g}`. Each flight that follows is shorter than the last one
# by the factor e, so impact number k is at
#
# .. math:: t_k = t_1 (1 + 2 e + \ldots + 2 e^{k-1}).
#
# These times have the limit :math:`t_1 (1 + e)/(1 - e)`. From then on the ball is at rest.

first, k = np.sqrt(2 * h / g), np.arange(6)
exact = first * np.cumsum(np.where(k == 0, 1.0, 2 * e**k))
rest = first * (1 + e) / (1 - e)

# %%
# The solution has a table of impacts and a table of events. At the event ``"held"`` a persistent contact
# begins.


def main(out="out/examples"):
    s = drop()
    settled = s.events.time[s.events.kind == "held"][0]
    print(f"impact times: error {np.max(np.abs(s.impacts.time[:6] - exact)):.1e} s")
    print(f"at rest from {settled:.6f} s on; all bounces end at {rest:.6f} s")
    with picture(f"{out}/bouncing_sphere.png") as axes:
        axes.plot(s.t, s.position[:, 0, 2] - radius)
        axes.plot(exact, np.zeros(6), "ko", label="closed form")
        axes.set(xlabel="time / s", ylabel="gap / m"), axes.legend()
    assert np.allclose(s.impacts.time[:6], exact, rtol=0, atol=1e-10)
    assert abs(settled - rest) < 1e-3


if __name__ == "__main__":
    main()
