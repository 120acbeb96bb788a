r"""A bead slides off a sphere
==========================

Without friction it leaves the sphere where :math:`\cos\theta = 2/3`, 48.19 degrees from the top, wherever
gravity and whatever the radius: a body that slides on another one, and the contact opens where its force has
come down to zero, :math:`N = m g (3 \cos\theta - 2)`, all for a start at rest near the top.
"""

from pathlib import Path

import numpy as np
from matplotlib.patches import Circle

import carom
from carom.visual.plots import style

g, R, r, m, theta_0 = 9.81, 1.0, 0.05, 0.1, 0.05


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, -g))
    dome = scene.add_body(carom.Sphere(R), mass=1.0, name="dome")
    scene.add_joint(carom.joints.Fixed(), carom.GROUND, dome)
    place = (R + r) * np.array([np.sin(theta_0), 0, np.cos(theta_0)])
    bead = scene.add_body(carom.Sphere(r), mass=m, position=place, name="bead")
    scene.add_contact(bead, dome, restitution=0.0)
    s = carom.simulate(scene, 1.45, step=1e-3)

    opened = s.events.time[s.events.kind == "opens"][0]
    at = s.evaluate(opened)[0][1]
    cosine = at[2] / np.linalg.norm(at)
    exact = 2 / 3 * np.cos(theta_0)  # from rest at theta_0, not quite the top
    x = s.position[:, 1]
    held = s.t < opened
    theta = np.arctan2(x[:, 0], x[:, 2])
    force = m * g * (3 * np.cos(theta) - 2 * np.cos(theta_0))
    error = np.max(np.abs(s.contact_force[held, 0, 0] - force[held]))
    print(f"leaves at cos theta = {cosine:.8f}, exact {exact:.8f}; force within {error:.0e} N")

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.6, columns=2, width_ratios=(1, 1.4))
        left.add_patch(Circle((0, 0), R, fc="0.92", ec="0.5"))
        left.plot(*x[held][:, [0, 2]].T, color=style.BLUE)
        left.plot(*x[~held][:, [0, 2]].T, color=style.RED)
        for t in np.linspace(0.6, 1.4, 6):
            left.add_patch(Circle(s.evaluate(t)[0][1, [0, 2]], r, fc="w", ec="k", lw=0.6))
        left.set(xlim=(-0.1, 1.6), ylim=(0, 1.25), aspect="equal", xlabel="x / m", ylabel="z / m")
        right.plot(np.degrees(theta[held]), s.contact_force[held, 0, 0], color=style.BLUE)
        angles = np.radians(np.linspace(3, 47, 12))
        right.plot(np.degrees(angles), m * g * (3 * np.cos(angles) - 2 * np.cos(theta_0)), "k.")
        right.axhline(0, color=style.GREY, lw=0.8)
        right.set(xlabel="angle from the top / degrees", ylabel="force / N")
        right.text(5, 0.25, "line: carom\ndots: closed form")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "off_a_sphere.png", dpi=style.DPI)
    assert abs(cosine - exact) < 1e-6
    assert error < 1e-5


if __name__ == "__main__":
    main()
