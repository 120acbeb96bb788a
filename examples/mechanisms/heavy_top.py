r"""A gyroscope nods while it precesses
===================================

A fast gyroscope whose axle is released level does not fall. It turns about the vertical, and its axle nods up
and down. Time and angle of one nod are compared with integrals of its closed form.
"""

import numpy as np
from scipy.integrate import quad

import carom
from carom.visual.plots.style import picture

g, m, arm, spin, C = 9.81, 1.0, 0.1, 180.0, 2e-3
A = C + m * arm**2  # moment about the foot, across the axle
b, beta = C * spin / A, 2 * m * g * arm / A

# %%
# The wheel sits on an axle along x, and a spherical joint connects the end of the axle to the ground. The
# angular velocity w about the vertical at the start is chosen below. Wheel and axle are only there to be
# seen: nothing touches them, and the inertia is given.

turn = carom.axis_angle((0, 1, 0), 90)
wheel = (
    (carom.Cylinder(0.05, 0.015), (0, 0, 0), turn),
    (carom.Cylinder(0.004, arm), (-arm / 2, 0, 0), turn),
)


def top(w):
    scene = carom.Scene(gravity=(0, 0, -g))
    body = scene.add_body(
        carom.Compound(wheel, centroid=(0, 0, 0)), mass=m, inertia=(C, C, C), name="top",
        position=(arm, 0, 0), velocity=(0, w * arm, 0), angular_velocity=(spin, 0, w),
    )  # fmt: skip
    scene.add_joint(carom.joints.Spherical((0, 0, 0)), carom.GROUND, body)
    return carom.simulate(scene, 1.0, step=1e-3, method="rk8")


# %%
# Energy and two angular momenta are constant. They give an equation for the height u of the axle,
#
# .. math:: \dot u^2 = (1 - u^2)(w^2 - \beta u) - (w - b u)^2,
#
# with :math:`b = C n / A` and :math:`\beta = 2 m g a / A` for the spin n and the arm a. Time and angle of a
# nod are integrals between its zeros.


def nod(w):
    p, q = w**2 + b**2, 2 * w * b - beta  # u'^2 = u (beta u^2 - p u + q)
    root = np.sqrt(p**2 - 4 * beta * q)
    low, high = (p - root) / (2 * beta), (p + root) / (2 * beta)

    def over(s, angle):  # u = low sin^2 s
        u = low * np.sin(s) ** 2
        return 4 * ((w - b * u) / (1 - u**2) if angle else 1.0) / np.sqrt(beta * (high - u))

    return [quad(over, 0, np.pi / 2, args=(angle,))[0] for angle in (False, True)]


# %%
# The axle starts with a push against the precession, with a push along it, or without a push: its path has
# loops, waves, or cusps. Black dots are the closed form. The film shows the last one.


def main(out="out/examples"):
    with picture(f"{out}/heavy_top.png", height=3.0, rows=3, sharex=True, sharey=True) as rows:
        for axes, (w, name) in zip(rows, ((-3, "against"), (1.5, "along"), (0, "no push"))):
            s, (time, angle) = top(w), nod(w)
            (x, y, z), at = s.position[:, 0].T / arm, s.evaluate(time)[0][0] / arm
            error = max(abs(at[2]), abs(np.arctan2(at[1], at[0]) - angle))
            print(
                f"{name}: nod of {time:.6f} s, {np.degrees(angle):.3f} degrees, error {error:.0e}"
            )
            axes.plot(np.degrees(np.unwrap(np.arctan2(y, x))), np.degrees(np.arcsin(z)))
            axes.plot(np.degrees(angle), 0, "ko")
            axes.set_title(name, loc="left", pad=2)
            assert error < 1e-8
        rows[2].set(xlabel="precession / degrees", xlim=(-6, 130), ylim=(-24, 3))
        rows[1].set(ylabel="height of the axle / degrees")
    carom.film(s, f"{out}/heavy_top.gif", size=(320, 320), fps=15, speed=0.3)


if __name__ == "__main__":
    main()
