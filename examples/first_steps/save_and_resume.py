"""A run that is interrupted, and continues to the same bits
=========================================================

A long run writes itself to a netCDF file while it runs. Whatever ends it, `carom.resume` continues from the
file. The result is compared, bit for bit, with a run without interruption: that of a bouncing die, a motion
in which any change would grow from impact to impact.
"""

import tempfile
from pathlib import Path

import numpy as np

import carom
from carom.visual.plots.style import picture

# %%
# A die is thrown on a table, with spin about all three axes.


def throw():
    scene = carom.Scene()
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.2), velocity=(0.6, 0, 0),
        angular_velocity=(3, 10, -4), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=0.6, friction=0.2)
    return scene


# %%
# We interrupt the run after 40 % of its duration, as Ctrl-C would do it.


def power_cut(done, total):
    if done > 0.4 * total:
        raise KeyboardInterrupt


# %%
# With ``throw=False`` the interrupted run returns what it has, with a status. Then it continues from the
# file, and a third run is made in one piece.


def main(out="out/examples"):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "throw.nc"
        how = dict(step=1e-3, save=file, progress=power_cut, throw=False)
        part = carom.simulate(throw(), 1.0, **how)
        whole = carom.resume(file)
        size = file.stat().st_size
    straight = carom.simulate(throw(), 1.0, step=1e-3)
    same = np.array_equal(whole.position, straight.position)
    print(f"{part.status.name} at {part.t[-1]:g} s after {len(part.impacts)} impacts; then "
          f"{len(whole.impacts)} impacts to {whole.t[-1]:g} s, a file of {size / 1e3:.0f} kB")  # fmt: skip
    print("the same bits as without interruption:", same)

    with picture(f"{out}/save_and_resume.png") as axes:
        axes.plot(part.t, 1e3 * part.position[:, 0, 2], lw=4, label="before the interruption")
        axes.plot(whole.t, 1e3 * whole.position[:, 0, 2], label="resumed from the file")
        axes.plot(straight.t[::25], 1e3 * straight.position[::25, 0, 2], "k.", label="in one run")
        axes.set(xlabel="time / s", ylabel="height of the die / mm"), axes.legend()
    assert same
    assert part.t[-1] < 0.5 < whole.t[-1]


if __name__ == "__main__":
    main()
