r"""A super ball comes back from under a table
==========================================

A ball that is thrown under a table strikes the floor, the underside of the table, and the floor again. A super
ball then comes back to the hand; a ball that leaves each impact without slip goes on. Velocity and spin after
each impact are compared with their closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

radius, height, hand = 0.03, 0.7, (0.0, 0.0, 0.5)

# %%
# Floor and table are two half-spaces. The coefficient of tangential restitution is 1 for a super ball, whose
# material stores the energy that friction takes and returns it: the slip before an impact is reversed. With 0,
# an impact ends without slip.


def throw(tangential):
    scene = carom.Scene()
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    table = scene.add_half_space(point=(0, 0, height), normal=(0, 0, -1), name="table")
    ball = scene.add_body(
        carom.Sphere(radius), mass=0.05, position=hand, velocity=(4, 0, -5), name="ball"
    )
    for plane in (floor, table):
        scene.add_contact(ball, plane, restitution=1, friction=3, tangential_restitution=tangential)
    return carom.simulate(scene, 0.7)


# %%
# The angular momentum about the point of contact is kept, and the slip :math:`v \mp r\omega` is multiplied by
# :math:`-e_t` (Garwin 1969). From the floor this is
#
# .. math:: v' = \frac{(5 - 2 e_t) v + 2 (1 + e_t) r \omega}{7}, \quad
#           r \omega' = \frac{5 (1 + e_t) v + (2 - 5 e_t) r \omega}{7},
#
# and from the table the same with :math:`-\omega`.


def bounced(v, rw, e, side):
    rw *= side
    after = (5 - 2 * e) * v + 2 * (1 + e) * rw, 5 * (1 + e) * v + (2 - 5 * e) * rw
    return after[0] / 7, side * after[1] / 7


def main(out="out/examples"):
    with picture(f"{out}/super_ball.png") as axes:
        for tangential, name in ((1, "super ball"), (0, "no slip after an impact")):
            s = throw(tangential)
            v, rw = 4.0, 0.0
            for k, hit in enumerate(s.impacts[:3]):
                v, rw = bounced(v, rw, tangential, 1 - 2 * (k % 2))
                _, _, velocity, spin = s.evaluate(hit.time)
                found = velocity[0, 0], radius * spin[0, 1]
                assert np.allclose(found, (v, rw), rtol=0, atol=1e-9)
            print(f"{name}: {v:+.4f} m/s after three impacts, energy {s.kinetic_energy[-1]:.4f} J")
            axes.plot(s.position[:, 0, 0], s.position[:, 0, 2], label=name)
        axes.axhline(0, color="0.6"), axes.axhline(height, color="0.6"), axes.plot(*hand[::2], "ko")
        (
            axes.set(xlabel="x / m", ylabel="height / m", ylim=(-0.05, 0.9)),
            axes.legend(loc="upper right"),
        )


if __name__ == "__main__":
    main()
