r"""The end of a falling chain overtakes a stone
============================================

A chain hangs folded from two hooks side by side. One end is let go beside a stone, and falls faster: what the
hanging half has brought to rest gave its energy to what still falls. Without thickness, after the end has come
down by x (Calkin and March, *Am. J. Phys.* 57, 1989),

.. math:: v^2 = 2 g x \, \frac{L - x/2}{L - x} .
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

g, L, count, half, link = 9.81, 1.0, 41, 20, 1.0 / 41


def fall(duration):
    scene, parent = carom.Scene(gravity=(0, 0, -g)), carom.GROUND
    depth = np.concatenate([np.arange(half + 1), np.arange(half + 1)[::-1]])
    nodes = np.stack([link * (np.arange(count + 1) > half), 0 * depth, -link * depth], axis=1)
    inertia = 3 * [link**2 / (12 * count)]
    for a, b in pairwise(nodes):
        body = scene.add_body(mass=1 / count, inertia=inertia, position=(a + b) / 2)
        scene.add_joint(carom.joints.Revolute(a, (0, 1, 0)), parent, body)
        parent = body
    return carom.simulate(scene, duration, step=5e-4, method="rk8"), nodes


def main(out="out/examples"):
    s, nodes = fall(0.36)
    arms = np.diff(nodes, axis=0) / 2
    arm = np.array([quaternion.rotate(q, arms[-1]) for q in s.orientation[:, -1]])
    x = -(s.position[:, -1] + arm)[:, 2]
    v = -(s.velocity[:, -1] + np.cross(s.angular_velocity[:, -1], arm))[:, 2]
    exact = np.sqrt(2 * g * x * (L - x / 2) / (L - x))
    error = np.max(np.abs(v - exact)) / v[-1]
    print(f"{v[-1]:.2f} m/s, the stone {g * s.t[-1]:.2f}; closed form within {100 * error:.1f} %")
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 3.0, columns=2)
        for k, t in enumerate((0, 0.15, 0.25, 0.32, 0.36)):
            position, orientation = s.evaluate(t)[:2]
            ends = [a + quaternion.rotate(q, d) for a, q, d in zip(position, orientation, arms)]
            path = np.array([nodes[0], *ends])[:, [0, 2]] + [0.12 * k, 0]
            left.plot(*path.T, "-o", color=style.BLUE, mfc=style.RED, mec=style.RED, markevery=[-1])
            left.plot(0.12 * k + 0.06, -g * t**2 / 2, "o", color="k")
            left.text(0.12 * k, 0.04, f"{t:g} s")
        left.set(ylabel="height / m", xticks=[], xlim=(-0.03, 0.65), ylim=(-1, 0.1))
        right.plot(s.t, v, color=style.RED, label="end of the chain")
        right.plot(s.t, exact, ":", color=style.BLUE, label="closed form")
        right.plot(s.t, g * s.t, "k", label="stone")
        right.set(xlabel="time / s", ylabel="speed / m s$^{-1}$"), right.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "falling_chain.png", dpi=style.DPI)
    assert error < 0.04
    assert np.all(x > g * s.t**2 / 2 - 1e-12)


if __name__ == "__main__":
    main()
