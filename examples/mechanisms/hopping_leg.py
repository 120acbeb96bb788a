r"""A hopping leg: a push from the lowest point on
===============================================

A body on a leg with a spring, which a stop keeps from getting longer, and a foot that lands without bouncing. A
constant push along the leg is switched on where the body is lowest, and off where it is highest. What landing
and taking off lose it puts back, so that from any height the leg comes to the same hop.
"""

import numpy as np

import carom
from carom import GROUND, forces, joints
from carom.visual.plots.style import picture

G, BODY, FOOT, STIFFNESS, PUSH, LEG = 9.81, 8.0, 1.0, 4000.0, 60.0, 0.6

# %%
# With the velocity :math:`v` at landing, where the foot stops, the spring is compressed by :math:`\delta`, with
# :math:`k \delta^2/2 - M g \delta = M v^2/2`. The push adds :math:`F \delta`; at the stop of the leg the body
# takes the foot along, and keeps :math:`M/(M + m)` of its velocity.


def landings(v, count):
    """Return the velocities at this landing and at the next ones."""
    found = [v]
    for _ in range(count - 1):
        root = np.sqrt((BODY * G) ** 2 + STIFFNESS * BODY * found[-1] ** 2)
        energy = found[-1] ** 2 + 2 * PUSH * (BODY * G + root) / (STIFFNESS * BODY)
        found.append(BODY / (BODY + FOOT) * np.sqrt(energy))
    return np.array(found)


share = (BODY / (BODY + FOOT)) ** 2  # delta of the hop that repeats itself
depth = 2 * (BODY * G + share * PUSH / (1 - share)) / STIFFNESS
HOP = np.sqrt((STIFFNESS * depth**2 - 2 * BODY * G * depth) / BODY)

# %%
# A function acts as a switch at each of its zeros, of those with a `direction` where it rises, or falls.


def lowest(t, state):
    return state["body"].velocity[2]


def highest(t, state):
    return state["body"].velocity[2]


lowest.direction, highest.direction = 1, -1


def leg(height):
    """Return the scene; the foot is at a height above the ground."""
    scene = carom.Scene(gravity=(0, 0, -G))
    body, foot = carom.Box(0.3, 0.2, 0.2), carom.Sphere(0.05)
    low, high = (0, 0, height + 0.05), (0, 0, height + 0.05 + LEG)
    scene.add_body(body, mass=BODY, position=high, name="body")
    scene.add_body(foot, mass=FOOT, position=low, name="foot")
    scene.add_joint(joints.Prismatic((0, 0, 1)), GROUND, "body", name="guide")
    scene.add_joint(joints.Prismatic((0, 0, -1)), "body", "foot", name="leg")
    scene.add_stop("leg", upper=0.0)
    scene.add_force(forces.Spring(STIFFNESS, high, low), "body", "foot")
    scene.add_force(forces.JointForce("leg", PUSH), name="push")
    scene.switch("push", at=lowest, off=False)
    scene.switch("push", at=highest)
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    scene.add_contact("foot", "ground", restitution=0.0)
    return scene


def main(out="out/examples"):
    limit = HOP**2 / (2 * G)
    with picture(f"{out}/hopping_leg.png", columns=2) as (left, right):
        for height in (0.05, limit, 0.8):
            s = carom.simulate(leg(height), 9.0, save_at=np.linspace(0, 9, 721))
            v = -s["foot-ground"].impacts.relative_velocity_before[:, 0]
            error = np.max(np.abs(v - landings(np.sqrt(2 * G * height), len(v))))
            print(f"from {height:.3f} m, {len(v)} hops: {v[-1]:.4f} m/s, error {error:.0e}")
            assert error < 1e-6
            left.plot(s.t, s["foot"].position[:, 2] - 0.05, lw=0.9)
            right.plot(v, "o-", ms=3, lw=0.9)
        left.set(xlabel="time / s", ylabel="height of the foot / m", xlim=(0, 4))
        right.axhline(HOP, color="k", lw=0.6, ls="--")
        right.set(xlabel="landing", ylabel="velocity / (m/s)")
    carom.film(s, f"{out}/hopping_leg.gif", size=(240, 400), fps=12, view="front")


if __name__ == "__main__":
    main()
