"""Modes of the matrices M and K of another program: free ones, or those of Craig and Bampton.

Craig and Bampton: the motions are those by displacements of the interface (static), and the modes with the
interface held. The small matrices of these have modes themselves, which are the modes of the result: so an
interface deflects statically as the whole model does, with few modes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import linalg, sparse

from carom import arguments, checks
from carom.flexible.modes import Modes
from carom.flexible.thresholds import APART, RIGID, SYMMETRIC

ALL_EIGENVALUES = 600  # unknowns up to which all eigenvalues are computed


@arguments.known
def reduce(M, K, C=None, *, nodes: ArrayLike, interface: ArrayLike = (), modes: int = 20) -> Modes:
    """Return the modes of a body by its matrices, dense or sparse.

    Parameters
    ----------
    M, K : (3P, 3P)
        Mass [kg] and stiffness [N/m], symmetric: displacements x, y, z of node 1, then of node 2, and so on.
    C : (3P, 3P), optional
        Damping [N s/m]; each mode gets the ratio phi^T C phi / (2 w). Default: none.
    nodes : (P, 3)
        Places of the nodes, three or more that are not on one line, in the axes of the other program [m]. The
        body's axes are the same, with the origin in the mass centre.
    interface : sequence of int
        Numbers of the nodes where forces act, from 0: Craig and Bampton. Default none: free modes.
    modes : int
        How many flexible modes, at most those that there are; with an interface, how many with this held,
        besides three for each of its nodes. Default 20.

    Returns
    -------
    Modes
        With mass, mass centre and inertia by M. `supported` if K holds all six motions of the rigid body.

    Raises
    ------
    ValueError
        If matrices do not have this form, are not symmetric, K holds some rigid motions and not others or lets
        parts move without strain, or the interface of a free body does not hold it.
    """
    nodes = checks.vectors("nodes", nodes, 3).reshape(-1, 3)
    if not holds(nodes):
        raise ValueError(
            f"nodes must have three places or more that are not on one line, got {checks.shown(nodes)}"
        )
    size = 3 * len(nodes)
    M, K = _matrix("M", M, size), _matrix("K", K, size)
    C = None if C is None else _matrix("C", C, size)
    last = len(nodes) - 1
    own = [
        checks.integer("interface", one, least=0, most=last)
        for one in checks.listed("interface", interface, "numbers of nodes")
    ]
    held = np.array(sorted(set(own)), dtype=np.int64)
    count = checks.integer("modes", modes, least=1)

    mass, centre, inertia = rigid_body(M, nodes)
    motions = rigid_motions(nodes - centre)
    motions[:, 3:] /= np.abs(motions[:, 3:]).max()  # of the size of the translations
    free = _is_free(K, motions)
    basis = None
    if held.size:
        if free and not holds(nodes[held]):
            raise ValueError(
                "interface of a free body must have three nodes or more that are not on one line, "
                f"got {checks.shown(interface)}"
            )
        basis = _craig_bampton(M, K, held, count)
        wanted = basis.shape[1] - (6 if free else 0)
        square, vectors = linalg.eigh(basis.T @ (K @ basis), basis.T @ (M @ basis))
        vectors = basis @ vectors
    else:
        wanted = min(count, size - (6 if free else 0))
        square, vectors = lowest(M, K, wanted + (6 if free else 0))
    if free:
        rigid, square, vectors = np.abs(square[:6]).max(), square[6:], vectors[:, 6:]
        if square.size and not square[0] > APART * rigid:
            raise ValueError(
                "K must hold all parts of the body together, got more than six motions without strain"
            )
    if not square.size:
        raise ValueError("M and K must have flexible modes, got rigid motions alone")
    square, vectors = square[:wanted], vectors[:, :wanted]
    if free:  # about mean axes to round-off: orthogonal to the rigid motions in M
        weights = M @ motions
        vectors = vectors - motions @ np.linalg.solve(motions.T @ weights, weights.T @ vectors)
    scale = np.sqrt(np.einsum("ik,ik->k", vectors, M @ vectors))
    vectors, w = vectors / scale, np.sqrt(square)
    ratio: Any = 0.0
    if C is not None:
        ratio = np.maximum(np.einsum("ik,ik->k", vectors, C @ vectors), 0.0) / (2.0 * w)
    moved = vectors.reshape(len(nodes), 3, -1)
    loads = (M @ motions[:, :3]).T @ vectors
    return Modes(
        w / (2.0 * np.pi), ratio, mass, (nodes - centre, moved), inertia=inertia, supported=not free,
        participation=None if free else loads,
    )  # fmt: skip


def holds(places: np.ndarray) -> bool:
    """Return whether a body cannot move with these places held: three of them are not on one line."""
    if len(places) < 3:
        return False
    size = np.linalg.svd(places - places.mean(axis=0), compute_uv=False)
    return bool(size[1] > SYMMETRIC * size[0] > 0.0)


def _matrix(name: str, given, size: int):
    made = sparse.csc_matrix(given) if sparse.issparse(given) else None
    if made is None:
        made = checks.real_array(name, given, "(3P, 3P)")
    if made.shape != (size, size) or not size:
        raise ValueError(
            f"{name} must have shape ({size}, {size}), three rows for each of {size // 3} nodes, "
            f"got {made.shape}"
        )
    largest = abs(made).max()
    if not np.isfinite(largest) or not abs(made - made.T).max() <= SYMMETRIC * largest:
        raise ValueError(f"{name} must be finite and symmetric")
    return made


def rigid_motions(arms: np.ndarray) -> np.ndarray:
    """Return the six motions (3P, 6) of a rigid body at nodes: translations, then rotations."""
    out = np.zeros((len(arms), 3, 6))
    for k in range(3):
        axis = np.eye(3)[k]
        out[:, :, k], out[:, :, 3 + k] = axis, np.cross(axis, arms)
    return out.reshape(-1, 6)


def rigid_body(M, nodes: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return mass, mass centre and inertia about it."""
    motions = rigid_motions(nodes)
    whole = motions.T @ (M @ motions)
    mass = float(np.trace(whole[:3, :3]) / 3.0)
    if not mass > 0.0:
        raise ValueError(f"M must have a positive mass, got {mass:g} kg")
    # first moments m c: the rotation about axis k moves the mass centre by e_k x c
    cross = whole[:3, 3:] / mass
    centre = (
        np.array([cross[1, 2] - cross[2, 1], cross[2, 0] - cross[0, 2], cross[0, 1] - cross[1, 0]])
        / 2.0
    )
    about = rigid_motions(nodes - centre)
    inertia = (about.T @ (M @ about))[3:, 3:]
    return mass, centre, 0.5 * (inertia + inertia.T)


def _is_free(K, motions) -> bool:
    """Return whether a body is free: K holds none of its rigid motions; refuse K that holds some."""
    force = K @ motions
    size = abs(K).max() * np.abs(motions).max(axis=0) + np.finfo(float).tiny
    loose = np.abs(force).max(axis=0) <= SYMMETRIC * size
    work = motions.T @ force
    if loose.all():
        return True
    least = np.linalg.eigvalsh(0.5 * (work + work.T))[0]
    if least <= SYMMETRIC * np.abs(work).max():
        raise ValueError(
            "K must hold all six motions of the rigid body or none: it is free along some and held along others"
        )
    return False


def lowest(M, K, count: int):
    """Return the lowest squares of angular frequencies, and their vectors."""
    size = M.shape[0]
    if size <= ALL_EIGENVALUES or count > size // 3:
        dense = [one.toarray() if sparse.issparse(one) else one for one in (K, M)]
        return linalg.eigh(*dense, subset_by_index=(0, min(count, size) - 1))
    from scipy.sparse.linalg import eigsh

    K, M = sparse.csc_matrix(K), sparse.csc_matrix(M)
    shift = -RIGID * K.diagonal().max() / M.diagonal().max()
    start = np.random.default_rng(1).random(size)  # the same modes at each call
    square, vectors = eigsh(K, k=count, M=M, sigma=shift, which="LM", v0=start)
    order = np.argsort(square)
    return square[order], vectors[:, order]


def _craig_bampton(M, K, held: np.ndarray, count: int) -> np.ndarray:
    """Return the basis of static motions by the interface, and of modes with the interface held."""
    b = (3 * held[:, None] + np.arange(3)).ravel()
    i = np.setdiff1d(np.arange(M.shape[0]), b)
    out = np.zeros((M.shape[0], len(b)))
    out[b, np.arange(len(b))] = 1.0
    if not i.size:
        return out
    inner = K[np.ix_(i, i)] if not sparse.issparse(K) else K[i][:, i]
    side = K[np.ix_(i, b)] if not sparse.issparse(K) else K[i][:, b].toarray()
    if sparse.issparse(inner):
        from scipy.sparse.linalg import splu

        out[i] = -splu(sparse.csc_matrix(inner)).solve(side)
    else:
        out[i] = -np.linalg.solve(inner, side)
    own = M[np.ix_(i, i)] if not sparse.issparse(M) else M[i][:, i]
    _, vectors = lowest(own, inner, min(count, len(i)))
    more = np.zeros((M.shape[0], vectors.shape[1]))
    more[i] = vectors
    return np.hstack([out, more])
