r"""The connection on (R^3 x SO(3))^N with which Newton's law holds, as dense arrays, for the mathematics.

In the left-invariant frame ``e_I`` (three translations along world axes, three rotations about body
axes, for each body) the metric ``M = blockdiag(m 1, J)``, the structure constants
``[e_I, e_J] = C^K_IJ e_K`` and the affinities ``nabla_{e_I} e_J = L^K_IJ e_K`` are all constant.
The library's connection is ``L^K_IJ = c eps_IJK`` on each SO(3), zero on translations, with c = 1:

- Newton's law ``nabla_v p = f`` is then Euler's equation for every inertia, and in the bi-invariant
  family c = 1 is the only such member;
- its autoparallels have W constant: a straight line and a one-parameter subgroup;
- it is flat, with torsion ``T(X, Y) = [X, Y]``, and not metric unless J is isotropic.

All functions take arrays of affinities ``L[K, I, J]``. Source: mathematics page, *Connection and
autoparallels*, and Eq. (1) of the paper.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import finite_array, integer, number

Array = NDArray[np.float64]


def permutation_symbol() -> Array:
    """Return eps (3, 3, 3), the sign of the permutation of its indices."""
    eps = np.zeros((3, 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        eps[i, j, k], eps[j, i, k] = 1.0, -1.0
    return eps


def structure_constants(bodies: int = 1) -> Array:
    """Return ``C[K, I, J]``, shape (6N, 6N, 6N), of the left-invariant frame: eps on each SO(3)."""
    n = 6 * integer("bodies", bodies, least=1)
    result = np.zeros((n, n, n))
    for a in range(3, n, 6):
        turn = slice(a, a + 3)
        result[turn, turn, turn] = np.moveaxis(permutation_symbol(), 2, 0)
    return result


def affinities(bodies: int = 1, c: float = 1.0) -> Array:
    """Return ``L[K, I, J]`` = c eps_IJK on each SO(3), zero elsewhere, shape (6N, 6N, 6N).

    Parameters
    ----------
    bodies : int
        Number N of bodies.
    c : float
        Member of the bi-invariant family [1]: 1 (default) gives Newton's law, 1/2 has no torsion, 0 keeps the
        components in the body frame constant.
    """
    return number("c", c) * structure_constants(bodies)


def levi_civita(metric: ArrayLike) -> Array:
    """Return the affinities, shape (6N, 6N, 6N), of the connection that is metric and torsion-free.

    It also gives Euler's equations, but its autoparallels are the free motions, not one-parameter subgroups.
    Computed by Koszul's formula with constant ``metric`` (6N, 6N).
    """
    g = _metric(metric)
    lowered = np.einsum("kp,pij->kij", g, structure_constants(len(g) // 6))  # <e_K, [e_I, e_J]>
    koszul = lowered - np.einsum("ijk->kij", lowered) + np.einsum("jki->kij", lowered)
    return 0.5 * np.einsum("kp,pij->kij", np.linalg.inv(g), koszul)


def vector_derivative(L: ArrayLike, rate: ArrayLike, w: ArrayLike, v: ArrayLike) -> Array:
    """Return ``(nabla_v w)^K = wdot^K + L^K_IJ v^I w^J`` (6N,) of a vector w along v.

    Parameters
    ----------
    L : array_like (6N, 6N, 6N)
        Affinities.
    rate, w : array_like (6N,)
        Rate of change of the components of w, and the components.
    v : array_like (6N,)
        Velocity, world axes for translations [m/s], body axes for rotations [rad/s].
    """
    L = _affinities(L)
    rate, w, v = (finite_array(n, a, (len(L),)) for n, a in (("rate", rate), ("w", w), ("v", v)))
    return rate + np.einsum("kij,i,j->k", L, v, w)


def covector_derivative(L: ArrayLike, rate: ArrayLike, p: ArrayLike, v: ArrayLike) -> Array:
    """Return ``(nabla_v p)_I = pdot_I - L^K_JI p_K v^J`` (6N,), the left side of Eq. (1).

    For momenta p = M v it is equal to the applied forces [N] and torques [N m].
    Parameters as in `vector_derivative`, with a covector p.
    """
    L = _affinities(L)
    rate, p, v = (finite_array(n, a, (len(L),)) for n, a in (("rate", rate), ("p", p), ("v", v)))
    return rate - np.einsum("kji,k,j->i", L, p, v)


def torsion(L: ArrayLike) -> Array:
    """Return ``T[K, I, J]`` of ``T(e_I, e_J) = nabla_I e_J - nabla_J e_I - [e_I, e_J]``."""
    L = _affinities(L)
    return L - np.swapaxes(L, 1, 2) - structure_constants(len(L) // 6)


def curvature(L: ArrayLike) -> Array:
    """Return ``R[M, K, I, J]``, the components of ``R(e_I, e_J) e_K`` along e_M; zero if flat.

    ``R(X, Y) Z = nabla_X nabla_Y Z - nabla_Y nabla_X Z - nabla_[X, Y] Z``.
    """
    L = _affinities(L)
    twice = np.einsum("mip,pjk->mkij", L, L)
    bracket = np.einsum("pij,mpk->mkij", structure_constants(len(L) // 6), L)
    return twice - np.swapaxes(twice, 2, 3) - bracket


def nonmetricity(L: ArrayLike, metric: ArrayLike) -> Array:
    """Return ``(nabla_I g)[J, K]`` as an array [I, J, K]; zero if parallel transport preserves lengths."""
    L, g = _affinities(L), _metric(metric)
    half = np.einsum("pij,pk->ijk", L, g)
    return -half - np.swapaxes(half, 1, 2)


def autoparallel_rate(L: ArrayLike, v: ArrayLike) -> Array:
    """Return vdot (6N,) along an autoparallel, ``nabla_v v = 0``: zero for skew affinities."""
    L = _affinities(L)
    v = finite_array("v", v, (len(L),))
    return -np.einsum("kij,i,j->k", L, v, v)


def _affinities(value: ArrayLike) -> Array:
    L = finite_array("L", value, (None, None, None))
    n = len(L)
    if L.shape != (n, n, n) or n == 0 or n % 6:
        raise ValueError(f"L must have shape (6N, 6N, 6N), got shape {L.shape}")
    return L


def _metric(value: ArrayLike) -> Array:
    g = finite_array("metric", value, (None, None))
    n = len(g)
    if g.shape != (n, n) or n == 0 or n % 6:
        raise ValueError(f"metric must have shape (6N, 6N), got shape {g.shape}")
    return g
