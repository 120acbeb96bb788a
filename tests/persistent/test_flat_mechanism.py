"""Mechanisms that move in a plane: across it nothing moves, and round-off there must not count."""

import pytest

from campaigns import robots
from campaigns.case import run


@pytest.mark.parametrize("seed", [1059, 1161])
def test_a_planar_robot_on_the_floor(seed):
    """Holds took 8 J across the plane of cheetahs, and steps of them were taken whole."""
    found = run(robots.case(seed))
    assert found.status == "SUCCESS"
    assert found.residual < 1e-4
    assert found.depth < 1e-9
    assert found.whole == 0
