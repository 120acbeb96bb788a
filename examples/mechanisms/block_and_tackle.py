r"""A block and tackle
===================

A rope goes from a hook under the two sheaves of a block, over two fixed ones, and down to a load that
falls: four strands carry the block, so a load of a quarter of its mass holds it. Here the load is heavier, and
lifts it. The rope slips freely; acceleration and tension are compared with their closed forms.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, r = 9.81, 0.1
load, block = 1.5, 4.0

# %%
# `add_rope` lists what the rope goes over. The axis of a pulley says round which side: by the right-hand rule.


def tackle():
    scene = carom.Scene(gravity=(0, 0, -g))
    made = scene.add_body(carom.Box(0.7, 0.1, 0.1), mass=block, position=(0.3, 0, -2), name="block")
    scene.add_joint(carom.joints.Prismatic((0, 0, 1)), carom.GROUND, made)
    scene.add_body(carom.Sphere(0.06), mass=load, position=(0.8, 0, -0.8), name="load")
    under, over, ground = (0, -1, 0), (0, 1, 0), carom.GROUND
    scene.add_rope(
        [
            (ground, (0, 0, 0)),
            carom.Pulley("block", r, under, friction=0, center=(0.1, 0, -1.8)),
            carom.Pulley(ground, r, over, center=(0.3, 0, 0)),
            carom.Pulley("block", r, under, friction=0, center=(0.5, 0, -1.8)),
            carom.Pulley(ground, r, over, center=(0.7, 0, 0)),
            "load",
        ],
        name="rope",
    )
    return scene


# %%
# With the block at a quarter of the speed of the load, :math:`(m + M/16) a = (m - M/4) g`, and the tension is
# :math:`m (g - a)`.

a = (load - block / 4) * g / (load + block / 16)


def main(out="out/examples"):
    s = carom.simulate(tackle(), 1.0)
    fallen = -0.8 - s["load"].position[:, 2]
    raised = s["block"].position[:, 2] + 2.0
    tension = s["rope"].force[1:, 0]
    error = max(np.max(np.abs(fallen - 0.5 * a * s.t**2)), np.max(np.abs(4 * raised - fallen)))
    pull = np.max(np.abs(tension - load * (g - a)))
    print(
        f"load {fallen[-1]:.4f} m down, block {raised[-1]:.4f} m up; error {error:.0e} m, {pull:.0e} N"
    )
    with picture(f"{out}/block_and_tackle.png", height=3.0) as ax:
        ax.plot(s.t, fallen, label="load, down")
        ax.plot(s.t, raised, label="block, up")
        ax.set(xlabel="time / s", ylabel="path / m")
        ax.legend()
    assert error < 1e-8
    assert pull < 1e-7


if __name__ == "__main__":
    main()
