"""Pins and plates of one thickness in one plane, as in Geneva drives: the gap is that of plane geometry."""

import numpy as np

import carom
from carom.collision.api import nearest_points


def plane_gap(centre, radius, corners):
    """Return the gap of a circle and a convex polygon, negative where they overlap."""
    edges = np.roll(corners, -1, axis=0) - corners
    lengths = np.linalg.norm(edges, axis=1)
    heights = np.sum((centre - corners) * np.stack([edges[:, 1], -edges[:, 0]], 1), 1) / lengths
    if np.max(heights) <= 0.0:
        return np.max(heights) - radius
    part = np.clip(np.sum((centre - corners) * edges, axis=1) / lengths**2, 0.0, 1.0)
    return np.min(np.linalg.norm(corners + part[:, None] * edges - centre, axis=1)) - radius


def polygon(rng):
    """Return the corners of a random convex polygon about the origin."""
    while True:
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(3, 8)))
        between = np.diff(angles, append=angles[0] + 2.0 * np.pi)
        if np.min(between) > 0.1 and np.max(between) < 2.8:
            return np.stack([np.cos(angles), np.sin(angles)], axis=1) * rng.uniform(0.5, 1.0, 2)


def test_a_pin_in_a_plate():
    """A pin that is 1e-12 to 1e-3 of its size in a plate leaves it sideways, not by the whole thickness.

    The simplex of two solids in one plane is a triangle in their middle plane, whose normal leads along the
    axis: of these 400 pairs four were answered so.
    """
    rng = np.random.default_rng(1)
    for _ in range(400):
        corners, thick, radius = (
            polygon(rng),
            10 ** rng.uniform(-1.3, 0.5),
            10 ** rng.uniform(-1.5, 0),
        )
        plate = carom.Convex([(x, y, z) for x, y in corners for z in (-thick / 2, thick / 2)])
        k = rng.integers(len(corners))
        edge = np.roll(corners, -1, axis=0)[k] - corners[k]
        out = np.array([edge[1], -edge[0]]) / np.linalg.norm(edge)
        depth = 10 ** rng.uniform(-12, -3) * min(radius, thick)
        centre = corners[k] + rng.uniform(-0.1, 1.1) * edge + (radius - depth) * out
        expected = plane_gap(centre, radius, corners)
        if expected < -0.3 * min(radius, thick):
            continue  # deep: another way out is shorter
        turn = rng.uniform(0.0, 2.0 * np.pi)
        c, s = np.cos(turn), np.sin(turn)
        turned = np.array([[c, -s], [s, c]])
        poses = [
            ((*(turned @ place), 0.0), (np.cos(half), 0.0, 0.0, np.sin(half)))
            for place, half in ((centre, 0.0), (plate.centroid[:2], turn / 2))
        ]
        pin = carom.Cylinder(radius, thick)
        gap = nearest_points(pin, poses[0], plate, poses[1]).gap
        assert abs(gap - expected) < 1e-9 * min(
            radius, thick
        )  # rounding of the places, and RESOLUTION
