r"""Jams and locks: friction that grows with the load
==================================================

A drawer that is pulled beside its middle presses both ends of its guide. If it is pulled far enough beside it,
friction there is more than the pull, however hard that is: it jams. The flanks of a thread carry the weight on
its nut. If the thread is not steep, friction holds the weight without a motor, and more than half of the work
that lifts it is lost. `JointFriction(mu=...)` follows the reaction of its joint.
"""

import math

import numpy as np

import carom
from carom import GROUND, forces, joints
from carom.visual.plots.style import picture

MU, LENGTH, PULL, MASS = 0.3, 0.4, 50.0, 2.0
RADIUS, WEIGHT = 0.012, 2000.0  # of a screw [m], of its load [N]


def part(mass, friction, joint, **motion):
    """Return a scene with one body on one joint."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_body(mass=mass, inertia=(0.02, 0.02, 0.02), name="part", **motion)
    scene.add_joint(joint, GROUND, "part", name="joint")
    scene.add_force(forces.JointFriction("joint", mu=MU, **friction))
    return scene


# %%
# The ends of the guide, a length L apart, carry P y/L each, so friction is 2 mu y/L of the pull P. (The guide
# stands upright, and the pull is beside its weight.)


def pulled(beside):
    """Return the acceleration of a drawer that is pulled beside its middle."""
    scene = part(MASS, {"length": LENGTH}, joints.Prismatic((0, 0, 1)))
    scene.add_force(forces.Force((0, 0, PULL), anchor=(0, beside, 0)), "part")
    scene.add_force(forces.Force((0, 0, 9.81 * MASS)), "part")
    return 2 * carom.simulate(scene, 1.0)["joint"].coordinate[-1]


# %%
# A jack turns evenly under the moment that weight and friction need. Without it, it holds or runs back.


def lifted(lead):
    """Return the part of the work of a moment that lifts a load, and whether friction alone holds the load."""
    slope, friction, found = RADIUS * math.tan(lead), {"radius": RADIUS}, []
    for moment, turns in ((WEIGHT * RADIUS * math.tan(lead + math.atan(MU)), 3.0), (0.0, 0.0)):
        motion = {"velocity": (0, 0, slope * turns), "angular_velocity": (0, 0, turns)}
        screw = joints.Screw((0, 0, 0), (0, 0, 1), 2 * math.pi * slope)
        scene = part(WEIGHT / 9.81, friction, screw, **motion)
        scene.add_force(forces.Torque((0, 0, moment)), "part")
        found.append(carom.simulate(scene, 0.2))
    lifts, alone = found
    share = WEIGHT * lifts.position[-1, 0, 2] / lifts.ledger.loads[-1]
    return share, bool(np.all(alone.position == 0.0))


def main(out="out/examples"):
    far, leads = np.linspace(0, 1, 21), np.radians(np.linspace(2, 44, 15))
    drawer, free = np.array(list(map(pulled, far))), 1 - 2 * MU * far / LENGTH
    share, holds = map(np.array, zip(*map(lifted, leads)))
    print(f"the drawer jams beyond {far[drawer > 0].max():.2f} m: {LENGTH / (2 * MU):.3f} m")
    print(
        f"the screw holds up to {np.degrees(leads[holds].max()):.0f} degrees: {np.degrees(math.atan(MU)):.1f}"
    )
    angle = np.radians(np.linspace(1, 45, 200))
    with picture(f"{out}/jams_and_locks.png", columns=2) as (left, right):
        left.plot(far, np.maximum(0, free) * PULL / MASS, lw=0.9)
        left.plot(far, drawer, "o", ms=3.5)
        left.set(
            xlabel="pulled beside the middle / m", ylabel="acceleration of the drawer / (m/s²)"
        )
        right.plot(np.degrees(angle), np.tan(angle) / np.tan(angle + math.atan(MU)), lw=0.9)
        right.plot(np.degrees(leads[holds]), share[holds], "s", ms=3.5, label="holds by itself")
        right.plot(np.degrees(leads[~holds]), share[~holds], "o", ms=3.5, label="runs back")
        right.set(xlabel="lead / degrees", ylabel="part of the work that lifts")
        right.legend()
    np.testing.assert_allclose(drawer, np.maximum(0, free) * PULL / MASS, atol=1e-9)
    np.testing.assert_allclose(share, np.tan(leads) / np.tan(leads + math.atan(MU)), rtol=1e-6)
    assert np.array_equal(holds, np.tan(leads) < MU)


if __name__ == "__main__":
    main()
