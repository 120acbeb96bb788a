"""Dense LU in place, against NumPy."""

import numpy as np
import pytest
from scipy.linalg import lu_factor

from carom._compiled.decorators import entry
from carom.friction.lu import factor, substitute


@entry
def solve_in_place(A, n, pivot, x):
    replaced = factor(A, n, pivot, 1e-14)
    substitute(A, n, pivot, x)
    return replaced


@pytest.mark.plain
@pytest.mark.parametrize("n", [1, 2, 4, 5, 7, 12, 40])
def test_leading_part(n):
    random = np.random.default_rng(n)
    A, x = random.normal(size=(n + 3, n + 3)), random.normal(size=n + 3)
    B, y = A.copy(), x.copy()
    assert solve_in_place(B, n, np.zeros(n + 3, dtype=np.int64), y) == 0
    # condition of random matrices of this size: up to some thousand
    np.testing.assert_allclose(y[:n], np.linalg.solve(A[:n, :n], x[:n]), rtol=1e-10)
    assert np.all(y[n:] == x[n:])
    assert np.all(B[n:] == A[n:])


@pytest.mark.plain
@pytest.mark.parametrize("n", [3, 4, 9, 30])
def test_factors_and_rows_exchanged(n):
    """Those of LAPACK: the same pivots, factors up to round-off."""
    A = np.random.default_rng(n).normal(size=(n, n))
    B, pivot = A.copy(), np.zeros(n, dtype=np.int64)
    solve_in_place(B, n, pivot, np.zeros(n))
    factors, exchanged = lu_factor(A)
    np.testing.assert_array_equal(pivot, exchanged)
    np.testing.assert_allclose(B, factors, atol=1e-11)


@pytest.mark.plain
def test_empty_pivots_are_replaced():
    A, x = np.zeros((2, 2)), np.array([0.0, 0.0])
    assert solve_in_place(A, 2, np.zeros(2, dtype=np.int64), x) == 2
    assert np.all(x == 0.0)
