"""How random is a die?
====================

A die is released with little spin. How high must it fall until nobody can tell the face that comes up?
Ensembles of runs give an answer: from 2 cm the first face comes back in most throws, from 8 cm on in about
1/6 of them, as of a fair die. (For a finer picture: ``python examples/many_runs/dice_study.py 120 2000``.)
"""

import sys

import numpy as np
from matplotlib.colors import ListedColormap
from scipy.spatial.transform import Rotation
from scipy.stats import binomtest, norm, uniform

import carom
from carom.studies.ensembles.dice import face_up
from carom.visual.plots import style

COLOURS = (style.BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.RED, style.SKY)
HEIGHTS = np.array([0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64])


def die(height):
    scene = carom.Scene(gravity=(0, 0, -9.81))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    box = carom.Box(0.02, 0.02, 0.02)
    start = {"velocity": (0.2, 0, 0), "angular_velocity": (0, 5, 0)}
    cube = scene.add_body(box, mass=0.016, position=(0, 0, height + 0.02), name="die", **start)
    scene.add_contact(cube, table, restitution=0.5, friction=0.2)
    return scene


# %%
# The first ensemble varies the orientation at the start, on a grid of two angles. We return the face that is
# up at the end.


def faces(count):
    tilt = np.stack(np.meshgrid(*2 * [np.linspace(-45, 45, count)]), axis=-1).reshape(-1, 2)
    start = Rotation.from_euler("yx", tilt, degrees=True).as_quat(scalar_first=True)
    ends = carom.ensemble(die(0.1), 3.0, step=2e-3, vary={"die.orientation": start})
    return face_up(ends.orientation[:, 0]).reshape(count, count)


# %%
# The other ensembles vary spin and velocity at random, one ensemble for each height. Face 6 is up at the
# start; we count how often it is up at the end.


def again(height, throws):
    turn, speed = 3 * [norm(0, 3)], 2 * [uniform(-0.2, 0.4)] + [0]
    vary = {"die.angular_velocity": turn, "die.velocity": speed}
    e = carom.ensemble(die(height), 4.0, step=2e-3, vary=vary, runs=throws, sampling="sobol")
    assert e.counts() == {"success": throws}
    return binomtest(int(np.sum(face_up(e.orientation[:, 0]) == 6)), throws)


# %%
# On the left each point is a run. Near level starts (in the middle) face 6 stays up; elsewhere small changes
# of the start change the face. On the right are the shares with their intervals of confidence (95 %).


def main(out="out/examples", basins=12, throws=40):
    tests = [again(height, throws) for height in HEIGHTS]
    share = np.array([test.statistic for test in tests])
    bars = np.abs(np.array([test.proportion_ci() for test in tests]).T - share)
    print(HEIGHTS, share)
    with style.picture(f"{out}/dice_study.png", height=2.9, columns=2) as (left, right):
        colours = {"cmap": ListedColormap(COLOURS), "vmin": 0.5, "vmax": 6.5}
        image = left.imshow(faces(basins), origin="lower", extent=(-45, 45, -45, 45), **colours)
        left.figure.colorbar(image, ax=left, ticks=range(1, 7), label="face up")
        left.set(xlabel="tilt about y / degrees", ylabel="tilt about x / degrees")
        right.errorbar(100 * HEIGHTS, share, bars, fmt="o-", capsize=2)
        right.axhline(1 / 6, color=style.GREY, ls="--", label="fair: 1/6")
        right.set(xscale="log", xlabel="height / cm", ylabel="share: same face up", ylim=(0, 1.05))
        right.legend()


if __name__ == "__main__":
    main("out/examples", *map(int, sys.argv[1:]))
