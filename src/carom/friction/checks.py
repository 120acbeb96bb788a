"""Checks of the input for several contacts: their inverse masses, and one number for each."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.friction.thresholds import EIGENVALUE_ERROR, FILE_DIGITS


def checked_inverse_masses(inverse_mass, k: int) -> np.ndarray:
    """Return W (3k, 3k), symmetric; raise ValueError unless it is positive semidefinite."""
    if checks.real_array("inverse_mass", inverse_mass, "(3k, 3k) or (k, 3, k, 3)").ndim == 4:
        W = checks.finite_array("inverse_mass", inverse_mass, (None, 3, None, 3), "1/kg")
        W = W.reshape(3 * len(W), -1)
    else:
        W = checks.finite_array("inverse_mass", inverse_mass, (None, None), "1/kg")
    if W.shape != (3 * k, 3 * k):
        raise ValueError(
            f"inverse_mass must have shape {(3 * k, 3 * k)} [1/kg], as velocity is of {k} contacts, got shape "
            f"{np.shape(inverse_mass)}"
        )
    return semidefinite(W)


def semidefinite(W: np.ndarray) -> np.ndarray:
    """Return an inverse mass W (n, n), symmetric; raise ValueError unless it is positive semidefinite.

    Both hold up to what six digits of a file leave (`FILE_DIGITS`). An eigenvalue below round-off is then
    mended by twice its size on the diagonal: a contact problem with W < 0 need not have a solution, and of 400
    problems of six digits 36 were not solved as they are, and one with this.
    """
    off = np.max(np.abs(W - W.T), initial=0.0)
    if not off <= FILE_DIGITS * np.max(np.abs(W), initial=0.0):
        raise ValueError(
            f"inverse_mass must be symmetric to {FILE_DIGITS:g} of its greatest entry, got entries that differ "
            f"by {off:.6g} [1/kg] of {checks.shown(W)}"
        )
    W = np.ascontiguousarray(0.5 * (W + W.T))
    least, *_, most = np.linalg.eigvalsh(W)
    if not least >= -FILE_DIGITS * most:
        raise ValueError(
            f"inverse_mass must be positive semidefinite to {FILE_DIGITS:g} of its greatest eigenvalue "
            f"{most:.6g}, got an eigenvalue {least:.6g} [1/kg]"
        )
    if least < -EIGENVALUE_ERROR * most:
        W[np.diag_indices_from(W)] -= 2.0 * least
    return W


def codes(name: str, value, k: int, known: dict[str, int]) -> np.ndarray:
    """Return the numbers of `value`, one name or k of them."""
    names = [value] * k if isinstance(value, str) else checks.listed(name, value, "names")
    if len(names) != k:
        raise ValueError(f"{name} must be one name or {k} of them, got {checks.shown(value)}")
    return np.array([known[checks.choice(name, one, known)] for one in names], dtype=np.int64)


def per_contact(name: str, value, k: int, **bounds) -> np.ndarray:
    """Return `value`, one number or k of them, as an array (k,); each must be within `bounds`."""
    if checks.real_array(name, value, "() or (k,)").ndim == 0:
        return np.full(k, checks.number(name, value, **bounds))
    array = checks.finite_array(name, value, (k,))
    for i, item in enumerate(array):
        checks.number(f"{name}[{i}]", item, **bounds)
    return np.ascontiguousarray(array)
