r"""A ball bounces to rest
======================

Infinitely many impacts in finite time: dropped from h, with restitution e, the k-th is at

.. math:: t_k = t_1 (1 + 2 e + \ldots + 2 e^{k-1}), \quad t_1 = \sqrt{2 h / g},

and the times add up to :math:`t_1 (1 + e)/(1 - e)`. Then the ball is at rest, within a step, with no threshold
to choose.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom

g, h, e, radius = 9.81, 0.4, 0.8, 0.1


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, -g))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    ball = scene.add_body(carom.Sphere(radius), mass=1.0, position=(0, 0, h + radius), name="ball")
    scene.add_contact(ball, ground, restitution=e, friction=0.0)

    solution = carom.simulate(scene, 3.0, step=1e-3)

    first = np.sqrt(2 * h / g)
    k = np.arange(6)
    exact = first * np.cumsum(np.where(k == 0, 1.0, 2 * e**k))
    rest = first * (1 + e) / (1 - e)
    held = solution.events.time[solution.events.kind == "held"][0]
    print(f"impact times: error {np.max(np.abs(solution.impacts.time[:6] - exact)):.1e} s")
    print(f"at rest from {held:.6f} s on; all bounces end at {rest:.6f} s")

    figure = Figure(figsize=(6, 3), layout="constrained")
    axes = figure.subplots()
    axes.plot(solution.t, solution.position[:, 0, 2] - radius)
    axes.plot(exact, np.zeros(6), "o")
    axes.set(xlabel="time [s]", ylabel="gap [m]")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "bouncing_sphere.png", dpi=150)

    assert np.allclose(solution.impacts.time[:6], exact, rtol=0, atol=1e-10)
    assert abs(held - rest) < 1e-3


if __name__ == "__main__":
    main()
