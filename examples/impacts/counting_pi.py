r"""Two balls and a wall count the digits of pi
===========================================

A heavy ball pushes a light one against a wall, and all impacts are elastic. With a mass ratio of
:math:`100^k` the number of impacts is 3, 31, 314, 3141: the first digits of :math:`\pi` (Galperin, 2003). The
run counts them.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

m = 1.0

# %%
# All motion is along one line. There is a wall, a light ball at rest before it, and a heavy ball that comes
# in. The last impacts follow each other within some milliseconds, so the run has small steps, and no impact
# may be left out.


def run(M, duration=6.0):
    scene = carom.Scene(gravity=(0, 0, 0))
    wall = scene.add_half_space(point=(0, 0, 0), normal=(1, 0, 0), name="wall")
    light = scene.add_body(carom.Sphere(0.05), mass=m, position=(0.5, 0, 0), name="light")
    start = dict(position=(1, 0, 0), velocity=(-1, 0, 0))
    heavy = scene.add_body(carom.Sphere(0.1), mass=M, **start, name="heavy")
    scene.add_contact(light, wall, restitution=1)
    scene.add_contact(heavy, light, restitution=1)
    options = carom.Options(hold=False, max_impacts_per_step=10000)
    return carom.simulate(scene, duration, step=2e-4, options=options)


# %%
# Why :math:`\pi`? The energy is constant, so the point :math:`(\sqrt{M} V, \sqrt{m} v)` stays on a circle.
# Each pair of impacts turns it by the same angle, :math:`2 \arctan \sqrt{m/M}`. After half a turn the balls
# separate.


def draw(s, left, right):
    times = np.sort(np.concatenate([s.t, s.impacts.time]))
    left.plot(times, s.evaluate(times)[0][:, :, 0], label=["light", "heavy"])
    left.set(xlabel="time / s", ylabel="distance from the wall / m", xlim=(0, 2.5), ylim=(0, 1.7))
    left.legend(loc="upper left", title="mass ratio 100")
    v = s.evaluate(np.append(0.0, s.impacts.time))[2][..., 0]  # after each impact
    right.plot(10 * v[:, 1], v[:, 0], "ko-", lw=0.6, ms=3)
    right.set(xlabel=r"$\sqrt{M}\,V$", ylabel=r"$\sqrt{m}\,v$", aspect="equal")


# %%
# Four mass ratios. The picture is that of the second one: the places of both balls on the left, and on the
# right their velocities on the circle.


def main(out="out/examples"):
    with picture(f"{out}/counting_pi.png", height=2.8, columns=2) as axes:
        for k in range(4):
            s = run(100.0**k * m)
            exact = np.ceil(np.pi / np.arctan(10.0**-k)) - 1
            drift = abs(s.total_energy[-1] / s.total_energy[0] - 1)
            print(
                f"mass ratio {100**k:7d}: {len(s.impacts):4d} impacts, energy kept to {drift:.0e}"
            )
            assert len(s.impacts) == exact == int(np.pi * 10**k)
            if k == 1:
                draw(s, *axes)


if __name__ == "__main__":
    main()
