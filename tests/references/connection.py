r"""The connection on (R^3 x SO(3))^N with which Newton's law holds, as dense arrays.

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

import numpy as np


def permutation_symbol():
    """Return eps (3, 3, 3), the sign of the permutation of its indices."""
    eps = np.zeros((3, 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        eps[i, j, k], eps[j, i, k] = 1.0, -1.0
    return eps


def structure_constants(bodies: int = 1):
    """Return ``C[K, I, J]``, shape (6N, 6N, 6N), of the left-invariant frame: eps on each SO(3)."""
    n = 6 * bodies
    result = np.zeros((n, n, n))
    for a in range(3, n, 6):
        turn = slice(a, a + 3)
        result[turn, turn, turn] = np.moveaxis(permutation_symbol(), 2, 0)
    return result


def affinities(bodies: int = 1, c: float = 1.0):
    """Return ``L[K, I, J]`` = c eps_IJK on each SO(3), zero elsewhere, shape (6N, 6N, 6N).

    Parameters
    ----------
    bodies : int
        Number N of bodies.
    c : float
        Member of the bi-invariant family [1]: 1 (default) gives Newton's law, 1/2 has no torsion, 0 keeps the
        components in the body frame constant.
    """
    return c * structure_constants(bodies)


def levi_civita(metric):
    """Return the affinities, shape (6N, 6N, 6N), of the connection that is metric and torsion-free.

    It also gives Euler's equations, but its autoparallels are the free motions, not one-parameter subgroups.
    Computed by Koszul's formula with constant ``metric`` (6N, 6N).
    """
    g = metric
    lowered = np.einsum("kp,pij->kij", g, structure_constants(len(g) // 6))  # <e_K, [e_I, e_J]>
    koszul = lowered - np.einsum("ijk->kij", lowered) + np.einsum("jki->kij", lowered)
    return 0.5 * np.einsum("kp,pij->kij", np.linalg.inv(g), koszul)


def vector_derivative(L, rate, w, v):
    """Return ``(nabla_v w)^K = wdot^K + L^K_IJ v^I w^J`` (6N,) of a vector w along v.

    Parameters
    ----------
    L : (6N, 6N, 6N)
        Affinities.
    rate, w : (6N,)
        Rate of change of the components of w, and the components.
    v : (6N,)
        Velocity, world axes for translations [m/s], body axes for rotations [rad/s].
    """
    return rate + np.einsum("kij,i,j->k", L, v, w)


def covector_derivative(L, rate, p, v):
    """Return ``(nabla_v p)_I = pdot_I - L^K_JI p_K v^J`` (6N,), the left side of Eq. (1).

    For momenta p = M v it is equal to the applied forces [N] and torques [N m].
    Parameters as in `vector_derivative`, with a covector p.
    """
    return rate - np.einsum("kji,k,j->i", L, p, v)


def torsion(L):
    """Return ``T[K, I, J]`` of ``T(e_I, e_J) = nabla_I e_J - nabla_J e_I - [e_I, e_J]``."""
    return L - np.swapaxes(L, 1, 2) - structure_constants(len(L) // 6)


def curvature(L):
    """Return ``R[M, K, I, J]``, the components of ``R(e_I, e_J) e_K`` along e_M; zero if flat.

    ``R(X, Y) Z = nabla_X nabla_Y Z - nabla_Y nabla_X Z - nabla_[X, Y] Z``.
    """
    twice = np.einsum("mip,pjk->mkij", L, L)
    bracket = np.einsum("pij,mpk->mkij", structure_constants(len(L) // 6), L)
    return twice - np.swapaxes(twice, 2, 3) - bracket


def nonmetricity(L, metric):
    """Return ``(nabla_I g)[J, K]`` as an array [I, J, K]; zero if parallel transport preserves lengths."""
    half = np.einsum("pij,pk->ijk", L, metric)
    return -half - np.swapaxes(half, 1, 2)


def autoparallel_rate(L, v):
    """Return vdot (6N,) along an autoparallel, ``nabla_v v = 0``: zero for skew affinities."""
    return -np.einsum("kij,i,j->k", L, v, v)
