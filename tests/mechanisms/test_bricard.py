"""Bricard's mechanism (IFToMM benchmark A04): six hinges along the edges of a cube, mobile all the same."""

from itertools import pairwise

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from verified import agree, verifies

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], float)


def bricard():
    """Five rods of 1 kg, 1 m, 0.1 m square, hinged to each other and to the ground at right angles."""
    scene = carom.Scene(gravity=(0, -9.81, 0))
    rods = []
    for a, b in pairwise(CORNERS):
        along = np.abs(b - a)
        inertia = np.diag(along / 600 + (1 - along) * 1.01 / 12)
        rods.append(scene.add_body(mass=1.0, inertia=inertia, position=(a + b) / 2))
    ring = [GROUND, *rods, GROUND]
    edges = [
        CORNERS[k] - CORNERS[k - 1] for k in range(6)
    ]  # of the rod, or ground, that ends at corner k
    for k in range(6):
        axis = np.cross(edges[k], edges[(k + 1) % 6])
        parent, child = ring[k], ring[k + 1]
        if child is GROUND:
            parent, child = child, parent
        scene.add_joint(joints.Revolute(CORNERS[k], axis), parent, child)
    return scene


def test_one_freedom_against_the_count():
    """30 - 30 = 0; one row follows from the others."""
    found = bricard().check()
    assert (found.rows, found.redundant, found.degrees_of_freedom) == (30, 1, 1)
    assert len(found.redundant_joints) == 6


@verifies('method="{method}"', "Bricard's mechanism: energy over ten seconds", "invariant")
@pytest.mark.parametrize(
    ("method", "step", "bound"),
    [("rk4", 0.01, 2e-8), ("rk5", 0.01, 1e-9), ("rk8", 0.02, 1e-11)],
)
def test_energy_for_ten_seconds(method, step, bound):
    """Measured: 1.6e-8, 1.7e-10, 2e-13 J."""
    s = carom.simulate(bricard(), 10.0, step=step, method=method, save_every=2)
    agree(s.total_energy, s.total_energy[0], atol=bound)
    assert np.max(s.constraint_errors[0]) < 1e-12
    assert np.max(s.kinetic_energy) > 4.0  # it does move
