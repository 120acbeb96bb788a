r"""A trebuchet: when to let go
===========================

A counterweight turns a beam, whose tip swings a stone on a sling. The stone slides over the ground, takes off,
and is let go when it flies in a certain direction: the switch takes the sling out of the motion. From there on
the stone is a free body, and its range follows from the place and the velocity at which it was let go.
"""

import math

import numpy as np

import carom
from carom import GROUND, joints
from carom.visual.plots.style import picture

HEIGHT, LONG, SHORT, SLING = 1.6, 3.0, 0.8, 2.6  # [m]
START = math.asin(HEIGHT / LONG)  # the tip of the beam is on the ground
G = 9.81


def trebuchet(angle=None):
    """Return the scene; the stone is let go when it flies at this angle above the level [rad]."""
    scene = carom.Scene(gravity=(0, 0, -G))
    along = np.array([math.cos(START), 0, math.sin(START)])  # from the tip to the weight
    pivot = np.array([0, 0, HEIGHT])
    turn = (math.cos(START / 2), 0, -math.sin(START / 2), 0)
    beam, middle = carom.Box(LONG + SHORT, 0.1, 0.1), pivot - 0.5 * (LONG - SHORT) * along
    scene.add_body(beam, mass=8.0, position=middle, orientation=turn, name="beam")
    scene.add_joint(joints.Revolute(pivot, axis=(0, 1, 0)), GROUND, "beam", name="pivot")
    end, tip = pivot + SHORT * along, pivot - LONG * along
    hangs = end - (0, 0, 0.5)
    scene.add_body(carom.Box(0.4, 0.4, 0.4), mass=150.0, position=hangs, name="weight")
    scene.add_joint(joints.Revolute(end, axis=(0, 1, 0)), "beam", "weight")
    stone = tip + (SLING, 0, 0.06)
    scene.add_body(carom.Sphere(0.06), mass=2.0, position=stone, name="stone")
    scene.add_joint(joints.Distance(tip, stone), "beam", "stone", name="sling")
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    scene.add_contact("stone", "ground", friction=0.2)
    if angle is not None:
        scene.switch("sling", at=lambda t, state: flies(state, angle))
    return scene


def flies(state, angle):
    """Return the velocity of the stone across this direction: it swings back, up, and then forwards."""
    vx, _, vz = state["stone"].velocity
    return vz * math.cos(angle) - vx * math.sin(angle)


def main(out="out/examples"):
    shots, ranges = np.radians(np.arange(65, 10, -5)), []
    with picture(f"{out}/trebuchet.png", columns=2) as (left, right):
        for angle in shots:
            landing = "first impact of stone and ground"
            solution = carom.simulate(trebuchet(angle), 8.0, events=landing)
            stone, (t,) = solution["stone"].position, solution.switches.time
            ranges.append(stone[-1, 0])
            x, _, v, _ = (one[2] for one in solution.evaluate(t))
            if round(math.degrees(angle)) % 10 == 5:
                left.plot(*stone[:, ::2].T, lw=0.9, label=f"{math.degrees(angle):.0f}°")
            # from there on a parabola: z + vz s - g s^2/2 = r
            z, vx, vz = x[2], v[0], v[2]
            flight = (vz + math.sqrt(vz**2 + 2 * G * (z - 0.06))) / G
            np.testing.assert_allclose(stone[-1, 0], x[0] + vx * flight, rtol=1e-9)
        left.set(xlabel="x / m", ylabel="height / m", aspect="equal", ylim=(-2, 92))
        left.legend(ncols=2, loc="upper right")
        right.plot(np.degrees(shots), ranges, "o-", ms=3.5, lw=0.9)
        right.set(xlabel="let go at / degrees", ylabel="range / m")
    best = int(np.argmax(ranges))
    print(f"farthest, {ranges[best]:.1f} m, at {math.degrees(shots[best]):.0f} degrees")


if __name__ == "__main__":
    main()
