"""Random pairs of solids in contact, of every kind of contact, for the rates of rows."""

import numpy as np
from scipy.spatial.transform import Rotation

from carom.collision.api import nearest_points
from carom.geometry import quaternion
from contact.pair_cases import NAMES, ORIGIN, SHAPES, Pose, separation, unit
from contact.row_rates import Motion, Touching

LINED = tuple(n for n in NAMES if n not in ("sphere", "disc", "ellipsoid"))
FACED = tuple(n for n in NAMES if n not in ("sphere", "capsule", "ellipsoid"))
GAPS = (0.0, 0.0, 1e-3, -1e-4, 1e-6)
MODES = ("random", "faces", "tilted", "line on face", "face on line", "lines")


def _frame(z, x):
    z = unit(z)
    x = unit(x - (x @ z) * z)
    return np.array([x, np.cross(z, x), z]).T


def _laid(n, across, own, own_across):
    """Return the attitude that turns `own` to -n and `own_across` into the plane of n and `across`."""
    matrix = _frame(-n, across) @ _frame(own, own_across).T
    return np.roll(Rotation.from_matrix(matrix).as_quat(), 1)


def _face(name, rng):
    """Return the normal of a random face of a shape, in its axes."""
    if name.endswith("box"):
        return rng.permutation([0.0, 0.0, rng.choice([-1.0, 1.0])])
    if name.endswith("convex"):
        faces = SHAPES[name].pieces[0].faces
        return np.array(faces[rng.integers(len(faces))][0])
    return np.array([0.0, 0.0, rng.choice([-1.0, 1.0])])


def _line(name, rng):
    """Return the normal and the direction of a random edge, or line of the mantle, of a shape, in its axes."""
    if name.endswith("box"):
        along = np.eye(3)[rng.integers(3)]
        return unit(rng.uniform(0.3, 1, 3) * rng.choice([-1, 1], 3) * (1 - along)), along
    if name.endswith("convex"):
        piece = SHAPES[name].pieces[0]
        while True:
            (n, ring), (m, other) = (piece.faces[k] for k in rng.integers(len(piece.faces), size=2))
            ends = sorted(set(ring) & set(other))
            if len(ends) == 2 and set(ring) != set(other):
                f, (p, q) = rng.uniform(0.3, 0.7), piece.vertices[ends]
                return unit(f * np.array(n) + (1 - f) * np.array(m)), unit(q - p)
    phi = rng.uniform(0, 2 * np.pi)
    return np.array([np.cos(phi), np.sin(phi), 0]), np.array([0, 0, 1.0])


def _beside(a, b, q, qb, n, gap, rng):
    """Return a place of A over B, in the direction n, with a gap."""
    shift = rng.normal(size=3) * rng.choice([0, 0.2, 0.2, 0.2])
    x = shift - (shift @ n) * n
    return x + (gap - separation(SHAPES[a], SHAPES[b], Pose(x, q), Pose(ORIGIN.x, qb), n)) * n


def case(mode, rng):
    """Return two solids that touch, in any way that the mode allows.

    Faces and lines that lie on each other have velocities with which they stay so: otherwise the points that
    are found before and after belong to different parts.
    """
    static, gap, reach = rng.random() < 0.3, rng.choice(GAPS), 1e-4
    w = rng.normal(size=(2, 3)) * [[1], [0 if static else 1]]
    qb, turned = unit(rng.normal(size=4)), rng.normal(size=4)
    if mode == "random":
        a, b = rng.choice(NAMES, 2)
        qa, x, reach = unit(turned), 2 * unit(rng.normal(size=3)), rng.choice([0.0, 1e-3, 0.1])
        near = nearest_points(SHAPES[a], (x, qa), SHAPES[b], (ORIGIN.x, qb))
        x = x - (near.gap - gap) * near.normal
    elif mode in ("faces", "tilted"):
        a, b = rng.choice(FACED, 2)
        n = quaternion.rotate(qb, _face(b, rng))
        qa = _laid(n, rng.normal(size=3), _face(a, rng), rng.normal(size=3))
        if mode == "tilted":
            tilt = rng.normal(size=3) * 10 ** rng.uniform(-2, -0.5)
            qa, reach = quaternion.multiply(quaternion.exp(tilt), qa), rng.choice([0.0, 0.1])
        else:
            w[0] = w[1] + rng.normal() * n
        x = _beside(a, b, qa, qb, n, gap, rng)
    else:
        a, b = rng.choice(LINED), rng.choice(LINED if mode == "lines" else FACED)
        n, along = _line(b, rng) if mode == "lines" else (_face(b, rng), rng.normal(size=3))
        n, along = quaternion.rotate(qb, n), quaternion.rotate(qb, along)
        own, own_along = _line(a, rng)
        qa = _laid(n, along, own, own_along)
        along = quaternion.rotate(qa, own_along)
        w[0] = w[1] + rng.normal() * along + (0 if mode == "lines" else rng.normal()) * n
        if mode == "lines" and not {a, b} & {
            "capsule",
            "cylinder",
            "rounded box",
            "rounded convex",
        }:
            gap = 1e-3  # sharp edges that touch have no definite normal
        x = _beside(a, b, qa, qb, n, gap, rng)
    v = rng.normal(size=(2, 3))
    first = Motion(x, qa, v[0], w[0])
    second = Motion(ORIGIN.x, qb) if static else Motion(ORIGIN.x, qb, v[1], w[1])
    if mode == "face on line" and not static:
        return a, b, Touching(SHAPES[b], SHAPES[a], second, first, reach)
    return a, b, Touching(SHAPES[a], SHAPES[b], first, second, reach)
