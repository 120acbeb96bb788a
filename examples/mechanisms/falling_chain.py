r"""
The end of a falling chain overtakes a stone
============================================

A chain hangs folded from two hooks side by side. One end is let go beside a stone, and falls faster: what the hanging
half has brought to rest gave its energy to what still falls. Without thickness, after the end has come down by x
(Calkin and March, *Am. J. Phys.* 57, 1989),

.. math:: v^2 = 2 g x \, \frac{L - x/2}{L - x} .
"""

from pathlib import Path

import numpy as np

import carom
from carom.geometry import quaternion
from carom.paper import style

g, L, count = 9.81, 1.0, 41
link, half = L / count, count // 2


def fall(duration):
    scene, parent = carom.Scene(gravity=(0, 0, -g)), carom.GROUND
    depth = np.concatenate([np.arange(half + 1), np.arange(half + 1)[::-1]])
    nodes = np.stack([link * (np.arange(count + 1) > half), 0 * depth, -link * depth], axis=1)
    for a, b in zip(nodes, nodes[1:]):
        body = scene.add_body(
            mass=1 / count, inertia=3 * [link**2 / (12 * count)], position=(a + b) / 2
        )
        scene.add_joint(carom.joints.Revolute(a, (0, 1, 0)), parent, body)
        parent = body
    return carom.simulate(scene, duration, step=5e-4, method="rk8"), nodes


def main(out="out/examples"):
    s, nodes = fall(0.36)
    arms = np.diff(nodes, axis=0) / 2
    tip = np.array(
        [
            x + quaternion.rotate(q, arms[-1])
            for x, q in zip(s.position[:, -1], s.orientation[:, -1])
        ]
    )
    w, v = s.angular_velocity[:, -1], s.velocity[:, -1]
    x, v = -tip[:, 2], -(v + np.cross(w, tip - s.position[:, -1]))[:, 2]
    exact = np.sqrt(2 * g * x * (L - x / 2) / (L - x))
    ahead = x - g * s.t**2 / 2
    error = np.max(np.abs(v - exact)) / v[-1]
    print(
        f"after {s.t[-1]:g} s at {v[-1]:.2f} m/s, a stone at {g * s.t[-1]:.2f}; {1e3 * ahead[-1]:.0f} mm ahead"
    )
    print(f"speed within {100 * error:.1f} % of a chain without thickness; "
          f"energy kept to {np.max(np.abs(s.ledger.residual)):.0e} J")  # fmt: skip

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 3.0, columns=2)
        for k, t in enumerate((0, 0.15, 0.25, 0.32, 0.36)):
            position, orientation = s.evaluate(t)[:2]
            ends = [a + quaternion.rotate(q, d) for a, q, d in zip(position, orientation, arms)]
            path = np.array([nodes[0], *ends])[:, [0, 2]] + [0.12 * k, 0]
            left.plot(*path.T, color=style.BLUE)
            left.plot(*path[-1], "o", color=style.RED)
            left.plot(0.12 * k + 0.06, -g * t**2 / 2, "o", color="k")
            left.text(0.12 * k, 0.04, f"{t:g} s", fontsize=7)
        left.set(ylabel="height / m", xticks=[], xlim=(-0.03, 0.65), ylim=(-1, 0.1))
        right.plot(s.t, v, color=style.RED, label="end of the chain")
        right.plot(s.t[::40], exact[::40], ".", color=style.RED, label="closed form")
        right.plot(s.t, g * s.t, "k", label="stone")
        right.set(xlabel="time / s", ylabel="speed / m s$^{-1}$"), right.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "falling_chain.png", dpi=style.DPI)
    assert error < 0.04
    assert np.min(ahead) > -1e-12


if __name__ == "__main__":
    main()
