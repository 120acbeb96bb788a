"""Points of two bodies whose normals are nearly equal act in one plane, half-way between the surfaces."""

import numpy as np
import pytest

from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.geometry.frames import contact_axes
from carom.model.arrays import STATE
from carom.model.workspace import POINT
from carom.stepping.crowd import spots


@entry
def share_plane(points, first, last, state):
    spots.share_plane(points, first, last, state)


def corners(tilt, rng):
    """Return two bodies and four points between them, with gaps up to 1e-6 m and normals off by `tilt`."""
    state, points = table(STATE, 2), table(POINT, 4)
    state["x"] = [[0, 0, 0.01], [0.002, 0.001, -0.01]]
    for i, (x, y) in enumerate(((-1, -1), (-1, 1), (1, -1), (1, 1))):
        gap, n = 1e-6 * rng.random(), np.array([tilt * i, -tilt * i, 1.0])
        p = np.array([0.01 * x, 0.01 * y, 1e-6 * rng.random()])
        points[i].a, points[i].b, points[i].gap = 0, 1, gap
        points[i].axes = contact_axes(n / np.linalg.norm(n))
        points[i].arm_a = p + gap * points[i].axes[0] - state.x[0]
        points[i].arm_b = p - state.x[1]
    return state, points


def rows(points):
    """Return G of all points, of the velocities of both bodies."""
    every = []
    for point in points:
        for n in point.axes:
            every.append([*n, *np.cross(point.arm_a, n), *-n, *-np.cross(point.arm_b, n)])
    return np.array(every)


@pytest.mark.plain
@pytest.mark.parametrize("tilt", [0.0, 1e-7, 1e-4])
def test_they_ask_for_no_more_than_two_bodies_can_follow(tilt):
    """Relative motion has six freedoms: so has G. Before, gaps and tilts gave it more, with tiny weights."""
    state, points = corners(tilt, np.random.default_rng(1))
    assert np.linalg.matrix_rank(rows(points), tol=1e-13) > 6
    gaps = points.gap.copy()
    share_plane(points, 0, 4, state)
    assert np.linalg.matrix_rank(rows(points), tol=1e-13) == 6
    np.testing.assert_array_equal(points.gap, gaps)
    # one place on both bodies: impulse and counter-impulse are on one line, and turn nothing
    np.testing.assert_allclose(points.arm_a + state.x[0], points.arm_b + state.x[1], atol=1e-17)
    height = (points.arm_a + state.x[0]) @ points.axes[0, 0]
    np.testing.assert_allclose(height, height[0], atol=1e-17)


def test_other_normals_stay():
    state, points = corners(1e-2, np.random.default_rng(2))
    points.gap[:] = [0.0, 1e-6, 1e-6, 1e-6]
    axes = points.axes.copy()
    share_plane(points, 0, 4, state)
    np.testing.assert_array_equal(points.axes, axes)
