r"""A planetary gear
================

A sun drives three planets on a carrier inside a ring that does not turn. The gears are six relations between
angles. Two of them are redundant, because one planet alone would fix the ratio. The ratio of the gear and its
acceleration under a torque are compared with their closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

z_s, z_p, z_r = 20, 16, 52  # teeth
module, m, torque = 2e-3, 0.05, 5e-3  # radius = module z / 2
a, ratio = module * (z_s + z_p) / 2, 1 + z_r / z_s
I_s, I_c, I_p, up = 2e-5, 3e-4, 6e-6, (0, 0, 1)

# %%
# Sun and carrier turn in bearings, and each planet turns on a pin of the carrier. A `Coupling` is a relation
# between the angles of joints, with the numbers of teeth as factors: sun with planet, and ring with planet.


def gear():
    scene, bearing = carom.Scene(gravity=(0, 0, 0)), carom.joints.Revolute((0, 0, 0), up)
    sun = scene.add_body(carom.Cylinder(module * z_s / 2, 0.01), mass=0.1, inertia=3 * [I_s])
    carrier = scene.add_body(mass=0.1, inertia=3 * [I_c])
    shaft, output = (scene.add_joint(bearing, carom.GROUND, body) for body in (sun, carrier))
    wheel = carom.Cylinder(module * z_p / 2, 0.01)
    for k in range(3):
        place = a * np.array([np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3), 0])
        planet = scene.add_body(wheel, mass=m, inertia=3 * [I_p], position=place)
        pin = scene.add_joint(carom.joints.Revolute(place, up), carrier, planet)
        scene.add_constraint(carom.constraints.Coupling({shaft: z_s, output: -z_s, pin: z_p}))
        scene.add_constraint(carom.constraints.Coupling({output: z_r, pin: z_p}))
    scene.add_force(carom.forces.JointForce(shaft, torque))
    return scene, shaft, output


# %%
# The sun turns :math:`1 + z_r/z_s` times as fast as the carrier (Willis, 1841). Under the torque :math:`\tau`
# the gear has the inertia
#
# .. math:: J = I_s + \left( I_c + 3 m a^2 + 3 I_p (1 - z_r/z_p)^2 \right) / (1 + z_r/z_s)^2 ,
#
# so the angle of the sun is :math:`\tau t^2 / 2 J`.

J = I_s + (I_c + 3 * m * a**2 + 3 * I_p * (1 - z_r / z_p) ** 2) / ratio**2

# %%
# The check of the scene counts the redundant constraints. Both angles are those of joints, so they count full
# turns.


def main(out="out/examples"):
    scene, shaft, output = gear()
    print(scene.check())
    s = carom.simulate(scene, 0.5, step=1e-3)
    sun, carrier = (s.joint_coordinates(joint)[0][:, 0] for joint in (shaft, output))
    exact = torque * s.t**2 / (2 * J)
    error, slip = (np.max(np.abs(sun - other)) for other in (exact, ratio * carrier))
    print(f"sun: {sun[-1]:.6f} rad, error {error:.0e}; ratio {ratio:g} kept to {slip:.0e} rad")
    with picture(f"{out}/planetary_gear.png", columns=2) as (left, right):
        left.imshow(carom.films.still(s, 0.3, size=(600, 500), view=(-80, 50), clock=False))
        left.axis("off")
        right.plot(s.t, sun / (2 * np.pi), label="sun")
        right.plot(s.t, carrier / (2 * np.pi), label="carrier")
        right.plot(s.t[::50], exact[::50] / (2 * np.pi), "k.", label="closed form")
        right.set(xlabel="time / s", ylabel="turns"), right.legend()
    assert max(error, slip) < 1e-8


if __name__ == "__main__":
    main()
