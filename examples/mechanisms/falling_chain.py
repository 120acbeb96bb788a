r"""
The end of a falling chain overtakes a stone
============================================

A chain hangs folded from two hooks at one height, and one end is let go beside a stone. The end falls faster than the
stone: what has come to rest in the hanging half gave its energy to what still falls. A chain without thickness has
(Calkin and March, 1989), after its end has come down by x,

.. math:: v^2 = \frac{2 g x \, (L - x/2)}{L - x} .
"""

from pathlib import Path

import numpy as np

import carom
from carom.paper import style

g, L, count, gap = 9.81, 1.0, 41, 0.0


def main(out="out/examples"):
    import time
    t0 = time.time()
    link = L / count
    scene = carom.Scene(gravity=(0, 0, -g))
    half = (count - 1) // 2
    nodes = [np.array([0, 0, -k * link]) for k in range(half + 1)]
    nodes += [np.array([link, 0, -(half - k) * link]) for k in range(half + 1)]
    parent = carom.GROUND
    for a, b in zip(nodes, nodes[1:]):
        inertia = 1 / count * link**2 / 12
        body = scene.add_body(mass=1 / count, inertia=3 * [inertia], position=(a + b) / 2)
        scene.add_joint(carom.joints.Revolute(a, (0, 1, 0)), parent, body)
        parent = body
    s = carom.simulate(scene, 0.42, step=1e-3)
    from carom.geometry import quaternion
    last = s.scene.bodies[-1]
    arm = nodes[-1] - (nodes[-1] + nodes[-2]) / 2
    tip = np.array([x + quaternion.rotate(q, arm) for x, q in zip(s.position[:, -1], s.orientation[:, -1])])
    stone = -g * s.t**2 / 2
    x = -tip[:, 2]
    v = np.gradient(x, s.t)
    true = np.sqrt(2 * g * x * (L - x / 2) / (L - x))
    print(np.c_[s.t, x, -stone, v, true, tip[:, 0]][::30], np.abs(s.ledger.residual).max(), time.time() - t0)

if __name__ == "__main__":
    main()
