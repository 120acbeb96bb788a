"""What a body looks like where that is not its shape: parts that are seen, and touch nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Value, Vector
from carom.geometry.attitude import attitude
from carom.scene.colors import hex_color
from carom.scene.pieces import IDENTITY, Shape


def _seen(name: str, value) -> Shape | tuple[np.ndarray, np.ndarray]:
    """Return a shape, or vertices (n, 3) and triangles (k, 3)."""
    if isinstance(value, Shape):
        return value
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise TypeError(
            f"{name} must be a shape, or (vertices, triangles), got {checks.shown(value)}"
        )
    vertices = checks.finite_array(f"vertices of {name}", value[0], (None, 3), unit="m")
    checks.length(
        f"the greatest vertex of {name}", np.max(np.abs(vertices), initial=0.0), zero=True
    )
    checks.real_array(f"triangles of {name}", value[1], "(k, 3)")
    given = np.asarray(value[1])
    whole = given.ndim == 2 and given.shape[1] == 3 and np.issubdtype(given.dtype, np.integer)
    if not (whole and len(given) and given.min() >= 0 and given.max() < len(vertices)):
        raise ValueError(
            f"triangles of {name} must be numbers of vertices from 0 to {len(vertices) - 1}, of shape (k, 3), "
            f"got {checks.shown(value[1])}"
        )
    triangles = given.astype(np.int64)
    for array in (vertices, triangles):
        array.setflags(write=False)
    return vertices, triangles


@arguments.known
@dataclass(frozen=True, eq=False)
class Look:
    """A part of what a body looks like, for ``look=`` of `Scene.add_body`. It touches nothing.

    Parameters
    ----------
    shape : shape or (vertices, triangles)
        Any shape; or the vertices (n, 3) [m] and triangles (k, 3) of a surface, which need not be closed.
    position : (3,)
        Position of the mass centre of the shape, or of the origin of the vertices, in body axes from the mass
        centre of the body [m]. Default: there.
    orientation
        As for `Scene.add_body`, part to body. Default no rotation.
    color : str or (3,), optional
        As for `Scene.add_body`. Default: that of the body.

    Examples
    --------
    A ball that looks like a cup:

    >>> handle = carom.Look(carom.Box(0.05, 0.01, 0.03), (0.06, 0, 0), color="red")
    >>> cup = [carom.Look(carom.Cylinder(0.04, 0.1)), handle]
    >>> carom.Scene().add_body(carom.Sphere(0.05), mass=0.3, look=cup).look[1].color
    '#ff0000'
    """

    shape: Value[Any, Any] = Value(_seen)
    position: Vector = fields.vector((0.0, 0.0, 0.0), unit="m")
    orientation: Value[np.ndarray, Any] = Value(attitude, IDENTITY)
    color: Value[str | None, Any] = Value(hex_color, None)

    @property
    def reach(self) -> float:
        """Largest distance of a point of it from the mass centre of the body [m]."""
        away, shape = float(np.linalg.norm(self.position)), self.shape
        if isinstance(shape, tuple):
            return away + float(np.max(np.linalg.norm(shape[0], axis=1)))
        return away + shape.size


def checked_look(name: str, value) -> tuple[Look, ...]:
    """Return a `Look`, a shape, or a sequence of them as a tuple, which may be empty."""
    given = value if isinstance(value, (tuple, list)) else (value,)
    out = []
    for one in given:
        checks.instance(
            f"each of {name}", one, (Look, Shape), "; a carom.Look or a shape is needed"
        )
        out.append(one if isinstance(one, Look) else Look(one))
    return tuple(out)
