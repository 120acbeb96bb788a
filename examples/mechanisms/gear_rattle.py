r"""Gears that rattle
=================

A wheel is driven back and forth; a second one has its teeth between those of the first, with play. It flies
freely until a tooth strikes, rebounds, and rattles: the noise of a gearbox that idles. The times of the impacts
are compared with flights between the teeth, each found by a root finder.
"""

import numpy as np
from scipy.optimize import brentq

import carom
from carom.visual.plots.style import picture

w, swing, PLAY, e = 2 * np.pi, 0.3, 0.05, 0.6

# %%
# `add_play` limits a sum of joint coordinates: here the difference of both angles.


def driven(t):
    c, s = np.cos(w * t), np.sin(w * t)
    return swing * (1 - c), swing * w * s, swing * w**2 * c


def gears():
    scene = carom.Scene(gravity=(0, 0, 0))
    for k, name in enumerate(("driver", "driven")):
        place = (0.2 * k, 0, 0)
        wheel = scene.add_body(carom.Cylinder(0.1, 0.02), density=7800, position=place, name=name)
        scene.add_joint(
            carom.joints.Revolute(place, (0, 0, 1)), carom.GROUND, wheel, name=f"axle {k}"
        )
    scene.add_constraint(carom.constraints.Driver("axle 0", motion=driven))
    scene.add_play({"axle 0": 1.0, "axle 1": -1.0}, -PLAY, PLAY, restitution=e, name="teeth")
    return scene


# %%
# Between impacts the second wheel turns evenly. The motor does not yield, so an impact changes the rate u of
# the wheel relative to the teeth to -e u.


def gap(t, side, begin, angle, rate):
    return PLAY - side * (driven(t)[0] - angle - rate * (t - begin))


def flights(count):
    times, flight = [], (0.0, 0.0, 0.0)  # begin, angle and rate
    while len(times) < count:
        found, grid = [], flight[0] + 1e-9 + np.linspace(0, 1, 4001)
        for side in (1, -1):
            below = np.flatnonzero(gap(grid, side, *flight) < 0)
            if len(below):
                k = below[0]
                ends = grid[max(k - 1, 0)], grid[k]
                found.append(brentq(gap, *ends, args=(side, *flight), xtol=1e-15))
        t, (begin, angle, rate) = min(found), flight
        teeth = driven(t)[1]
        flight = t, angle + rate * (t - begin), teeth - e * (rate - teeth)
        times.append(t)
    return np.array(times)


def main(out="out/examples"):
    s = carom.simulate(gears(), 4.0, rtol=1e-10, save_at=np.linspace(0, 4, 2001))
    error = np.max(np.abs(s.impacts.time[:12] - flights(12)))
    closed = np.max(np.abs(s.ledger.residual))
    print(f"{len(s.impacts)} impacts; times to {error:.0e} s, ledger to {closed:.0e} J")
    first, second = (s[f"axle {k}"].coordinate for k in range(2))
    with picture(f"{out}/gear_rattle.png", height=4.2, rows=2, sharex=True) as (angles, play):
        angles.fill_between(s.t, first - PLAY, first + PLAY, color="0.85", label="between teeth")
        angles.plot(s.t, second, label="driven wheel")
        angles.set(ylabel="angle / rad")
        angles.legend(loc="upper left")
        play.plot(s.t, second - first)
        side = np.where(s.impacts.contact == 0, PLAY, -PLAY)
        play.plot(s.impacts.time, side, ".", color="C3", label="impact")
        play.set(xlabel="time / s", ylabel="angle between teeth / rad")
        play.legend(loc="upper left")
    assert error < 1e-8
    assert closed < 1e-9


if __name__ == "__main__":
    main()
