"""Dense LU in place, against NumPy."""

import numpy as np
import pytest
from scipy.linalg import lu_factor

from carom._compiled.decorators import entry
from carom.friction.lu import factor, substitute, substitute_all


@entry
def solve_in_place(A, n, pivot, x):
    replaced, _ = factor(A, n, pivot, 1e-14)
    substitute(A, n, pivot, x)
    return replaced


@entry
def work_of(A, n, pivot):
    _, products = factor(A, n, pivot, 0.0)
    return products


@entry
def invert(A, n, pivot, X):
    factor(A, n, pivot, 0.0)
    substitute_all(A, n, pivot, X)


def of_bodies_in_a_row(n, width=9):
    """Return a matrix in which each block has numbers with its neighbours alone, rows in another order."""
    random = np.random.default_rng(n)
    A, block = random.normal(size=(n, n)), np.arange(n) // width
    A[np.abs(block[:, None] - block) > 1] = 0.0
    order = random.permutation(n // width) * width
    rows = np.concatenate([np.arange(b, b + width) for b in order])
    return A[np.ix_(rows, rows)]


@pytest.mark.plain
@pytest.mark.parametrize("n", [18, 63, 90])
def test_few_neighbours(n):
    """The pivots and factors of LAPACK, and of more than 64 rows the solution, with a part of the products."""
    A, pivot = of_bodies_in_a_row(n), np.zeros(n, dtype=np.int64)
    B, x = A.copy(), np.random.default_rng(1).normal(size=n)
    y = x.copy()
    solve_in_place(B, n, pivot, y)
    factors, exchanged = lu_factor(A)
    np.testing.assert_array_equal(pivot, exchanged)
    np.testing.assert_allclose(B, factors, atol=1e-10)
    np.testing.assert_allclose(y, np.linalg.solve(A, x), rtol=1e-8)
    if n == 90:
        full = np.random.default_rng(2).normal(size=(n, n))
        assert work_of(A.copy(), n, pivot) < 0.5 * work_of(full, n, pivot)
        assert work_of(full, n, pivot) == pytest.approx(n**3 / 3, rel=0.1)


@pytest.mark.plain
@pytest.mark.parametrize("n", [3, 18, 36])
def test_all_columns(n):
    A = of_bodies_in_a_row(n, 3)
    X = np.eye(n)
    invert(A.copy(), n, np.zeros(n, dtype=np.int64), X)
    np.testing.assert_allclose(X @ A, np.eye(n), atol=1e-9)


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
