r"""A ball in a bowl
================

A ball rolls in a bowl, started sideways: its path seen from above is a rosette. It does not close, because the
period of the swing depends on its amplitude.
"""

import numpy as np
from scipy.integrate import solve_ivp

import carom
from carom.visual.plots.style import picture

g, bowl, radius, start, speed, duration = 9.81, 0.3, 0.02, 0.9, 0.5, 12.0
length = bowl - radius  # the centre of the ball is on a sphere of this radius

# %%
# The bowl is the inside of a sphere, with its centre at the height of its radius. The ball starts in rolling,
# at an angle of 0.9 from the bottom, without spin about the normal.


def in_the_bowl():
    scene = carom.Scene(gravity=(0, 0, -g))
    inside = scene.add_surface(
        carom.surfaces.InsideSphere(bowl), position=(0, 0, bowl), name="bowl"
    )
    normal = np.array([-np.sin(start), 0, np.cos(start)])
    ball = scene.add_body(
        carom.Sphere(radius), mass=0.1, position=np.array([0, 0, bowl]) - length * normal,
        velocity=(0, speed, 0), angular_velocity=np.cross(normal, [0, speed, 0]) / radius, name="ball",
    )  # fmt: skip
    scene.add_contact(ball, inside, friction=2.0, restitution=0.0)
    return scene


# %%
# A ball that rolls has 7/5 of the inertia of a point that slides, so its centre moves as a spherical pendulum
# with 5/7 of gravity. With the position x of the centre from that of the sphere,
#
# .. math:: \ddot x = -\tfrac57 g\,e_z + \lambda x, \quad
#    \lambda\,l^2 = \tfrac57 g\,x_z - \dot x \cdot \dot x.


def pendulum(t, y):
    x, v = y[:3], y[3:]
    pull = (5 / 7 * g * x[2] - v @ v) / length**2
    return [*v, pull * x[0], pull * x[1], pull * x[2] - 5 / 7 * g]


def main(out="out/examples"):
    solution = carom.simulate(in_the_bowl(), duration, rtol=1e-9, atol=1e-9, save_at=0.005)
    x = solution["ball"].position - [0, 0, bowl]
    first = [*x[0], 0, speed, 0]
    exact = solve_ivp(pendulum, (0, duration), first, rtol=1e-11, atol=1e-12).y[:3, -1]
    error = np.linalg.norm(x[-1] - exact)
    print(f"after {duration:g} s within {error:.0e} m of the pendulum")

    with picture(f"{out}/ball_in_a_bowl.png", height=4) as axes:
        axes.plot(1e3 * x[:, 0], 1e3 * x[:, 1])
        axes.set(xlabel="x / mm", ylabel="y / mm", aspect="equal")
    assert error < 1e-6
    return solution


if __name__ == "__main__":
    main()
