"""Volume, first and second moments of solids bounded by triangles, and of such solids rounded by a ball.

A moment is the tuple of the integrals of 1, x and x x^T over the solid. All are exact.
"""

from __future__ import annotations

import numpy as np

Moments = tuple[float, np.ndarray, np.ndarray]


def of_triangles(triangles: np.ndarray) -> Moments:
    """Return the moments of the solid that closed, outward `triangles` (k,3,3) bound.

    It is a sum of tetrahedra between 0 and each triangle. For one of volume V with corners 0, a, b, c and
    sum s = a + b + c: V, V s / 4 and V (a a^T + b b^T + c c^T + s s^T) / 20.
    """
    volumes = np.linalg.det(triangles) / 6
    sums = triangles.sum(axis=1)
    four = np.concatenate([triangles, sums[:, None]], axis=1)
    second = np.einsum("t,tki,tkj->ij", volumes, four, four) / 20
    return float(volumes.sum()), volumes @ sums / 4, second


def about_centroid(integrals, corners: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return volume, centroid (3,) and second moment (3,3) about it, of a solid near `corners` (n,3).

    `integrals` returns the moments about a point. They are computed again about the centroid, to avoid
    cancellation in a parallel-axis term.
    """
    apex = corners.mean(axis=0)
    volume, first, _ = integrals(apex)
    centroid = apex + first / volume
    volume, _, second = integrals(centroid)
    return volume, centroid, 0.5 * (second + second.T)


def of_swollen(corners: np.ndarray, simplices: np.ndarray, r: float) -> Moments:
    """Return the moments of a convex hull rounded by a ball of radius `r`.

    Parameters
    ----------
    corners : (n, 3)
        Vertices.
    simplices : (k, 3)
        Outward triangles of its surface, as numbers of corners; they may be coplanar.
    r
        At least 0.

    Notes
    -----
    The solid is the hull, and outside of it a slab on each triangle, a wedge of a cylinder on each edge and a
    cone of a ball at each vertex (Steiner). With n the outward normals: a wedge is turned about the edge
    from one normal to the next; a cone is over the polygon of the normals around its vertex on the
    unit sphere. Its solid angle W is the angle defect of the vertex; the integrals of n and n n^T over it
    are sums over its sides, by Stokes: for a side with outward conormal m they are -1/2 of the length times
    m (of n), and W/3 - 1/6 of the integral of m n^T + n m^T along the side (of n n^T).
    """
    triangles = corners[simplices]
    volume, first, second = of_triangles(triangles)
    if not r > 0.0:
        return volume, first, second
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    double = np.linalg.norm(cross, axis=1)
    normals = cross / double[:, None]
    parts = [(volume, first, second)]
    parts += [_slab(t, n, a / 2, r) for t, n, a in zip(triangles, normals, double)]

    # n, n n^T integrated over the cone of each vertex, from the sides of its polygon.
    over_n, over_nn = np.zeros_like(corners), np.zeros((len(corners), 3, 3))
    for (i, j), (f, g) in _edges(simplices).items():
        p, q, u, v = corners[i], corners[j], normals[f], normals[g]
        along = (q - p) / np.linalg.norm(q - p)
        angle = np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v)
        middle = u + v
        middle /= np.linalg.norm(middle)
        across = np.cross(along, middle)
        parts.append(_wedge(p, q, middle, across, angle, r))
        # The side from u to v of the polygons of i and j; it is left of the one, right of the other.
        arc = 2 * np.sin(angle / 2) * middle
        for vertex, conormal in ((i, along), (j, -along)):
            over_n[vertex] += -0.5 * angle * conormal
            flux = np.outer(conormal, arc)
            over_nn[vertex] += -(flux + flux.T) / 6
    for p, solid_angle, n, nn in zip(corners, _defects(corners, simplices), over_n, over_nn):
        parts.append(_cone(p, solid_angle, n, nn + np.eye(3) * solid_angle / 3, r))
    volumes, firsts, seconds = zip(*parts)
    return float(sum(volumes)), np.sum(firsts, axis=0), np.sum(seconds, axis=0)


def _edges(simplices: np.ndarray) -> dict:
    """Return for each edge i -> j of a triangle f the triangle g that has it as j -> i; each edge once."""
    owner = {(t[k], t[(k + 1) % 3]): f for f, t in enumerate(simplices) for k in range(3)}
    return {(i, j): (f, owner[j, i]) for (i, j), f in owner.items() if i < j}


def _defects(corners, simplices) -> np.ndarray:
    """Return 2 pi less the angles of the triangles at each corner: the solid angle of its normals."""
    left = np.full(len(corners), 2 * np.pi)
    for k in range(3):
        here = simplices[:, k]
        a = corners[simplices[:, (k + 1) % 3]] - corners[here]
        b = corners[simplices[:, (k + 2) % 3]] - corners[here]
        sine = np.linalg.norm(np.cross(a, b), axis=1)
        np.subtract.at(left, here, np.arctan2(sine, np.sum(a * b, axis=1)))
    return left


def _slab(triangle, n, area, r) -> Moments:
    """Return the moments of y + s n, y on a triangle, 0 <= s <= r."""
    total = triangle.sum(axis=0)
    one = area * total / 3
    two = area / 12 * (triangle.T @ triangle + np.outer(total, total))
    mixed = np.outer(one, n) * r**2 / 2
    second = r * two + mixed + mixed.T + r**3 / 3 * area * np.outer(n, n)
    return area * r, r * one + r**2 / 2 * area * n, second


def _wedge(p, q, middle, across, angle, r) -> Moments:
    """Return the moments of a sector of a cylinder along p q, of half angle `angle`/2 about `middle`."""
    length = np.linalg.norm(q - p)
    one = length * (p + q) / 2
    two = length / 6 * (2 * np.outer(p, p) + 2 * np.outer(q, q) + np.outer(p, q) + np.outer(q, p))
    u = 2 * np.sin(angle / 2) * middle
    uu = 0.5 * (
        (angle + np.sin(angle)) * np.outer(middle, middle)
        + (angle - np.sin(angle)) * np.outer(across, across)
    )
    mixed = np.outer(one, u) * r**3 / 3
    second = r**2 / 2 * angle * two + mixed + mixed.T + r**4 / 4 * length * uu
    first = r**2 / 2 * angle * one + r**3 / 3 * length * u
    return length * r**2 / 2 * angle, first, second


def _cone(p, solid_angle, n, nn, r) -> Moments:
    """Return the moments of p + s n over a part of the unit sphere, 0 <= s <= r."""
    volume = solid_angle * r**3 / 3
    mixed = np.outer(p, n) * r**4 / 4
    second = volume * np.outer(p, p) + mixed + mixed.T + r**5 / 5 * nn
    return volume, volume * p + r**4 / 4 * n, second
