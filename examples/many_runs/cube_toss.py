"""Real tosses of a real cube
==========================

A cube was tossed, and motion capture has measured its path (ContactNets, Pfrommer, Halm and Posa 2020). Each
toss is simulated from flight to rest, and its path is compared with the measured one. The parameters of the
contact were fitted to such tosses; how, is in the tutorial *From a measured video to e and mu*.
"""

from importlib.resources import files
from itertools import pairwise

import numpy as np

import carom
from carom.geometry import quaternion
from carom.studies import identify
from carom.visual.plots import style

EDGE = 0.1024  # [m], in the lengths of the recording, which are 2 % too short
FITTED = {"restitution": 0.25, "friction": 0.165, "friction_held": 0.226, "corner_radius": 0.00475}


# %%
# The poses are second differences in micrometres. The simulation of a toss starts from the free flight that
# fits its samples best, up to a height of 3 mm of the lowest corner.


def recordings(scene, most):
    with np.load(files("carom.paper") / "data" / "cube_tosses_even.npz") as data:
        poses = 1e-6 * np.cumsum(np.cumsum(data["pose"], axis=0, dtype=np.int64), axis=0)
        ends = data["offsets"]
    for number, (i, j) in enumerate(pairwise(ends[: most + 1])):
        t, x, q = np.arange(j - i) / 148, poses[i:j, :3], quaternion.normalize(poses[i:j, 3:])
        n = identify.free_samples(x, q, scene.bodies[0].shape, clearance=0.003)
        start = identify.fit_free_flight(t[:n], x[:n], q[:n], scene.gravity).state
        yield identify.Recording(t, x, q, start, f"toss {number}")


# %%
# All tosses are simulated with the same parameters. The errors are means over a toss: of the distance of the
# centres, relative to the edge, and of the angle between the attitudes. No run may fail, and the energy of each
# must be accounted for. The picture has the toss whose errors are nearest to the medians.


def main(out="out/examples", most=24):
    scene = carom.Scene(gravity=(0, 0, -9.614))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    inertia = np.full(3, 7.73e-4)
    cube = scene.add_body(
        carom.Box(EDGE, EDGE, EDGE), mass=0.37, inertia=inertia, position=(0, 0, 1), name="cube"
    )
    scene.add_contact(cube, table, restitution=0.125, friction=0.18)
    tosses = list(recordings(scene, most))

    def tossed(toss):
        return identify.varied(scene, **FITTED, inertia_factor=1.22, start=toss.start)

    runs = identify.roll_outs(tossed, tosses, step=1 / 592)
    errors = np.array([identify.trajectory_error(*pair, EDGE) for pair in zip(runs, tosses)])
    middle = np.median(errors, axis=0)
    print(f"{most} tosses: medians {100 * middle[0]:.1f} %, {np.degrees(middle[1]):.1f} deg")
    print(f"energy accounted for to {max(run.residual for run in runs):.1e} J")
    typical = int(np.argmin(np.abs(np.log(errors / middle)).sum(axis=1)))
    toss, run = tosses[typical], runs[typical]

    with style.picture(f"{out}/cube_toss.png", columns=2) as (path, spread):
        for k, (name, colour) in enumerate(zip("xyz", (style.BLUE, style.ORANGE, style.RED))):
            path.plot(toss.t, toss.position[:, 0, k], ".", color=colour, ms=2.5)
            path.plot(toss.t, run.position[:, 0, k], color=colour, label=f"${name}$")
        path.set(xlabel="time [s]", ylabel="centre of the cube [m]", title=toss.name)
        path.legend()
        spread.plot(100 * errors[:, 0], np.degrees(errors[:, 1]), "o")
        spread.set(xlabel="error of position [% of the edge]", ylabel="of rotation [deg]")
    assert not any(run.message for run in runs)
    assert middle[0] < 0.15


if __name__ == "__main__":
    main()
