"""A run that is killed, and goes on to the same bits
==================================================

A long run writes itself to a netCDF file as it goes. Whatever ends it, `carom.resume` goes on from the file,
and the end is that of a run without interruption, bit for bit: here for a die, a motion in which any change
would have grown from bounce to bounce.
"""

import tempfile
from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style


def throw():
    scene = carom.Scene()
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.2), velocity=(0.6, 0, 0),
        angular_velocity=(3, 10, -4), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=0.6, friction=0.2)
    return scene


def power_cut(done, total):
    if done > 0.4 * total:
        raise KeyboardInterrupt


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

    with style.style():
        figure, axes = style.new(style.PAGE, 2.2)
        height = 1e3 * whole.position[:, 0, 2]
        n = len(part.t)
        axes.plot(whole.t[n - 1 :], height[n - 1 :], color=style.RED, label="resumed from the file")
        axes.plot(part.t, height[:n], color=style.BLUE, label="before the cut")
        axes.plot(straight.t[::25], 1e3 * straight.position[::25, 0, 2], "k.", label="in one go")
        axes.axvline(part.t[-1], color=style.GREY, lw=0.8, ls="--")
        axes.set(xlabel="time / s", ylabel="height of the die / mm")
        axes.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "save_and_resume.png", dpi=style.DPI)
    assert same
    assert part.t[-1] < 0.5 < whole.t[-1]


if __name__ == "__main__":
    main()
