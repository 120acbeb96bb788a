r"""How far a stack of blocks may lean over the table
=================================================

Four blocks just balance if from the top down they reach over by 1/2, 1/4, 1/6 and 1/8 of their length: together
25/24, and the top block is wholly beyond the edge. A per cent less stands, to round-off; a per cent more
falls.
"""

from pathlib import Path

import numpy as np
from matplotlib.patches import Polygon

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

g, length, thick, count = 9.81, 0.2, 0.03, 4
SIGNS = np.array([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)])


def stack(part):
    scene = carom.Scene(gravity=(0, 0, -g))
    table = scene.add_body(carom.Box(0.4, 0.2, 0.1), mass=1.0, position=(-0.2, 0, -0.05))
    scene.add_joint(carom.joints.Fixed(), carom.GROUND, table)
    x = -length / 2
    for k in range(count):  # from the table up
        x += part * length / (2 * (count - k))
        scene.add_body(carom.Box(length, 0.1, thick), mass=1.0, position=(x, 0, (k + 0.5) * thick))
    scene.set_contact_default(restitution=0.0, friction=0.5)
    return carom.simulate(scene, 0.4, step=2e-3)


def draw(axes, s, t, **look):
    position, orientation = s.evaluate(t)[:2]
    for body, x, q in zip(s.scene.bodies, position, orientation):
        corners = [quaternion.rotate(q, body.shape.half * c)[[0, 2]] for c in SIGNS]
        axes.add_patch(Polygon(x[[0, 2]] + np.array(corners), **look))


def main(out="out/examples"):
    with style.style():
        figure, axes = style.new(style.PAGE, 2.2, columns=2, sharey=True)
        for one, part in zip(axes, (0.99, 1.01)):
            s = stack(part)
            moved = np.max(np.linalg.norm(s.position[-1] - s.position[0], axis=1))
            reach = s.position[0, -1, 0] + length / 2
            print(f"{reach / length:.4f} lengths over the edge: the blocks move by {moved:.1e} m")
            draw(one, s, 0.0, fc="0.93", ec="0.7", lw=0.8)
            draw(one, s, 0.4, fc="none", ec=style.BLUE if part < 1 else style.RED)
            limit = sum(length / (2 * k) for k in range(1, count + 1))
            one.axvline(limit, color=style.GREY, ls="--", lw=0.8)
            title = "stands" if part < 1 else "falls (after 0.4 s)"
            one.set(title=f"{reach / length:.3f} lengths: {title}", aspect="equal", xlabel="x / m")
            one.set(xlim=(-0.25, 0.28), ylim=(-0.06, 0.15))
            assert (moved < 1e-12) == (part < 1)
        axes[0].set(ylabel="z / m")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "overhang.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
