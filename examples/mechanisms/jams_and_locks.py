r"""Jams and locks: friction that grows with the load
==================================================

A drawer that is pulled beside its middle presses both ends of its guide. If it is pulled far enough beside it,
the friction of these ends is more than the pull, however hard that is: it jams. A nut on a thread is pressed on
its flanks by the weight that it carries. If the thread is not steep, friction holds the weight without a motor,
and more than half of the work that lifts it is lost. `JointFriction(mu=...)` is the friction of both: it
follows the reaction of its joint.
"""

import math

import numpy as np

import carom
from carom import GROUND, forces, joints
from carom.visual.plots.style import picture

MU, LENGTH, PULL, MASS = 0.3, 0.4, 50.0, 2.0
RADIUS, WEIGHT = 0.012, 2000.0  # of a screw [m], of its load [N]

# %%
# The ends of the guide, a length L apart, carry P y/L each, so friction is 2 mu y/L of the pull P.


def pulled(beside):
    """Return the acceleration of a drawer that is pulled beside its middle."""
    scene = carom.Scene(gravity=(0, 0, 0))
    drawer = scene.add_body(mass=MASS, inertia=(0.1, 0.1, 0.1), name="drawer")
    guide = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, drawer, name="guide")
    scene.add_force(forces.JointFriction(guide, mu=MU, length=LENGTH))
    scene.add_force(forces.Force((PULL, 0, 0), anchor=(0, beside, 0)), drawer)
    return 2 * carom.simulate(scene, 1.0)["guide"].coordinate[-1]


# %%
# A screw jack turns evenly under the moment that weight and friction need. Without it, it holds or runs back.


def lifted(lead):
    """Return the part of the work of a moment that lifts a load, and whether friction alone holds the load."""
    found, slope = [], RADIUS * math.tan(lead)  # slope: height by angle [m]
    for moment, turns in ((WEIGHT * RADIUS * math.tan(lead + math.atan(MU)), 3.0), (0.0, 0.0)):
        scene = carom.Scene(gravity=(0, 0, -9.81))
        nut = scene.add_body(
            mass=WEIGHT / 9.81, inertia=(0.02, 0.02, 0.02), velocity=(0, 0, slope * turns),
            angular_velocity=(0, 0, turns), name="nut",
        )  # fmt: skip
        screw = joints.Screw((0, 0, 0), (0, 0, 1), 2 * math.pi * slope)
        thread = scene.add_joint(screw, GROUND, nut, name="thread")
        scene.add_force(forces.JointFriction(thread, mu=MU, radius=RADIUS))
        scene.add_force(forces.Torque((0, 0, moment)), nut)
        found.append(carom.simulate(scene, 0.2))
    lifts, alone = found
    work = lifts.ledger.loads[-1]
    return WEIGHT * lifts.position[-1, 0, 2] / work, bool(np.all(alone.position == 0.0))


def main(out="out/examples"):
    far = np.linspace(0, 1, 21)
    drawer = np.array([pulled(y) for y in far])
    limit = LENGTH / (2 * MU)
    print(
        f"the drawer moves up to {far[drawer > 0].max():.2f} m beside its middle: L/2 mu = {limit:.3f} m"
    )
    leads = np.radians(np.linspace(2, 44, 15))
    share, holds = map(np.array, zip(*map(lifted, leads)))
    steepest = np.degrees(leads[holds].max())
    print(
        f"the screw holds by itself up to {steepest:.0f} degrees: atan mu = {np.degrees(math.atan(MU)):.1f}"
    )
    with picture(f"{out}/jams_and_locks.png", columns=2) as (left, right):
        left.plot(far, np.maximum(0, 1 - 2 * MU * far / LENGTH) * PULL / MASS, lw=0.9)
        left.plot(far, drawer, "o", ms=3.5)
        left.set(
            xlabel="pulled beside the middle / m", ylabel="acceleration of the drawer / (m/s²)"
        )
        angle = np.radians(np.linspace(1, 45, 200))
        right.plot(np.degrees(angle), np.tan(angle) / np.tan(angle + math.atan(MU)), lw=0.9)
        right.plot(np.degrees(leads[holds]), share[holds], "s", ms=3.5, label="holds by itself")
        right.plot(np.degrees(leads[~holds]), share[~holds], "o", ms=3.5, label="runs back")
        right.set(xlabel="lead / degrees", ylabel="part of the work that lifts")
        right.legend()
    np.testing.assert_allclose(
        drawer, np.maximum(0, 1 - 2 * MU * far / LENGTH) * PULL / MASS, atol=1e-9
    )
    np.testing.assert_allclose(share, np.tan(leads) / np.tan(leads + math.atan(MU)), rtol=1e-6)
    assert np.array_equal(holds, np.tan(leads) < MU)


if __name__ == "__main__":
    main()
