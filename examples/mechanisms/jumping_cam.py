r"""A cam that jumps
=================

A roller follower with a spring runs on a cam with two lobes, whose flanks are hollow. It stays on the cam while
the force of contact

.. math:: N = m \bigl( \ddot h + g \bigr) + k h, \qquad h(\omega t) \text{ the lift},

is above 0. At a higher speed it leaves behind the nose, flies, and strikes on the flank.
"""

import math

import numpy as np

import carom
from carom.visual.plots.style import picture

g, base, depth, roller, mass, stiffness = 9.81, 0.04, 0.2, 0.012, 0.3, 150.0


def radius(angle):
    return base * (1.0 + depth * math.cos(2 * angle))


cam = carom.Profile(radius, thickness=0.01)

# %%
# The pitch curve, at the distance of the roller from the profile, gives the height of its axis by the angle of
# the cam: the reference for all that follows.


def heights(angles):
    points = cam.points(4000)
    found = []
    for angle in angles:
        x = math.cos(angle) * points[:, 0] - math.sin(angle) * points[:, 1]
        y = math.sin(angle) * points[:, 0] + math.cos(angle) * points[:, 1]
        near = np.abs(x) < roller
        found.append(np.max(y[near] + np.sqrt(roller**2 - x[near] ** 2)))
    return np.array(found)


def run(speed, turns=2.0):
    scene = carom.Scene(gravity=(0, -g, 0))
    wheel = scene.add_body(cam, mass=0.5, angular_velocity=(0, 0, speed), name="cam")
    rod = scene.add_body(
        carom.Cylinder(roller, 0.01),
        mass=mass,
        position=(0, heights([0.0])[0] + 1e-6, 0),
        name="follower",
    )
    axle = scene.add_joint(
        carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 0, 1)), carom.GROUND, wheel, name="axle"
    )
    scene.add_constraint(carom.constraints.Driver(axle, rate=speed), name="drive")
    guide = scene.add_joint(carom.joints.Prismatic(axis=(0, 1, 0)), carom.GROUND, rod, name="guide")
    scene.add_force(carom.forces.JointSpring(guide, stiffness=stiffness), name="spring")
    scene.add_contact(rod, wheel, restitution=0.0, friction=0.0, name="lift")
    end = 2 * math.pi * turns / speed
    return carom.simulate(scene, end, save_at=end / 600)


def main(out="out/examples"):
    slow, fast = run(15.0), run(28.0)
    with picture(f"{out}/jumping_cam.png", height=4.2, rows=2) as (lift, force):
        for motion, label in ((slow, "15 rad/s"), (fast, "28 rad/s")):
            turn, y = motion["axle"].coordinate / (2 * math.pi), motion["follower"].position[:, 1]
            above = y - heights(motion["axle"].coordinate)
            lift.plot(turn, 1e3 * y, label=label)
            force.plot(turn, motion["lift"].force[:, 0], label=label)
            print(f"{label}: above the cam by up to {1e3 * np.max(above):.2f} mm")
            assert np.min(above) > -2e-6  # the polygon of the reference
        lift.plot(
            turn, np.where(above > 1e-6, 1e3 * y, np.nan), color="black", lw=2.5, label="in flight"
        )
        lift.set(ylabel="height of the roller / mm"), lift.legend()
        force.set(xlabel="turns of the cam", ylabel="force of contact / N"), force.legend()
    work = fast.ledger.loads[-1]
    print(
        f"work of the drive {work:.3f} J, ledger open by {np.abs(fast.ledger.residual).max():.0e} J"
    )
    assert np.max(np.abs(slow["follower"].position[:, 1] - heights(slow["axle"].coordinate))) < 2e-6
    carom.film(fast, f"{out}/jumping_cam.gif", size=(360, 360), fps=15, speed=0.1)


if __name__ == "__main__":
    main()
