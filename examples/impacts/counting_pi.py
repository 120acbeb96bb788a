r"""Two balls and a wall count the digits of pi
===========================================

A heavy ball pushes a light one against a wall, all elastic. With a mass ratio of :math:`100^k` the number of
impacts is 3, 31, 314, 3141: the first digits of :math:`\pi` (Galperin, 2003). In the coordinates
:math:`\sqrt{M} V, \sqrt{m} v` energy is a circle, and each impact an arc of :math:`2 \arctan \sqrt{m/M}` on it.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

m = 1.0

# %%
# The scene is in line: no gravity, a wall, a light ball before it, and a heavy one that comes in.


def run(M, duration=6.0):
    scene = carom.Scene(gravity=(0, 0, 0))
    wall = scene.add_half_space(point=(0, 0, 0), normal=(1, 0, 0), name="wall")
    light = scene.add_body(carom.Sphere(0.05), mass=m, position=(0.5, 0, 0), name="light")
    start = dict(position=(1, 0, 0), velocity=(-1, 0, 0))
    heavy = scene.add_body(carom.Sphere(0.1), mass=M, **start, name="heavy")
    scene.add_contact(light, wall, restitution=1)
    scene.add_contact(heavy, light, restitution=1)
    # 3141 impacts come within some milliseconds: small steps, and none may be left out
    options = carom.Options(hold=False, max_impacts_per_step=10000)
    return carom.simulate(scene, duration, step=2e-4, options=options)


# %%
# Four mass ratios. The picture is of the second: where the balls are, and their velocities on the circle of
# energy.


def main(out="out/examples"):
    for k in range(4):
        s = run(100.0**k * m)
        exact = np.ceil(np.pi / np.arctan(10.0**-k)) - 1
        drift = abs(s.total_energy[-1] / s.total_energy[0] - 1)
        print(f"mass ratio {100**k:7d}: {len(s.impacts):4d} impacts, energy kept to {drift:.0e}")
        assert len(s.impacts) == exact == int(np.pi * 10**k)
        if k == 1:
            shown = s
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.8, columns=2, width_ratios=(1.3, 1))
        for body, (name, colour) in enumerate((("light", style.BLUE), ("heavy", style.RED))):
            times = np.sort(np.concatenate([shown.t, shown.impacts.time]))
            left.plot(times, shown.evaluate(times)[0][:, body, 0], color=colour, label=name)
        left.axhline(0, color="k", lw=2)
        left.set(
            xlabel="time / s", ylabel="distance from the wall / m", xlim=(0, 2.5), ylim=(0, 1.7)
        )
        left.legend(loc="upper left", title="mass ratio 100")
        after = shown.evaluate(np.concatenate([[0.0], shown.impacts.time]))[2][..., 0]
        x, y = 10 * after[:, 1], after[:, 0]
        circle = np.linspace(0, 2 * np.pi, 200)
        right.plot(10 * np.cos(circle), 10 * np.sin(circle), color=style.GREY, lw=0.6)
        right.plot(x, y, "o-", color="k", lw=0.6, ms=2)
        right.set(xlabel=r"$\sqrt{M}\,V$", ylabel=r"$\sqrt{m}\,v$", aspect="equal")
        right.text(0, 0, "31 impacts", ha="center", va="center", backgroundcolor="w")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "counting_pi.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
