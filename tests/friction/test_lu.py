"""Dense LU in place, against NumPy."""

import numpy as np
import pytest

from carom._compiled.decorators import entry
from carom.friction.lu import factor, substitute


@entry
def solve_in_place(A, n, pivot, x):
    replaced = factor(A, n, pivot, 1e-14)
    substitute(A, n, pivot, x)
    return replaced


@pytest.mark.plain
@pytest.mark.parametrize("n", [1, 2, 5, 12, 40])
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
def test_empty_pivots_are_replaced():
    A, x = np.zeros((2, 2)), np.array([0.0, 0.0])
    assert solve_in_place(A, 2, np.zeros(2, dtype=np.int64), x) == 2
    assert np.all(x == 0.0)
