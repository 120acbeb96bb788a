"""Mechanisms that move in a plane: across it nothing moves, and round-off there must not count."""

import numpy as np
import pytest

from campaigns import robots
from campaigns.case import run
from carom._compiled.decorators import entry
from carom.dynamics.friction import stick_force


@entry
def stick(W, a0, a1, a2):
    return stick_force(W, a0, a1, a2)


@pytest.mark.plain
@pytest.mark.parametrize("across", [1, 2])
@pytest.mark.parametrize("size", [0.0, 1e-33, 1e-17])
def test_round_off_across_the_plane_asks_for_no_force(across, size):
    """W is [[2, 1], [1, 3]] in the plane, and round-off across it, as is the acceleration there."""
    W, along = np.zeros((3, 3)), 3 - across
    W[0, 0], W[along, along] = 2.0, 3.0
    W[0, along] = W[along, 0] = 1.0
    W[across, across] = size
    W[0, across] = W[across, 0] = W[along, across] = W[across, along] = -0.3 * size
    a = np.array([-1.0, 0.0, 0.0])
    a[across] = 1e-16
    found = np.array(stick(W, *a))
    assert abs(found[across]) < 1e-15
    np.testing.assert_allclose((W @ found + a)[[0, along]], 0.0, atol=1e-15)


@pytest.mark.parametrize("seed", [1059, 1161])
def test_a_planar_robot_on_the_floor(seed):
    """Holds took 8 J across the plane of cheetahs, and steps of them were taken whole."""
    found = run(robots.case(seed))
    assert found.status == "SUCCESS"
    assert found.residual < 1e-4
    assert found.depth < 1e-9
    assert found.whole == 0
