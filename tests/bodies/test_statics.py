"""What statics allows stands, exactly and for good; what it does not allow falls."""

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import Delaunay

import carom
from verified import agree, verifies

G = 9.81


@verifies("simulate", "a stack of twenty boxes: the lowest carries all", "closed form")
def test_stack_of_twenty():
    """80 points; no creep in 10 s: bitwise. The lowest carries all."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(20):
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, 0.05 + 0.1 * k))
    scene.set_contact_default(restitution=0.0, friction=0.5)
    s = carom.simulate(scene, 10.0, step=0.01, save_every=10)
    assert np.all(s.position == s.position[0])
    assert np.all(s.velocity == 0.0)
    agree(s.contact_force[-1, 0, 0], 20 * G, rtol=1e-10)


def voussoirs(count, thickness, width=0.3):
    """Return the corners of the blocks of a half-round arch of mean radius 1."""
    angle = np.linspace(0, np.pi, count + 1)
    return angle, [
        np.array(
            [
                (r * np.cos(a), y, r * np.sin(a))
                for r in (1 - thickness / 2, 1 + thickness / 2)
                for a in angle[i : i + 2]
                for y in (-width / 2, width / 2)
            ]
        )
        for i in range(count)
    ]


def centre_and_volume(corners):
    parts = corners[Delaunay(corners).simplices]
    volumes = np.abs(np.linalg.det(parts[:, 1:] - parts[:, :1])) / 6
    return volumes @ parts.mean(axis=1) / volumes.sum(), volumes.sum()


def least_friction(count, thickness):
    """Return the least mu for which forces in equilibrium exist: a linear programme, planar.

    At each end of each joint a normal force N >= 0 and a tangential one |T| <= mu N; mu by bisection.
    """
    angle, blocks = voussoirs(count, thickness)
    centres, weights = zip(*map(centre_and_volume, blocks))
    A, b = np.zeros((3 * count, 4 * (count + 1))), np.zeros(3 * count)
    b[1::3] = weights
    for j, a in enumerate(angle):
        normal, along = np.array([-np.sin(a), np.cos(a)]), np.array([np.cos(a), np.sin(a)])
        for end, r in enumerate((1 - thickness / 2, 1 + thickness / 2)):
            for d, force in enumerate((normal, along)):
                for i, sign in ((j, 1.0), (j - 1, -1.0)):
                    if 0 <= i < count:
                        f, arm = sign * force, r * along - centres[i][[0, 2]]
                        A[3 * i : 3 * i + 3, 4 * j + 2 * end + d] += (
                            *f, arm[0] * f[1] - arm[1] * f[0],
                        )  # fmt: skip
    low, high = 0.0, 3.0
    for _ in range(40):
        mu = 0.5 * (low + high)
        cone = [
            [(-mu if c == q else s if c == q + 1 else 0.0) for c in range(A.shape[1])]
            for q in range(0, A.shape[1], 2)
            for s in (1.0, -1.0)
        ]
        bounds = [(0, None), (None, None)] * (A.shape[1] // 2)
        found = linprog(
            np.zeros(A.shape[1]), A_ub=cone, b_ub=np.zeros(len(cone)), A_eq=A, b_eq=b, bounds=bounds
        )
        low, high = (low, mu) if found.status == 0 else (mu, high)
    return high


def arch(count, thickness, mu, duration, step=0.005):
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for corners in voussoirs(count, thickness)[1]:
        centre, _ = centre_and_volume(corners)
        scene.add_body(carom.Convex(corners - centre), density=2000.0, position=centre)
    scene.set_contact_default(restitution=0.0, friction=mu)
    return carom.simulate(scene, duration, step=step)


@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")  # of the first step of the fall
@pytest.mark.parametrize("thickness", [0.25, 0.15])
def test_arch_stands_at_the_friction_that_statics_allows(thickness):
    mu = least_friction(7, thickness)
    stands = arch(7, thickness, 1.001 * mu, 2.0)
    assert np.all(stands.position == stands.position[0])
    assert np.all(stands.velocity == 0.0)
    falls = arch(7, thickness, 0.95 * mu, 0.005, 1e-3)
    # it starts as a whole: a part of g, in the first step
    assert 1e-4 * G * 0.005 < np.max(np.abs(falls.velocity[-1])) < G * 0.005
