r"""A bead slides off a sphere
==========================

A bead starts near the top of a smooth sphere and slides down. At about 48 degrees it leaves the sphere,
whatever the radius and whatever gravity. Place and force of the contact are compared with their closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, R, r, m, theta_0 = 9.81, 1.0, 0.05, 0.1, 0.05

# %%
# The sphere is a body that never moves, the bead slides on it without friction.


def slide():
    scene = carom.Scene(gravity=(0, 0, -g))
    dome = scene.add_static(carom.Sphere(R), name="dome")
    place = (R + r) * np.array([np.sin(theta_0), 0, np.cos(theta_0)])
    bead = scene.add_body(carom.Sphere(r), mass=m, position=place, name="bead")
    scene.add_contact(bead, dome, restitution=0.0)
    return carom.simulate(scene, 1.45, step=1e-3)


# %%
# From rest at the angle :math:`\theta_0` from the top, the force of the contact is
#
# .. math:: N = m g (3 \cos\theta - 2 \cos\theta_0).
#
# It is zero where :math:`\cos\theta = \frac{2}{3} \cos\theta_0`, and there the contact must open.


def exact(theta):
    return m * g * (3 * np.cos(theta) - 2 * np.cos(theta_0))


# %%
# We look for the event ``"opens"``, and compare the force at all times before it.


def main(out="out/examples"):
    s = slide()
    opened = s.events.time[s.events.kind == "opens"][0]
    at, x = s.evaluate(opened)[0][0], s.position[s.t < opened, 0]
    cosine, limit = at[2] / np.linalg.norm(at), 2 / 3 * np.cos(theta_0)
    theta, force = np.arctan2(x[:, 0], x[:, 2]), s.contact_force[s.t < opened, 0, 0]
    error = np.max(np.abs(force - exact(theta)))
    print(f"leaves at cos theta = {cosine:.8f}, exact {limit:.8f}; force within {error:.0e} N")

    with picture(f"{out}/off_a_sphere.png", columns=2, width_ratios=(1.1, 1)) as (left, right):
        s.plot("trajectory", outlines=np.append(np.linspace(0.6, 1.4, 6), opened), ax=left)
        right.plot(np.degrees(theta), force, label="carom")
        angles = np.radians(np.linspace(3, 47, 12))
        right.plot(np.degrees(angles), exact(angles), "k.", label="closed form")
        right.set(xlabel="angle from the top / degrees", ylabel="force / N"), right.legend()
    assert abs(cosine - limit) < 1e-6
    assert error < 1e-5


if __name__ == "__main__":
    main()
