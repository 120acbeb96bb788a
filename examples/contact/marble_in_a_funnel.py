r"""A marble in a funnel
====================

A marble goes round in a funnel. Rolling friction takes its energy, so it sinks, goes round ever faster, and
comes to rest at the bottom: the coin funnel of a museum, and a picture of gravity.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, radius, depth, width, start, speed, duration = 9.81, 0.006, 0.007, 0.04, 0.18, 0.52, 20.0

# %%
# The funnel is the surface on which a function of x, y and z is 0; it is above 0 in free space. SymPy finds its
# derivatives. Rolling friction is a length: the moment that resists rolling, over the normal force.


def funnel(x, y, z):
    return z + depth / (x**2 + y**2 + width**2) ** 0.5


def in_the_funnel():
    scene = carom.Scene(gravity=(0, 0, -g))
    surface = carom.surfaces.Surface(funnel, bounds=[(-0.22, -0.22, -0.2), (0.22, 0.22, 0.0)])
    ground = scene.add_surface(surface, color="tan", name="funnel")
    slope = depth * start / (start**2 + width**2) ** 1.5
    normal = np.array([-slope, 0.0, 1.0]) / np.hypot(slope, 1.0)
    marble = scene.add_body(
        carom.Sphere(radius), density=2500, velocity=(0, speed, 0),
        position=np.array([start, 0, -depth / np.hypot(start, width)]) + radius * normal,
        angular_velocity=np.cross(normal, [0, speed, 0]) / radius, name="marble",
    )  # fmt: skip
    scene.add_contact(marble, ground, friction=0.8, restitution=0.3, rolling_friction=1e-4)
    return scene


# %%
# The marble never slips, so what is lost is the work of the torque of rolling friction. It comes to rest where
# the slope is below rolling friction over radius.


def main(out="out/examples"):
    solution = carom.simulate(in_the_funnel(), duration, save_at=0.005)
    marble, ledger = solution["marble"], solution.ledger
    x, y, _ = marble.position.T
    rounds = np.ptp(np.unwrap(np.arctan2(y, x))) / (2 * np.pi)
    lost, left = -ledger.friction[-1], np.linalg.norm(marble.velocity[-1])
    print(
        f"{rounds:.1f} rounds, {1e3 * lost:.3f} mJ taken by rolling friction, final speed {left:.0e} m/s"
    )

    with picture(f"{out}/marble_in_a_funnel.png", height=3.4, columns=2) as (above, over_time):
        above.plot(1e3 * x, 1e3 * y)
        above.set(xlabel="x / mm", ylabel="y / mm", aspect="equal")
        over_time.plot(solution.t, 1e3 * np.hypot(x, y))
        over_time.set(xlabel="time / s", ylabel="distance from the axis / mm")
    assert np.ptp(ledger.residual) < 1e-6 * lost
    assert left < 1e-9
    return solution


if __name__ == "__main__":
    main()
