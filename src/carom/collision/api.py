"""Nearest points of two shapes, for Python."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.geometry.attitude import attitude


@dataclass(frozen=True)
class PairPoint:
    """Nearest points of two shapes.

    Attributes
    ----------
    gap : float
        Distance [m]. If the shapes overlap it is negative: its magnitude is the smallest displacement of one
        shape, along `normal`, that separates them.
    normal : (3,)
        Unit normal from B to A, in the world.
    on_a, on_b : (3,)
        The nearest points on the surfaces, in the world [m].
    """

    gap: float
    normal: np.ndarray
    on_a: np.ndarray
    on_b: np.ndarray


def nearest_points(shape_a, pose_a, shape_b, pose_b) -> PairPoint:
    """Return the nearest points of two shapes of `carom.scene`.

    Parameters
    ----------
    shape_a, shape_b
        Shapes of one or several convex pieces.
    pose_a, pose_b : ((3,), (4,))
        Position [m] and orientation in the world, as for `Scene.add_body`.
    """
    from carom.collision.frame import place
    from carom.collision.layout import Placed
    from carom.collision.touch import touch

    poses = [pair_pose(name, pose) for name, pose in (("pose_a", pose_a), ("pose_b", pose_b))]
    solids, hulls = _solids(shape_a, shape_b)
    work, out = _workspace()
    (xa, qa), (xb, qb) = [(np.zeros(3), np.zeros(4)) for _ in range(2)]
    best = None
    for a in solids[solids.body == 0]:
        place(a, *poses[0], xa, qa)
        for b in solids[solids.body == 1]:
            place(b, *poses[1], xb, qb)
            count = touch(Placed(a, xa, qa), Placed(b, xb, qb), hulls, 0.0, work, out)
            k = int(np.argmin(out["gap"][:count]))
            if best is None or out["gap"][k] < best.gap:
                best = PairPoint(
                    float(out["gap"][k]), *(out[f][k] + 0.0 for f in ("normal", "on_a", "on_b"))
                )
    assert best is not None
    return best


@lru_cache(maxsize=256)
def _solids(shape_a, shape_b):
    from carom.collision.layout import solid_table

    return solid_table([shape_a, shape_b])


@lru_cache(maxsize=1)
def _workspace():
    from carom.collision.layout import new_pair_work, new_points

    return new_pair_work(), new_points()


def pair_pose(name: str, pose: tuple[ArrayLike, ArrayLike]) -> tuple[np.ndarray, np.ndarray]:
    """Return a checked pose."""
    x, q = pose
    return checks.finite_array(f"{name}[0]", x, (3,)), attitude(f"{name}[1]", q)
