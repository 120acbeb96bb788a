"""How random is a die?
====================

Left: the face up, of a die held at two angles and let go with a little spin. Right: how often the face that was
up comes up again. (In the pages: `python examples/many_runs/dice_study.py 120 2000`.)
"""

import sys
from pathlib import Path

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


def main(out="out/examples", basins=12, throws=40):
    tilt = np.stack(np.meshgrid(*2 * [np.linspace(-45, 45, basins)]), axis=-1).reshape(-1, 2)
    held = Rotation.from_euler("yx", tilt, degrees=True).as_quat(scalar_first=True)
    ends = carom.ensemble(die(0.1), 3.0, step=2e-3, vary={"die.orientation": held})
    turn, speed = 3 * [norm(0, 3)], 2 * [uniform(-0.2, 0.4)] + [0]
    vary, again = {"die.angular_velocity": turn, "die.velocity": speed}, []
    for height in HEIGHTS:
        e = carom.ensemble(die(height), 4.0, step=2e-3, vary=vary, runs=throws, sampling="sobol")
        assert e.counts() == {"success": throws}
        again.append(binomtest(int(np.sum(face_up(e.orientation[:, 0]) == 6)), throws))
    share = np.array([test.statistic for test in again])
    bars = np.abs(np.array([test.proportion_ci() for test in again]).T - share)
    print(HEIGHTS, share)
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.9, columns=2)
        colours = {"cmap": ListedColormap(COLOURS), "vmin": 0.5, "vmax": 6.5}
        image = face_up(ends.orientation[:, 0]).reshape(basins, basins)
        left.imshow(image, origin="lower", extent=(-45, 45, -45, 45), **colours)
        left.set(xlabel="tilt about y / degrees", ylabel="tilt about x / degrees")
        for face in range(1, 7):
            left.plot([], [], "s", color=COLOURS[face - 1], label=str(face))
        left.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), title="face up")
        right.errorbar(100 * HEIGHTS, share, bars, fmt="o-", color=style.BLUE, capsize=2)
        right.axhline(1 / 6, color=style.GREY, ls="--", label="fair: 1/6")
        right.set(xscale="log", xlabel="height / cm", ylabel="share: same face up", ylim=(0, 1.05))
        right.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "dice_study.png", dpi=style.DPI)


if __name__ == "__main__":
    main("out/examples", *map(int, sys.argv[1:]))
