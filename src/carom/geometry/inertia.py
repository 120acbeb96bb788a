"""Masses and inertia tensors of N bodies, and the kinetic metric that they make: NumPy."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import finite_array

Array = NDArray[np.float64]


def mass_and_inertia(mass: ArrayLike, inertia: ArrayLike) -> tuple[Array, Array]:
    """Return the checked masses (N,) and the full inertia tensors (N, 3, 3).

    Parameters
    ----------
    mass : array_like (N,)
        Masses [kg], above zero.
    inertia : array_like (N, 3) or (N, 3, 3)
        Principal moments, or symmetric tensors, about the mass centre in body axes [kg m^2];
        positive definite.
    """
    m = finite_array("mass", mass, (None,), "kg")
    if len(m) == 0 or not np.all(m > 0.0):
        raise ValueError(f"mass must be above 0 for at least one body [kg], got {mass!r}")
    n = len(m)
    if np.ndim(inertia) == 2:
        J = finite_array("inertia", inertia, (n, 3), "kg m^2")[:, :, None] * np.eye(3)
    else:
        J = finite_array("inertia", inertia, (n, 3, 3), "kg m^2")
    scale = np.abs(J).max(axis=(1, 2))
    if not np.all(np.abs(J - np.swapaxes(J, 1, 2)).max(axis=(1, 2)) <= 1e-12 * scale):
        raise ValueError(f"inertia must be symmetric [kg m^2], got {inertia!r}")
    if not np.all(np.linalg.eigvalsh(J) > 0.0):
        raise ValueError(f"inertia must be positive definite [kg m^2], got {inertia!r}")
    return m, J


def kinetic_metric(mass: ArrayLike, inertia: ArrayLike) -> Array:
    """Return the metric ``M = blockdiag(m 1, J)`` (6N, 6N); kinetic energy is ``v . M v / 2``.

    Parameters as in `mass_and_inertia`. Source: mathematics page, *Configuration and metric*.
    """
    m, J = mass_and_inertia(mass, inertia)
    result = np.zeros((6 * len(m), 6 * len(m)))
    for i in range(len(m)):
        x, turn = slice(6 * i, 6 * i + 3), slice(6 * i + 3, 6 * i + 6)
        result[x, x] = m[i] * np.eye(3)
        result[turn, turn] = J[i]
    return result
