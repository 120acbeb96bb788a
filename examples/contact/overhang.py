r"""How far a stack of blocks may lean over the table
=================================================

Four equal blocks can stand on a table so that the whole of the top block is beyond its edge. The greatest
overhang of such a stack is known. A stack with one per cent less must stand to round-off, and a stack with
one per cent more must fall.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, length, thick, count = 9.81, 0.2, 0.03, 4

# %%
# From the top down, the blocks just balance if each one reaches over the next by 1/2, 1/4, 1/6 and 1/8 of its
# length. Together this is
#
# .. math:: \frac{1}{2} \left( 1 + \frac{1}{2} + \frac{1}{3} + \frac{1}{4} \right) = \frac{25}{24}
#
# of the length of a block. We build the stack with a part of this overhang.


def stack(part):
    scene = carom.Scene(gravity=(0, 0, -g))
    scene.add_static(carom.Box(0.4, 0.2, 0.1), position=(-0.2, 0, -0.05), name="table")
    x = -length / 2
    for k in range(count):  # from the table up
        x += part * length / (2 * (count - k))
        scene.add_body(carom.Box(length, 0.1, thick), mass=1.0, position=(x, 0, (k + 0.5) * thick))
    scene.set_contact_default(restitution=0.0, friction=0.5)
    return carom.simulate(scene, 0.4, step=2e-3)


# %%
# The blocks of the first stack do not move at all. Those of the second one turn about the edge of the table.


def main(out="out/examples"):
    with picture(f"{out}/overhang.png", columns=2) as panels:
        for axes, part in zip(panels, (0.99, 1.01)):
            s = stack(part)
            moved = np.max(np.linalg.norm(s.position[-1] - s.position[0], axis=1))
            reach = s.position[0, -1, 0] + length / 2
            print(f"{reach / length:.4f} lengths over the edge: the blocks move by {moved:.1e} m")
            axes.imshow(carom.films.still(s, size=(800, 600), view=(-75, 12)))
            axes.set(title=f"{reach / length:.3f} lengths beyond the edge"), axes.axis("off")
            assert (moved < 1e-12) == (part < 1)


if __name__ == "__main__":
    main()
